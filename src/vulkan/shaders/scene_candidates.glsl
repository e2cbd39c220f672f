// One ray of a round in the scene trees, of any kind: collects its nearest candidates, intersects polygons, emits
// pairs. Included after kMayOfferTwice (patches may be visited again) and before enter_tiles() and walk().
#ifndef RELIEF_SCENE_CANDIDATES_GLSL
#define RELIEF_SCENE_CANDIDATES_GLSL

#include "vulkan/shaders/rays.glsl"
#include "formulas/patch_tree.h"
#include "formulas/lod.h"

layout(scalar, push_constant) uniform Push { CastPush push; };
layout(set = 0, binding = kBindNodes) uniform usamplerBuffer nodes;
layout(set = 0, binding = kBindPrimitiveIds) uniform usamplerBuffer primitive_ids;
layout(scalar, set = 0, binding = kBindRequests) buffer Requests { RequestData requests[]; };
/// Shares memory with the histogram of the sort, which runs later.
layout(scalar, set = 0, binding = kBindHistogram) buffer RequestBits { uint request_bits[]; };
layout(scalar, set = 0, binding = kBindDirectories) readonly buffer Directories { DirectoryData directories[]; };

RayData world;
ObjectRay ray;
InstanceData instance;
uint instance_index; ///< kNone: in world space
HitData best;
CursorData cursor;

// The nearest candidates so far, sorted.
float slot_entry[kMostSlots];
uint slot_instance[kMostSlots];
uint slot_tree[kMostSlots];
uint slot_levels[kMostSlots];
uint slot_count = 0u;
bool is_blocked = false; ///< tiles are missing that the host must build first

/// Distance beyond which this round ignores everything.
float find_limit() {
    float limit = slot_count == push.slots ? min(best.t, slot_entry[push.slots - 1u]) : best.t;
    return limit * kBoxSlack;
}

bool is_after(float entry, uint at_instance, uint tree, CursorData mark) {
    if (entry != mark.entry) return entry > mark.entry;
    if (at_instance != mark.instance) return at_instance > mark.instance;
    return tree > mark.tree;
}

bool is_slot_after(uint place, CursorData mark) {
    return is_after(slot_entry[place], slot_instance[place], slot_tree[place], mark);
}

bool is_offered(uint tree) {
    for (uint k = 0u; k < slot_count; ++k)
        if (slot_tree[k] == tree && slot_instance[k] == instance_index) return true;
    return false;
}

/// Inserts a tree of this instance if it follows the cursor and is among the nearest so far.
void offer_candidate(uint tree, uint levels, float entry) {
    if (push.round > 0u && !is_after(entry, instance_index, tree, cursor)) return;
    CursorData own = CursorData(entry, instance_index, tree);
    if (slot_count == push.slots && !is_slot_after(push.slots - 1u, own)) return;
    if (kMayOfferTwice && is_offered(tree)) return;
    uint place = slot_count < push.slots ? slot_count : push.slots - 1u;
    slot_count = min(slot_count + 1u, push.slots);
    for (; place > 0u && is_slot_after(place - 1u, own); --place) {
        slot_entry[place] = slot_entry[place - 1u];
        slot_instance[place] = slot_instance[place - 1u];
        slot_tree[place] = slot_tree[place - 1u];
        slot_levels[place] = slot_levels[place - 1u];
    }
    slot_entry[place] = entry;
    slot_instance[place] = instance_index;
    slot_tree[place] = tree;
    slot_levels[place] = levels;
}

/// Packed levels of a patch for this ray.
uint choose_levels(uint patch_index) {
    uint levels = lower_packed_levels(find_levels(instance, patch_index), world.lod_bias);
    if (push.is_ray_lod == 0u) return levels;
    SurfaceData s = surfaces[instance.surface];
    uvec4 quad = load_quad(s, patch_index);
    float longest = 0.0;
    vec3 sum = vec3(0.0);
    for (uint k = 0u; k < 4u; ++k) {
        vec3 from = load_position(s, quad[k]);
        vec3 edge = load_position(s, quad[(k + 1u) & 3u]) - from;
        longest = max(longest, length(transform_vector(instance.world_from_object, edge)));
        sum += from;
    }
    vec3 middle = transform_point(instance.world_from_object, sum * 0.25);
    float distance_there = find_passing_distance(world.origin, world.direction, world.t_min, middle);
    return pack_uniform_level(choose_ray_level(longest, distance_there, push.pixel_angle, packed_patch_level(levels)));
}

/// Root of the tree over the tiles of a patch; kNone if the host has not built it yet.
uint find_directory(uint patch_number, uint levels) {
    uint place = hash_directory(patch_number, levels) & push.directory_mask;
    while (directories[place].patch_number != kNone) {
        if (directories[place].patch_number == patch_number && directories[place].levels == levels)
            return directories[place].root;
        place = (place + 1u) & push.directory_mask;
    }
    return kNone;
}

