// One ray inside one patch, and its tests of leaf blocks.
#pragma once

#include "cpu/traversal/block_lanes-inl.h"
#include "cpu/traversal/box_test-inl.h"
#include "cpu/traversal/patch_tree_walk-inl.h"
#include "cpu/traversal/triangle_test-inl.h"
#include "formulas/lod.h"

HWY_BEFORE_NAMESPACE();
namespace relief::HWY_NAMESPACE {

/// Paper 1's rule (Harada 2015): one level for the whole patch from the width of the ray's cone there.
RELIEF_INLINE void choose_ray_level(PatchVisit& visit, const Instance& placed, const cpu::TraceRay& world) {
    const Surface& surface = visit.scene->surfaces[visit.surface];
    const Quad quad = surface.quads[visit.patch];
    float longest = 0;
    Vec3f sum{};
    for (size_t k = 0; k < 4; ++k) {
        const Vec3f& from = surface.position(quad.vertex[k]);
        const Vec3f edge = surface.position(quad.vertex[(k + 1) % 4]) - from;
        longest = std::fmax(longest, length(transform_vector(placed.world_from_object, edge)));
        sum = sum + from;
    }
    const Vec3f middle = transform_point(placed.world_from_object, sum * 0.25f);
    const float distance = scalar::find_passing_distance(world.origin, world.direction, world.t_min, middle);
    visit.levels = scalar::pack_uniform_level(
        scalar::choose_ray_level(longest, distance, visit.scene->pixel_angle, visit.level()));
}

/// The triangle of the patch in lane `lane` of a block, and the place on the patch by its weights.
RELIEF_INLINE void locate_in_block(const PatchVisit& visit, const cpu::PatchTree& tree, uint32_t block,
                                   uint32_t lane, float weight_b, float weight_c, cpu::TraceHit& hit) {
    uint32_t column = 0, row = 0;
    cpu::PatchTree::block_cell(int(tree.level), block, column, row);
    const float cell_size = visit.cell_size();
    hit.patch = visit.patch;
    hit.levels = visit.levels;
    hit.i = uint16_t(tree.cell_x + column + (lane & 3));
    hit.j = uint16_t(tree.cell_y + row + (lane >> 2 & 1));
    hit.is_upper = uint8_t(lane >> 3);
    hit.u = (float(hit.i) + (hit.is_upper ? weight_b : weight_b + weight_c)) * cell_size;
    hit.v = (float(hit.j) + (hit.is_upper ? weight_b + weight_c : weight_c)) * cell_size;
}

/// Where the vertices of a block are in the grid of its tile.
struct BlockPlace {
    const float* first;               ///< of the lowest row and column, x
    uint32_t column_count, axis_step; ///< from row to row and from axis to axis

