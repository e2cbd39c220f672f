// Traversal of one patch or tile's tree: complete, in Morton order, mirrored so that near nodes come first; no stack,
// no links (cf. Harada 2015, listing 1.1). Rays that see the patch at a lower level stop there.
#ifndef RELIEF_PATCH_TRAVERSAL_GLSL
#define RELIEF_PATCH_TRAVERSAL_GLSL

#include "vulkan/shaders/rays.glsl"
#include "formulas/quantise.h"
#include "formulas/patch_tree.h"

#ifndef POOL_DECLARED
layout(scalar, set = 0, binding = kBindPool) readonly buffer Pool { uint pool[]; };
#endif

layout(constant_id = 4) const uint kIsBoxLeaf = 0; ///< a micro-quad is hit at the entry into its box

/// State of a ray in a tree.
struct PatchVisit {
    uint base;
    uint tree_level, ray_level; ///< of the tree, and as seen by the ray
    uint levels;                ///< packed, of the whole patch
    uint reversed;
    uint cell_x, cell_y; ///< first cell of a tile
    bool has_moved_edges;
    vec3 origin, scale;
    ObjectRay ray;
    float t_min;
    float t; ///< nearest so far
    uint cell;
    bool has_hit;
};

vec3 read_tree_vertex(const PatchVisit visit, uint i, uint j) {
    uint finer = visit.tree_level - visit.ray_level;
    if (visit.has_moved_edges) {
        uint edge = find_sample_edge(i, j, visit.ray_level);
        if (edge < 4u) {
            uint shift = packed_patch_level(visit.levels) - packed_edge_level(visit.levels, edge);
            GridSample moved = move_boundary_sample(i, j, visit.ray_level, edge, shift, visit.reversed);
            i = moved.i;
            j = moved.j;
        }
    }
    uint side = (1u << visit.tree_level) + 1u;
    uint word = visit.base + first_vertex_word(visit.tree_level) + 3u * ((j << finer) * side + (i << finer));
    return vec3(uintBitsToFloat(pool[word]), uintBitsToFloat(pool[word + 1u]), uintBitsToFloat(pool[word + 2u]));
}

void offer_micro_hit(inout PatchVisit visit, const float t, const uint cell) {
    if (t > visit.t || (t == visit.t && visit.has_hit && cell > visit.cell)) return;
    visit.t = t;
    visit.cell = cell;
    visit.has_hit = true;
}

void intersect_micro_quad(inout PatchVisit visit, const uint i, const uint j) {
    vec3 p00 = read_tree_vertex(visit, i, j);
    vec3 p10 = read_tree_vertex(visit, i + 1u, j);
    vec3 p11 = read_tree_vertex(visit, i + 1u, j + 1u);
    vec3 p01 = read_tree_vertex(visit, i, j + 1u);
    uint column = visit.cell_x + i;
    uint row = visit.cell_y + j;
    if (kIsBoxLeaf != 0u) {
        BoxInterval interval = cross_box(visit.ray, min(min(p00, p10), min(p11, p01)),
                                         max(max(p00, p10), max(p11, p01)), visit.t_min, visit.t);
        // A box that contains the ray's origin is not hit, to avoid self-intersection.
        if (is_box_met(interval) && interval.entry > visit.t_min)
            offer_micro_hit(visit, interval.entry, make_cell_rank(column, row, 0u));
        return;
    }
    vec3 a = shear_vertex(visit.ray, p00);
    vec3 b = shear_vertex(visit.ray, p10);
    vec3 c = shear_vertex(visit.ray, p11);
    vec3 d = shear_vertex(visit.ray, p01);
    float lower = intersect_sheared(visit.ray, a, b, c, visit.t_min, visit.t).t;
    if (lower != kInfinity) offer_micro_hit(visit, lower, make_cell_rank(column, row, 0u));
    float upper = intersect_sheared(visit.ray, a, c, d, visit.t_min, visit.t).t;
    if (upper != kInfinity) offer_micro_hit(visit, upper, make_cell_rank(column, row, 1u));
}

bool is_node_met(const PatchVisit visit, const uint node) {
    uint word = visit.base + kTreeHeaderWords + kTreeNodeWords * node;
    vec3 lower, upper;
    for (uint k = 0u; k < 3u; ++k) {
        uint codes = pool[word + k];
        lower[k] = decode_bound(visit.origin[k], visit.scale[k], codes & 0xffffu);
        upper[k] = decode_bound(visit.origin[k], visit.scale[k], codes >> 16u);
    }
    return is_box_met(cross_box(visit.ray, lower, upper, visit.t_min, visit.t));
}

