// Includes the walk of lab/walks/traverse_*.h that the macro WALK_... selects, under common names: start_walk(root),
// walk_on(), and its state in walk_state. The hooks of formulas/tree.h come before, and enter_root_cell() of kd-trees; Key
// is defined where the walk has one, kIsPushDown and kIsBacktrack where it is of kd-trees. A trail starts at a key.
#ifndef RELIEF_WALK_KIND_GLSL
#define RELIEF_WALK_KIND_GLSL

#if defined(WALK_STACK)
#include "lab/walks/traverse_stack.h"
#define KindState StackState
#define walk_state stack_walk
void start_walk(const uint root) { start_stack(root); }
bool walk_on() { return walk_stack(); }
#elif defined(WALK_RESTART_TRAIL)
#include "lab/walks/traverse_restart_trail.h"
#define KindState RestartState
#define walk_state restart_walk
// The level of each width; the macro Key picks one by the type of the argument.
uint make_root_level(const uint width) { return make_root_level32(); }
HeapKey make_root_level(const HeapKey width) { return make_root_level64(); }
Key make_root_level() {
    Key width;
    return make_root_level(width);
}
void start_walk(const uint root) { restart_walk = start_restart_trail(root, make_root_level()); }
bool walk_on() { return walk_restart_trail(); }
#elif defined(WALK_PARENT_LINK)
#include "lab/walks/traverse_parent_link.h"
#define KindState ParentLinkState
#define walk_state parent_walk
void start_walk(const uint root) { parent_walk = start_parent_link(root); }
bool walk_on() { return walk_parent_link(); }
#elif defined(WALK_SKIP_LINK)
#include "lab/walks/traverse_skip_link.h"
#define KindState SkipLinkState
#define walk_state skip_walk
void start_walk(const uint root) { skip_walk = start_skip_link(root); }
bool walk_on() { return walk_skip_link(); }
#elif defined(WALK_TRAIL)
#include "lab/walks/traverse_trail.h"
#define KindState TrailState
#define walk_state trail_walk
void start_walk(const Key key) { trail_walk = start_trail(key); }
bool walk_on() { return walk_trail(); }
#elif defined(WALK_PAIR_TRAIL)
#include "lab/walks/traverse_pair_trail.h"
#define KindState PairTrailState
#define walk_state pair_walk
void start_walk(const Key key) { pair_walk = start_pair_trail(key); }
bool walk_on() { return walk_pair_trail(); }
#elif defined(WALK_KD)
#include "lab/walks/traverse_kd.h"
#define KindState KdState
#define walk_state kd_walk
void start_walk(const uint root) { start_kd(root, enter_root_cell()); }
bool walk_on() { return walk_kd(); }
#endif

#endif
