// One ray of a round in the scene trees, of any kind: collects its nearest candidates, intersects polygons, emits
// pairs. Included after kMayOfferTwice (patches may be visited again) and before enter_tiles() and walk().
#ifndef RELIEF_SCENE_CANDIDATES_GLSL
#define RELIEF_SCENE_CANDIDATES_GLSL

#include "formulas/patch_tree.h"
#include "vulkan/shaders/ray_levels.glsl"

layout(set = 0, binding = kBindNodes) uniform usamplerBuffer nodes;
layout(set = 0, binding = kBindPrimitiveIds) uniform usamplerBuffer primitive_ids;
layout(scalar, set = 0, binding = kBindRequests) buffer Requests { RequestData requests[]; };
/// Shares memory with the histogram of the sort, which runs later.
layout(scalar, set = 0, binding = kBindHistogram) buffer RequestBits { uint request_bits[]; };
layout(scalar, set = 0, binding = kBindDirectories) readonly buffer Directories { DirectoryData directories[]; };

uint ray_index;
float ray_t_min, ray_t_max;
ObjectRay ray;       ///< against boxes; polygons make their own
uint instance_index; ///< kNone: in world space
float best_t;        ///< of the nearest polygon so far, which is in `hits`
bool has_hit;

layout(constant_id = kPolygonsConstant) const uint kHasPolygons = 0;
layout(constant_id = kTilesConstant) const uint kHasTiles = 0;

layout(constant_id = kCollectsConstant) const uint kCollects = 0;

/// A candidate in its slot, ordered by (entry, instance, tree).
struct Slot {
    float entry;
    uint instance, tree;
};

// The nearest candidates so far, sorted. Only the last push.slots of the slots are used: those before hold what is
// nearer than all, free ones what is further. Indices are constants, so that slots stay in registers.
Slot slots[kMostSlots];
uint first_candidate; ///< of the ray
uint collected = 0u;  ///< candidates; more than push.slots: too many
bool is_blocked = false; ///< tiles are missing that the host must build first

void clear_slots() {
    for (uint k = 0u; k < kMostSlots; ++k)
        slots[k] = Slot(k + push.slots < kMostSlots ? -kInfinity : kInfinity, kNone, kNone);
}

/// Distance beyond which this round ignores everything.
float find_limit() {
    return (kCollects != 0u ? best_t : min(best_t, slots[kMostSlots - 1u].entry)) * kBoxSlack;
}

bool is_after(const float entry, const uint at_instance, const uint tree, const CursorData mark) {
    if (entry != mark.entry) return entry > mark.entry;
    if (at_instance != mark.instance) return at_instance > mark.instance;
    return tree > mark.tree;
}

bool is_slot_after(const Slot slot, const Slot other) {
    return is_after(slot.entry, slot.instance, slot.tree, CursorData(other.entry, other.instance, other.tree));
}

bool is_offered(const uint tree) {
    bool is_there = false;
    for (uint k = 0u; k < kMostSlots; ++k)
        is_there = is_there || (slots[k].tree == tree && slots[k].instance == instance_index);
    return is_there;
}

/// Inserts a tree of this instance if it follows the cursor and is among the nearest so far.
void offer_candidate(const uint tree, const float entry) {
    if (push.round > 0u && !is_after(entry, instance_index, tree, cursors[ray_index])) return;
    if (kCollects != 0u) {
        if (collected < push.slots)
            candidates[first_candidate + collected] = CandidateData(instance_index, tree, 0u, 0u, entry);
        collected = min(collected + 1u, push.slots + 1u);
        return;
    }
    Slot moved = Slot(entry, instance_index, tree);
    if (!is_slot_after(slots[kMostSlots - 1u], moved)) return;
    if (kMayOfferTwice && is_offered(tree)) return;
    for (uint k = 0u; k < kMostSlots; ++k) {
        bool is_swapped = is_slot_after(slots[k], moved);
        Slot nearer = slots[k];
        if (is_swapped) {
            slots[k] = moved;
            moved = nearer;
        }
    }
}

/// Root of the tree over the tiles of a patch; kNone if the host has not built it yet.
uint find_directory(const uint patch_number, const uint levels) {
    uint place = hash_directory(patch_number, levels) & push.directory_mask;
    while (directories[place].patch_number != kNone) {
        if (directories[place].patch_number == patch_number && directories[place].levels == levels)
            return directories[place].root;
        place = (place + 1u) & push.directory_mask;
    }
    return kNone;
}

/// Requests tiles from the host, in few rounds: a hashed bit marks patches; colliding ones come in a later round.
void request_tiles(const uint patch_number, const RequestData request) {
    uint bit = hash_directory(patch_number, request.levels) & (kRequestBits - 1u);
    uint mask = 1u << (bit & 31u);
    is_blocked = true;
    if ((atomicOr(request_bits[bit >> 5u], mask) & mask) != 0u) return;
    uint place = atomicAdd(counters.request_count, 1u);
    if (place < push.request_limit) requests[place] = request;
}

/// Traverses the tree over the tiles of a patch; `entry` is that of the patch.
void enter_tiles(const uint root, const float entry);

void enter_patch(const uint patch_index, const float entry) {
    uint patch_number = surfaces[instances[instance_index].surface].first_quad + patch_index;
    uint levels = kHasTiles == 0u ? 0u : choose_levels(ray_index, instance_index, patch_index);
    if (packed_patch_level(levels) <= kTreeLevels) {
        offer_candidate(patch_number, entry);
        return;
    }
    uint root = find_directory(patch_number, levels);
    if (root != kNone)
        enter_tiles(root, entry);
    else
        request_tiles(patch_number, RequestData(instance_index, patch_index, levels));
}

