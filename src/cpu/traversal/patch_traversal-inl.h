// One ray inside one patch: directory, bottom tree, leaf blocks.
#if defined(RELIEF_PATCH_TRAVERSAL_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RELIEF_PATCH_TRAVERSAL_INL_H
#undef RELIEF_PATCH_TRAVERSAL_INL_H
#else
#define RELIEF_PATCH_TRAVERSAL_INL_H
#endif

#include "cpu/patch_trees/bottom_build-inl.h"
#include "cpu/traversal/ray_state-inl.h"
#include "formulas/levels.h"
#include "formulas/lod.h"

HWY_BEFORE_NAMESPACE();
namespace relief::HWY_NAMESPACE {

/// The patch that a ray or packet is inside of.
struct PatchVisit {
    const cpu::SceneView* scene;
    cpu::TraceContext* context;
    uint32_t surface, patch;
    uint32_t levels; ///< pack_levels

    HWY_INLINE uint32_t level() const { return scalar::packed_patch_level(levels); }
    /// In (u, v).
    HWY_INLINE float cell_size() const { return 1.0f / float(1u << level()); }
};

/// Levels of the surface that a ray sees: the field's lowered by its bias.
HWY_INLINE PatchVisit enter_patch(const cpu::SceneView& scene, cpu::TraceContext& context, uint32_t instance,
                                  uint32_t patch, uint32_t bias) {
    const Instance& placed = scene.instances[instance];
    ++context.counters.pairs_emitted;
    const uint32_t levels = placed.levels->packed_at(patch);
    return {&scene, &context, placed.surface, patch,
            bias == 0 ? levels : scalar::lower_packed_levels(levels, bias)};
}

/// Paper 1's rule (Harada 2015): one level for the whole patch from the width of the ray's cone there.
HWY_INLINE void choose_ray_level(PatchVisit& visit, const Instance& placed, const cpu::TraceRay& world) {
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

HWY_INLINE const cpu::BottomTree& find_tree(const PatchVisit& visit, uint32_t tile) {
    return visit.scene->cache->find_or_build_tree(*visit.context, visit.scene->surfaces[visit.surface],
                                                  {visit.surface, visit.patch, tile, visit.levels},
                                                  build_tree);
}

HWY_INLINE const cpu::TileDirectory& find_directory(const PatchVisit& visit) {
    return visit.scene->cache->find_or_build_directory(
        *visit.context, visit.scene->surfaces[visit.surface],
        {visit.surface, visit.patch, cpu::kDirectoryTile, visit.levels});
}

/// Which triangle of the patch lane `lane` of a block is, and the place on the patch from the weights of its
/// corners.
HWY_INLINE void locate_in_block(const PatchVisit& visit, const cpu::BottomTree& tree, uint32_t block,
                                uint32_t lane, float weight_b, float weight_c, cpu::TraceHit& hit) {
    uint32_t column = 0, row = 0;
    cpu::BottomTree::block_cell(int(tree.level), block, column, row);
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
    HWY_INLINE BlockPlace(const cpu::BottomTree& tree, int level, uint32_t block)
        : first(tree.grid(level) + cpu::BottomTree::find_first_vertex(level, block)),
          column_count(cpu::BottomTree::column_count(level)),
          axis_step(cpu::BottomTree::vertex_count(level)) {}
    HWY_INLINE Lanes16 load(int axis) const {
        return load_block(first + uint32_t(axis) * axis_step, column_count);
    }
};

/// Exact leaf: sixteen triangles at once. load(axis) gives a coordinate of the vertices of the block.
template <Query kQuery, class Load>
HWY_INLINE bool intersect_triangles(const PatchVisit& visit, const cpu::BottomTree& tree, uint32_t block,
                                    Load load, RayState& ray) {
    Lanes16 x, y, z, cx[3], cy[3], cz[3];
    shear_vertices(load, ray, x, y, z);
    gather_corners(x, cx[0], cx[1], cx[2]);
    gather_corners(y, cy[0], cy[1], cy[2]);
    TriangleTest<16> test;
    if (!test_edges(cx, cy, test)) return false;
    gather_corners(z, cz[0], cz[1], cz[2]);
    test_distances(cz, ray, test);
    if (!test.mask) return false;
    if constexpr (kQuery == Query::any) return true;
    offer_hits(ray, test, [&](uint32_t lane, float weight_b, float weight_c, cpu::TraceHit& hit) {
        locate_in_block(visit, tree, block, lane, weight_b, weight_c, hit);
    });
    return true;
}

/// Paper 1's leaf (Harada 2015, section 1.4): a micro-quad counts as hit where the ray enters its box. A ray
/// that begins inside a box leaves it unhit, so that it cannot meet the quad that it starts on.
template <Query kQuery>
HWY_NOINLINE bool intersect_boxes(const PatchVisit& visit, const cpu::BottomTree& tree, uint32_t block,
                                  RayState& ray) {
    const BlockPlace at(tree, int(tree.level), block);
    alignas(32) float bounds[6][8];
    for (int axis = 0; axis < 3; ++axis)
        for (uint32_t cell = 0; cell < 8; ++cell) {
            const float* v =
                at.first + uint32_t(axis) * at.axis_step + (cell >> 2) * at.column_count + (cell & 3);
            const float* w = v + at.column_count;
            bounds[axis][cell] = std::fmin(std::fmin(v[0], v[1]), std::fmin(w[0], w[1]));
            bounds[3 + axis][cell] = std::fmax(std::fmax(v[0], v[1]), std::fmax(w[0], w[1]));
        }
    Lanes8 bound[6], entry;
    for (int k = 0; k < 6; ++k) bound[k] = Lanes8::load(bounds[k]);
    LaneMask mask = test_boxes(bound, ray, entry) & less(Lanes8(ray.t_min), entry);
    uint32_t column = 0, row = 0;
    cpu::BottomTree::block_cell(int(tree.level), block, column, row);
    const uint32_t cells = 1u << tree.level;
    const float cell_size = visit.cell_size();
    alignas(32) float distance[8];
    entry.store(distance);
    bool has_hit = false;
    for (; mask; mask &= mask - 1) {
        const uint32_t cell = uint32_t(__builtin_ctz(mask));
        if (column + (cell & 3) >= cells || row + (cell >> 2) >= cells || distance[cell] > ray.t_max)
            continue;
        if constexpr (kQuery == Query::any) return true;
        cpu::TraceHit hit;
        hit.t = distance[cell];
        hit.instance = ray.instance;
        hit.patch = visit.patch;
        hit.levels = visit.levels;
        hit.i = uint16_t(tree.cell_x + column + (cell & 3)),
        hit.j = uint16_t(tree.cell_y + row + (cell >> 2));
        hit.u = (float(hit.i) + 0.5f) * cell_size, hit.v = (float(hit.j) + 0.5f) * cell_size;
        offer_hit(ray.hit, ray.t_max, hit);
        has_hit = true;
    }
    return has_hit;
}

template <Query kQuery, class Load>
HWY_INLINE bool intersect_block(const PatchVisit& visit, const cpu::BottomTree& tree, uint32_t block,
                                Load load, RayState& ray) {
    ++visit.context->counters.blocks;
    return visit.scene->leaf == LeafKind::exact ? intersect_triangles<kQuery>(visit, tree, block, load, ray)
                                                : intersect_boxes<kQuery>(visit, tree, block, ray);
}

/// `level` as for BlockPlace.
template <Query kQuery>
HWY_INLINE bool intersect_block(const PatchVisit& visit, const cpu::BottomTree& tree, int level,
                                uint32_t block, RayState& ray) {
    const BlockPlace at(tree, level, block);
    return intersect_block<kQuery>(
        visit, tree, block, [&](int axis) { return at.load(axis); }, ray);
}

/// Leaves of a list, nearest first; for Query::any as they come, since all of them are at hand already.
/// Leaf k is the blocks [k kBlocks, (k + 1) kBlocks).
template <Query kQuery, uint32_t kBlocks, class List>
HWY_INLINE bool trace_leaves(const PatchVisit& visit, const cpu::BottomTree& tree, int level, List& leaves,
                             RayState& ray) {
    bool has_hit = false;
    if constexpr (kQuery == Query::closest) leaves.sort();
    for (uint32_t k = 0; k < leaves.count; ++k) {
        if (kQuery == Query::closest && leaves.distance(k) > ray.t_max * kBoxSlack) continue;
        const uint32_t first = leaves.child(k) * kBlocks;
        for (uint32_t block = first; block < first + kBlocks; ++block) {
            has_hit |= intersect_block<kQuery>(visit, tree, level, block, ray);
            if (kQuery == Query::any && has_hit) return true;
        }
    }
    return has_hit;
}

/// Everything of a tile along one ray. The boxes of all groups are tested before the first block: their loads
/// overlap, and one list is sorted instead of many.
template <Query kQuery> bool trace_tree(const PatchVisit& visit, const cpu::BottomTree& tree, RayState& ray) {
    Lanes8 entry8;
    Lanes16 entry;
    uint64_t& nodes = visit.context->counters.patch_nodes;
    nodes += tree.level >= 3;
    if (tree.level == 6) {
        EntryList<256> squares;
        for (LaneMask groups = test_node(tree.root().bounds, ray, entry); groups; groups &= groups - 1) {
            const uint32_t g = uint32_t(__builtin_ctz(groups));
            ++nodes;
            Lanes16 inner;
            const LaneMask mask = test_node(tree.wide_group(int(g)).bounds, ray, inner);
            squares.append(mask, inner, g * 16);
        }
        return trace_leaves<kQuery, 2>(visit, tree, 6, squares, ray);
    }
    if (tree.level == 5) {
        EntryList<128> blocks;
        for (LaneMask groups = test_node(tree.root().bounds, ray, entry); groups; groups &= groups - 1) {
            const uint32_t g = uint32_t(__builtin_ctz(groups));
            ++nodes;
            const LaneMask mask = test_node(tree.group(int(g)).bounds, ray, entry8);
            blocks.append(mask, entry8, g * 8);
        }
        return trace_leaves<kQuery, 1>(visit, tree, 5, blocks, ray);
    }
    if (tree.level == 3) {
        EntryList<8> blocks;
        const LaneMask mask = test_node(tree.group(0).bounds, ray, entry8);
        blocks.append(mask, entry8, 0);
        return trace_leaves<kQuery, 1>(visit, tree, 3, blocks, ray);
    }
    bool has_hit = false;
    const auto test_block = [&](uint32_t block) {
        has_hit |= intersect_block<kQuery>(visit, tree, int(tree.level), block, ray);
        return kQuery == Query::any && has_hit;
    };
    if (tree.level == 4) {
        const LaneMask mask = test_node(tree.root().bounds, ray, entry);
        visit_in_order(mask, entry, ray,
                       [&](uint32_t g) { return test_block(2 * g) || test_block(2 * g + 1); });
    } else {
        for (uint32_t block = 0; block < cpu::BottomTree::block_count(int(tree.level)); ++block)
            if (test_block(block)) break;
    }
    return has_hit;
}

/// One node of a directory and everything below it.
template <Query kQuery>
bool trace_directory(const PatchVisit& visit, const cpu::TileDirectory& directory, uint32_t step, uint32_t x,
                     uint32_t y, RayState& ray) {
    using cpu::TileDirectory;
    const uint32_t depth = directory.depth, shift = TileDirectory::fanout(depth, step) / 2; // 2: 1, 4: 2
    const uint32_t node =
        TileDirectory::step_begin(depth, step) + y * TileDirectory::step_side(depth, step) + x;
    Lanes16 entry;
    const LaneMask mask = test_node(directory.nodes()[node].bounds, ray, entry);
    const bool is_last = step + 1 == TileDirectory::step_count(depth);
    uint32_t visited = 0; // a bit a tile
    bool has_hit = false;
    ++visit.context->counters.patch_nodes;
    visit_in_order(mask, entry, ray, [&](uint32_t child) {
        const uint32_t cx = (x << shift) + (child & ((1u << shift) - 1)),
                       cy = (y << shift) + (child >> shift);
        if (!is_last) {
            has_hit |= trace_directory<kQuery>(visit, directory, step + 1, cx, cy, ray);
        } else if (const uint32_t bit = 1u << TileDirectory::find_tile_of_node(child); !(visited & bit)) {
            visited |= bit;
            const uint32_t tile = TileDirectory::find_tile(depth, cx, cy);
            has_hit |= trace_tree<kQuery>(visit, find_tree(visit, tile), ray);
        }
        return kQuery == Query::any && has_hit;
    });
    return has_hit;
}

/// Everything of a patch along one ray.
template <Query kQuery> HWY_INLINE bool trace_patch(const PatchVisit& visit, RayState& ray) {
    const bool has_hit = visit.level() <= cpu::kTileLevel
                             ? trace_tree<kQuery>(visit, find_tree(visit, 0), ray)
                             : trace_directory<kQuery>(visit, find_directory(visit), 0, 0, 0, ray);
    visit.context->counters.pairs_with_hit += has_hit;
    return has_hit;
}

} // namespace relief::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