    /// `level` is that of the tree: where the caller knows it, most of this is known, too.
    RELIEF_INLINE BlockPlace(const cpu::PatchTree& tree, int level, uint32_t block)
        : first(tree.grid(level) + cpu::PatchTree::find_first_vertex(level, block)),
          column_count(cpu::PatchTree::column_count(level)),
          axis_step(cpu::PatchTree::vertex_count(level)) {}
    RELIEF_INLINE Lanes16 load(int axis) const {
        return load_block(first + uint32_t(axis) * axis_step, column_count);
    }
};

/// Exact leaf: sixteen triangles at once. load(axis) gives a coordinate of the vertices of the block.
template <Query kQuery, class Load>
RELIEF_INLINE bool intersect_triangles(const PatchVisit& visit, const cpu::PatchTree& tree, uint32_t block,
                                       Load load, RayState& ray) {
    Lanes16 x, y, z, cx[3], cy[3], cz[3];
    shear_vertices(load, ray, x, y, z);
    gather_corners(x, cx[0], cx[1], cx[2]);
    gather_corners(y, cy[0], cy[1], cy[2]);
    TriangleTest<16> test;
    if (!test_edges(cx, cy, test)) return false;
    gather_corners(z, cz[0], cz[1], cz[2]);
    if (!test_distances(cx, cy, cz, ray, test)) return false;
    if constexpr (kQuery == Query::any) return true;
    offer_hits(ray, test, [&](uint32_t lane, float weight_b, float weight_c, cpu::TraceHit& hit) {
        locate_in_block(visit, tree, block, lane, weight_b, weight_c, hit);
    });
    return true;
}

/// Paper 1's leaf (Harada 2015, section 1.4): a micro-quad counts as hit where the ray enters its box. A ray
/// that begins inside a box leaves it unhit, so that it cannot meet the quad that it starts on.
template <Query kQuery>
HWY_NOINLINE bool intersect_boxes(const PatchVisit& visit, const cpu::PatchTree& tree, uint32_t block,
                                  RayState& ray) {
    const BlockPlace at(tree, int(tree.level), block);
    alignas(64) float bounds[6][8];
    for (int axis = 0; axis < 3; ++axis)
        for (uint32_t cell = 0; cell < 8; ++cell) {
            const float* v =
                at.first + uint32_t(axis) * at.axis_step + (cell >> 2) * at.column_count + (cell & 3);
            const float* w = v + at.column_count;
            bounds[axis][cell] = std::fmin(std::fmin(v[0], v[1]), std::fmin(w[0], w[1]));
            bounds[3 + axis][cell] = std::fmax(std::fmax(v[0], v[1]), std::fmax(w[0], w[1]));
        }
    Lanes8 entry;
    LaneMask mask = test_node(bounds, ray, entry) & less(Lanes8(ray.t_min), entry);
    uint32_t column = 0, row = 0;
    cpu::PatchTree::block_cell(int(tree.level), block, column, row);
    const uint32_t cells = 1u << tree.level;
    alignas(32) float distance[8];
    (entry + Lanes8(ray.shift)).store(distance);
    bool has_hit = false;
    for (; mask; mask &= mask - 1) {
        const uint32_t cell = uint32_t(__builtin_ctz(mask));
        if (column + (cell & 3) >= cells || row + (cell >> 2) >= cells || distance[cell] > ray.hit_t_max())
            continue;
        if constexpr (kQuery == Query::any) return true;
        cpu::TraceHit hit;
        hit.t = distance[cell], hit.instance = ray.instance;
        locate_in_block(visit, tree, block, cell, 0.0f, 0.5f, hit); // its middle
        offer_hit(ray, hit);
        has_hit = true;
    }
    return has_hit;
}

template <Query kQuery, class Load>
RELIEF_INLINE bool intersect_block(const PatchVisit& visit, const cpu::PatchTree& tree, uint32_t block,
                                   Load load, RayState& ray) {
    ++visit.context->counters.blocks;
    return visit.scene->leaf == LeafKind::exact ? intersect_triangles<kQuery>(visit, tree, block, load, ray)
                                                : intersect_boxes<kQuery>(visit, tree, block, ray);
}

/// One ray.
template <Query kQuery> struct RayProbe {
    static constexpr bool kListsLeaves = true;

    PatchVisit visit;
    RayState& ray;
    bool has_hit = false;

    void count_pairs(LaneMask) const { visit.count_pairs(1, has_hit); }

    RELIEF_INLINE bool test_block(const cpu::PatchTree& tree, int level, uint32_t block, LaneMask) {
        const BlockPlace at(tree, level, block);
        const auto load = [&](int axis) { return at.load(axis); };
        const bool is_hit = intersect_block<kQuery>(visit, tree, block, load, ray);
        has_hit |= is_hit;
        return kQuery == Query::any && is_hit;
    }

    template <size_t W, class Visit>
    RELIEF_INLINE bool visit_children(const float (&bounds)[6][W], LaneMask rays, Visit visit_child) {
        Lanes<W> entry;
        const LaneMask mask = test_node(bounds, ray, entry);
        if ((mask & (mask - 1)) == 0) return mask != 0 && visit_child(uint32_t(__builtin_ctz(mask)), rays);
        EntryList<16> entries;
        entries.append(mask, entry, 0);
        entries.sort();
        for (uint32_t k = 0; k < entries.count; ++k)
            if (entries.distance(k) <= ray.t_max * kBoxSlack && visit_child(entries.child(k), rays))
                return true;
        return false;
    }

    template <class Visit>
    RELIEF_INLINE void visit_any_order(const float (&bounds)[6][16], Visit visit_child) const {
        Lanes16 entry;
        for (LaneMask mask = test_node(bounds, ray, entry); mask; mask &= mask - 1)
            visit_child(uint32_t(__builtin_ctz(mask)));
    }
    template <size_t W, class List>
    RELIEF_INLINE void list_children(const float (&bounds)[6][W], uint32_t first, List& leaves) const {
        Lanes<W> entry;
        const LaneMask mask = test_node(bounds, ray, entry);
        leaves.append(mask, entry, first);
    }
    /// Nearest first; for Query::any as they come, since all of them are at hand already.
    template <class List, class Visit> RELIEF_INLINE bool visit_listed(List& leaves, Visit visit_leaf) const {
        if constexpr (kQuery == Query::closest) leaves.sort();
        for (uint32_t k = 0; k < leaves.count; ++k) {
            if (kQuery == Query::closest && leaves.distance(k) > ray.t_max * kBoxSlack) continue;
            if (visit_leaf(leaves.child(k), 1)) return true;
        }
        return false;
    }
};

/// A displaced patch of the instance that the ray is in the space of.
template <Query kQuery>
RELIEF_INLINE bool trace_patch(const cpu::SceneView& scene, cpu::TraceContext& context,
                               const cpu::TraceRay& world, uint32_t patch, RayState& ray) {
    RayProbe<kQuery> probe{{scene, context, ray.instance, patch, world.lod_bias}, ray};
    if (scene.lod == LodRule::ray) choose_ray_level(probe.visit, scene.instances[ray.instance], world);
    visit_patch(probe, 1);
    return probe.has_hit;
}

} // namespace relief::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