void offer_hit(const HitData hit) {
    if (has_hit && !is_better(hit, hits[ray_index])) return;
    hits[ray_index] = hit;
    best_t = hit.t;
    has_hit = true;
}

/// One half of a quad after the other.
void intersect_polygon(const uint patch_index) {
    if (kHasPolygons == 0u) return;
    SurfaceData s = surfaces[instances[instance_index].surface];
    uvec4 quad = load_quad(s, patch_index);
    uint half_count = is_triangle(quad) ? 1u : 2u;
    [[dont_unroll]] for (uint is_upper = 0u; is_upper < half_count; ++is_upper) {
        ObjectRay whole = enter_object(rays[ray_index], instances[instance_index]);
        vec3 a = shear_vertex(whole, load_position(s, quad.x));
        vec3 b = shear_vertex(whole, load_position(s, is_upper == 0u ? quad.y : quad.z));
        vec3 c = shear_vertex(whole, load_position(s, is_upper == 0u ? quad.z : quad.w));
        TriangleHit found = intersect_sheared(whole, a, b, c, ray_t_min, best_t);
        if (found.t != kInfinity) {
            vec2 uv = place_in_cell(vec2(found.weight_b, found.weight_c), is_upper);
            offer_hit(HitData(found.t, instance_index, patch_index, uv.x, uv.y, is_upper, 0u));
        }
    }
}

/// Independent of what this round has found so far.
bool is_wanted_at_all(const BoxInterval interval, const float entry) {
    if (!is_box_met(interval)) return false;
    if (push.round == 0u || instance_index == kNone) return true;
    return max(interval.exit, entry) * kBoxSlack >= cursors[ray_index].entry;
}

/// `entry`: at least that of every ancestor, so that skipped candidates follow all offered ones.
bool is_wanted(const BoxInterval interval, const float entry) {
    return entry <= find_limit() && is_wanted_at_all(interval, entry);
}

/// Whether the instance is neither empty nor masked.
bool is_instance_seen(const uint index) {
    return instances[index].root != kNone && (instances[index].visibility_mask & push.visibility_mask) != 0u;
}

void enter_instance(const uint index) {
    instance_index = index;
    ray = enter_object(rays[ray_index], instances[index]);
}

void leave_instance() {
    instance_index = kNone;
    ray = make_object_ray(rays[ray_index].origin, rays[ray_index].direction);
}

/// Traverses the scene trees; false if the device ended a loop early.
bool walk();

/// Takes `count` places in the list of pairs: one atomic operation for all lanes that do so together.
uint take_pairs(const uint count) {
#ifdef FULL_SCREEN
    return atomicAdd(counters.pair_count, count);
#else
    uint before = subgroupExclusiveAdd(count);
    uint sum = subgroupAdd(count);
    uint first = 0u;
    if (subgroupElect()) first = atomicAdd(counters.pair_count, sum);
    return subgroupBroadcastFirst(first) + before;
#endif
}

/// Emits pairs for the candidates in the slots; see find_jobs.comp for what they lack. None: a ray that is done, or waits.
void emit_slots(const bool is_none) {
    uint count = 0u;
    for (uint k = 0u; k < kMostSlots; ++k)
        if (slots[k].tree != kNone) ++count;
    if (is_none) count = 0u;
    uint pair = take_pairs(count);
    uint candidate = first_candidate;
    for (uint k = 0u; k < kMostSlots; ++k) {
        if (k + push.slots >= kMostSlots) {
            candidates[candidate].instance = kNone;
            candidates[candidate].tree = 0u;
            if (count > 0u && slots[k].tree != kNone) {
                candidates[candidate] = CandidateData(slots[k].instance, slots[k].tree, 0u, 0u, slots[k].entry);
                pairs[pair] = uvec2(slots[k].tree, candidate);
                ++pair;
            }
            ++candidate;
        }
    }
}

/// The same for what was collected.
void emit_collected(const bool is_none) {
    bool is_overflown = collected > push.slots;
    uint count = is_none || is_overflown ? 0u : collected;
    uint pair = take_pairs(count);
    for (uint k = 0u; k < count; ++k) pairs[pair + k] = uvec2(candidates[first_candidate + k].tree, first_candidate + k);
    if (count < push.slots) candidates[first_candidate + count].instance = kNone;
    if (count == 0u) candidates[first_candidate].tree = is_overflown && !is_none ? kOverflown : 0u;
}

void emit_candidates(const bool is_done) {
    if (kCollects != 0u)
        emit_collected(is_done || is_blocked);
    else
        emit_slots(is_done || is_blocked);
    if (is_blocked) candidates[first_candidate].tree = kNone;
}

bool is_waiting(const uint place) {
    return candidates[place * push.slots].instance == kNone && candidates[place * push.slots].tree == kNone;
}

void trace_round() {
    uint place = invocation_index();
    if (place >= push.count || (push.is_repeated != 0u && !is_waiting(place))) return;
    ray_index = active_rays[push.first + place];
    ray_t_min = rays[ray_index].t_min;
    ray_t_max = rays[ray_index].t_max;
    has_hit = push.round > 0u && hits[ray_index].instance != kNone;
    best_t = has_hit ? hits[ray_index].t : ray_t_max;
    first_candidate = place * push.slots;
    if (kCollects == 0u) clear_slots();
    if (push.root != kNone && !walk()) atomicAdd(counters.rays_lost, 1u);
    if (push.round == 0u && !has_hit) hits[ray_index] = HitData(kInfinity, kNone, kNone, 0.0, 0.0, 0u, 0u);
    nearest[place] = make_nearest(best_t, 0xffffffffu);
    emit_candidates(push.is_any != 0u && has_hit);
}

#endif