/// Requests tiles from the host, in few rounds: a hashed bit marks patches; colliding ones come in a later round.
void request_tiles(uint patch_number, RequestData request) {
    uint bit = hash_directory(patch_number, request.levels) & (kRequestBits - 1u);
    uint mask = 1u << (bit & 31u);
    is_blocked = true;
    if ((atomicOr(request_bits[bit >> 5u], mask) & mask) != 0u) return;
    uint place = atomicAdd(counters.request_count, 1u);
    if (place < push.request_limit) requests[place] = request;
}

/// Traverses the tree over the tiles of a patch; `entry` is that of the patch.
void enter_tiles(uint root, float entry);

void enter_patch(uint patch_index, float entry) {
    uint levels = choose_levels(patch_index);
    uint patch_number = surfaces[instance.surface].first_quad + patch_index;
    if (packed_patch_level(levels) <= kTreeLevels) {
        offer_candidate(patch_number, levels, entry);
        return;
    }
    uint root = find_directory(patch_number, levels);
    if (root != kNone)
        enter_tiles(root, entry);
    else
        request_tiles(patch_number, RequestData(instance_index, patch_index, levels));
}

void offer_triangle(uint patch_index, vec3 a, vec3 b, vec3 c, uint is_upper) {
    TriangleHit found = intersect_sheared(ray, a, b, c, world.t_min, best.t);
    if (found.t == kInfinity) return;
    vec2 uv = place_in_cell(vec2(found.weight_b, found.weight_c), is_upper);
    HitData hit = HitData(found.t, instance_index, patch_index, uv.x, uv.y, is_upper, 0u);
    if (is_better(hit, best)) best = hit;
}

void intersect_polygon(uint patch_index) {
    SurfaceData s = surfaces[instance.surface];
    uvec4 quad = load_quad(s, patch_index);
    vec3 p0 = shear_vertex(ray, load_position(s, quad.x));
    vec3 p1 = shear_vertex(ray, load_position(s, quad.y));
    vec3 p2 = shear_vertex(ray, load_position(s, quad.z));
    offer_triangle(patch_index, p0, p1, p2, 0u);
    if (!is_triangle(quad)) offer_triangle(patch_index, p0, p2, shear_vertex(ray, load_position(s, quad.w)), 1u);
}

/// Independent of what this round has found so far.
bool is_wanted_at_all(BoxInterval interval, float entry) {
    if (!is_box_met(interval)) return false;
    if (push.round == 0u || instance_index == kNone) return true;
    return max(interval.exit, entry) * kBoxSlack >= cursor.entry;
}

/// `entry`: at least that of every ancestor, so that skipped candidates follow all offered ones.
bool is_wanted(BoxInterval interval, float entry) {
    return entry <= find_limit() && is_wanted_at_all(interval, entry);
}

/// Whether the instance is neither empty nor masked.
bool is_instance_seen(uint index) {
    return instances[index].root != kNone && (instances[index].visibility_mask & push.visibility_mask) != 0u;
}

void enter_instance(uint index) {
    instance_index = index;
    instance = instances[index];
    ray = enter_object(world, instance);
}

void leave_instance() {
    instance_index = kNone;
    ray = make_object_ray(world.origin, world.direction);
}

/// Traverses the scene trees; false if the device ended a loop early.
bool walk();

CandidateData make_candidate(uint k) {
    uint tree = slot_tree[k];
    uint patch_index = tree >= push.patch_count
                           ? tile_records[tree - push.patch_count].patch_index
                           : tree - surfaces[instances[slot_instance[k]].surface].first_quad;
    return CandidateData(slot_instance[k], tree, patch_index, slot_levels[k], slot_entry[k]);
}

/// Emits pairs for the candidates; a ray that waits for tiles emits none and repeats the round.
void emit_candidates(uint place) {
    if (is_blocked) slot_count = 0u;
    uint first_pair = atomicAdd(counters.pair_count, slot_count);
    for (uint k = 0u; k < push.slots; ++k) {
        uint candidate = place * push.slots + k;
        candidates[candidate].instance = kNone;
        if (k < slot_count) {
            candidates[candidate] = make_candidate(k);
            pairs[first_pair + k] = uvec2(slot_tree[k], candidate);
        }
    }
    if (is_blocked) candidates[place * push.slots].tree = kNone;
}

bool is_waiting(uint place) {
    return candidates[place * push.slots].instance == kNone && candidates[place * push.slots].tree == kNone;
}

void trace_round() {
    uint place = invocation_index();
    if (place >= push.count || (push.is_repeated != 0u && !is_waiting(place))) return;
    uint ray_index = active_rays[push.first + place];
    world = rays[ray_index];
    best = HitData(world.t_max, kNone, kNone, 0.0, 0.0, 0u, 0u);
    if (push.round > 0u) {
        cursor = cursors[ray_index];
        if (hits[ray_index].instance != kNone) best = hits[ray_index];
    }
    if (push.root != kNone && !walk()) atomicAdd(counters.rays_lost, 1u);
    if (push.is_any != 0u && best.instance != kNone) slot_count = 0u;
    if (push.round == 0u || best.instance != kNone) {
        HitData result = best;
        if (best.instance == kNone) result.t = kInfinity;
        hits[ray_index] = result;
    }
    nearest[place] = make_nearest(best.t, 0xffffffffu);
    emit_candidates(place);
}

#endif
