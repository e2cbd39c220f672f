// One ray through one tree over a triangle mesh: the hooks of formulas/tree.h from buffers. The including file defines
// WALK_..., also WALK_KD for kd-trees, and Key where the walk has one. begin_walk(), walk_tree(), walk_best.
#include "formulas/lang.h"
#include "formulas/constants.h"
#include "formulas/exact.h"
#include "formulas/object_ray.h"
#include "lab/walks/trail.h"
#include "formulas/tree.h"
#include "vulkan/layout/bindings.h"
#include "vulkan/layout/device_trees.h"

layout(constant_id = 1) const uint kIsCounting = 0u;
layout(constant_id = 2) const uint kIsSuccinct = 0u; ///< heaps only

layout(scalar, push_constant) uniform Push { WalkPush push; };
layout(set = 0, binding = kBindTreeIds) uniform usamplerBuffer tree_ids;
layout(set = 0, binding = kBindMeshTriangles) uniform usamplerBuffer mesh_triangles;
layout(set = 0, binding = kBindMeshPositions) uniform samplerBuffer mesh_positions;

ObjectRay walk_ray;
float walk_t_min, walk_t_max;
TreeHit walk_best; ///< t: no farther than this matters
RayCounts walk_counts;

void count_box_test() {
    if (kIsCounting != 0u) ++walk_counts.box_tests;
}
void count_primitive_test() {
    if (kIsCounting != 0u) ++walk_counts.primitive_tests;
}
void count_restart() {
    if (kIsCounting != 0u) ++walk_counts.restarts;
}
void count_bytes(const uint bytes) {
    if (kIsCounting != 0u) walk_counts.bytes += bytes;
}

float get_limit() { return walk_best.t; }
bool resume_walk() { return false; }
bool visit_leaf(const uint first, const uint word, const uint node);

#ifdef WALK_KD
#include "lab/vulkan/shaders/kd_hooks.glsl"
#else
#include "lab/vulkan/shaders/box_hooks.glsl"
#endif

#include "lab/vulkan/shaders/walk_kind.glsl"

#if defined(WALK_TRAIL) || defined(WALK_PAIR_TRAIL)
Key walk_start;
Key get_walk_start() { return walk_start; }
#else
uint get_walk_start() { return push.root; }
#endif

bool walk_tree() {
#ifdef WALK_STACK
    walk_state = make_empty_stack();
#endif
    start_walk(get_walk_start());
    return walk_on();
}

#if defined(WALK_TRAIL) || defined(WALK_PAIR_TRAIL)
Key walk_hit_leaf; ///< that ended the walk or shortened the ray last
void note_hit_leaf() { walk_hit_leaf = walk_state.leaf; }
#else
void note_hit_leaf() {}
#endif

vec3 load_sheared(const uint vertex) {
    return shear_vertex(walk_ray, texelFetch(mesh_positions, int(vertex)).xyz);
}

void offer_triangle(const uint primitive) {
    count_primitive_test();
    uvec4 corners = texelFetch(mesh_triangles, int(primitive));
    TriangleHit found = intersect_sheared(walk_ray, load_sheared(corners.x), load_sheared(corners.y),
                                          load_sheared(corners.z), walk_t_min, walk_best.t);
    if (found.t == make_infinity() || (found.t == walk_best.t && primitive >= walk_best.primitive)) return;
    walk_best = TreeHit(found.t, primitive, found.weight_b, found.weight_c);
}

/// The count of a kd leaf has the place of a word.
bool visit_leaf(const uint first, const uint word, const uint node) {
    uint count = get_word_count(word);
    float limit = walk_best.t;
    bool is_ended = false;
    for (uint k = 0u; k < count && !is_ended; ++k) {
        offer_triangle(texelFetch(tree_ids, int(first + k)).x);
        is_ended = push.is_any != 0u && walk_best.primitive != kNone;
    }
    if (is_ended || walk_best.t < limit) note_hit_leaf();
    return is_ended;
}

void begin_walk(const TreeRay ray) {
    walk_ray = make_object_ray(ray.origin, ray.direction);
    walk_t_min = ray.t_min;
    walk_t_max = ray.t_max;
    walk_best = TreeHit(ray.t_max, kNone, 0.0, 0.0);
    walk_counts = RayCounts(0u, 0u, 0u, 0u);
}