/// XOR mask for node indices; front-to-back order unless the patch is folded.
uint choose_order(const PatchVisit visit) {
    uint n = 1u << visit.ray_level;
    vec3 corner = read_tree_vertex(visit, 0u, 0u);
    vec3 along_u = read_tree_vertex(visit, n, 0u) - corner;
    vec3 along_v = read_tree_vertex(visit, 0u, n) - corner;
    return make_order_mask(dot(along_u, visit.ray.direction) < 0.0, dot(along_v, visit.ray.direction) < 0.0);
}

/// False if lavapipe ended the loop early, after 65535 iterations; the bound itself is never reached.
bool walk_tree(inout PatchVisit visit, const bool is_any) {
    uint order = choose_order(visit);
    uint level = 0u;
    uint place = 0u; // index in traversal order within the level
    for (uint visited = 0u; visited < count_nodes_above(kTreeLevels + 1u); ++visited) {
        uint number = place ^ (order & ((1u << (2u * level)) - 1u));
        if (is_node_met(visit, count_nodes_above(level) + number)) {
            if (level < visit.ray_level) {
                ++level;
                place <<= 2u;
                continue;
            }
            intersect_micro_quad(visit, morton_column(number), morton_row(number));
            if (is_any && visit.has_hit) return true;
        }
        // The next sibling on this level, or of the nearest ancestor that has one.
        ++place;
        uint up = min(uint(findLSB(place)) >> 1u, level);
        place >>= 2u * up;
        level -= up;
        if (level == 0u) return true;
    }
    return false;
}

/// Rank among the ray's candidates of this round by (instance, patch); tiles of one patch share a rank.
uint find_slot_rank(const uint candidate_index, const uint slots) {
    CandidateData own = candidates[candidate_index];
    uint first = candidate_index / slots * slots;
    uint rank = 0u;
    for (uint k = first; k < first + slots && candidates[k].instance != kNone; ++k) {
        uint instance = candidates[k].instance;
        if (instance < own.instance || (instance == own.instance && candidates[k].patch_index < own.patch_index)) ++rank;
    }
    return rank;
}

PatchVisit enter_tree(const uint tree, const CandidateData candidate, const RayData world, const uint patch_count,
                      const uint pool_capacity) {
    PatchVisit visit;
    visit.base = trees[tree].address % pool_capacity * kPoolUnitWords;
    visit.tree_level = pool[visit.base + kTreeLevel];
    visit.reversed = pool[visit.base + kTreeReversed];
    visit.levels = candidate.levels;
    visit.cell_x = visit.cell_y = 0u;
    visit.ray_level = packed_patch_level(candidate.levels);
    visit.has_moved_edges = candidate.levels != pack_uniform_level(visit.ray_level);
    if (tree >= patch_count) {
        TileRecord tile = tile_records[tree - patch_count];
        visit.cell_x = tile.cell_x;
        visit.cell_y = tile.cell_y;
        visit.ray_level = kTreeLevels;
        visit.has_moved_edges = false; // applied when the tile was built
    }
    for (uint k = 0u; k < 3u; ++k) {
        visit.origin[k] = uintBitsToFloat(pool[visit.base + kTreeOrigin + k]);
        visit.scale[k] = uintBitsToFloat(pool[visit.base + kTreeScale + k]);
    }
    visit.ray = enter_object(world, instances[candidate.instance]);
    visit.t_min = world.t_min;
    visit.has_hit = false;
    visit.cell = 0u;
    return visit;
}

/// Traces one pair; its tree must be in the pool.
void trace_pair(const uvec2 pair, const CastPush push) {
    uint place = pair.y / push.slots;
    float t = nearest_distance(nearest[place]);
    CandidateData candidate = candidates[pair.y];
    if (candidate.entry > t * kBoxSlack) {
        COUNT(counters.pairs_done);
        return;
    }
    RayData world = rays[active_rays[push.first + place]];
    PatchVisit visit = enter_tree(pair.x, candidate, world, push.patch_count, push.pool_capacity);
    visit.t = t;
    if (walk_tree(visit, push.is_any != 0u)) COUNT(counters.pairs_done);
    if (!visit.has_hit) return;
    COUNT(counters.pairs_with_hit);
    uint64_t found = push.is_any != 0u ? make_nearest(-kInfinity, 0u)
                                       : make_nearest(visit.t, find_slot_rank(pair.y, push.slots) << kCellBits | visit.cell);
    atomicMin(nearest[place], found);
}

#endif
