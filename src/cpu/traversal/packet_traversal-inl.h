// Sixteen coherent rays at once: boxes are tested against all of them, leaf blocks against those that enter.
// The tests are those of single rays: hits are bit-identical. Larger groups with a common origin travel as a
// bundle (bundle_traversal-inl.h).
#pragma once

#include "cpu/traversal/ray_packet-inl.h"
#include "cpu/traversal/scene_traversal-inl.h"

HWY_BEFORE_NAMESPACE();
namespace relief::HWY_NAMESPACE {

/// Fewer rays than this go on alone: sixteen lanes for two rays waste more than they share.
inline constexpr int kLeastPacket = 3;

/// Children that some ray of the packet may enter.
template <class Node> RELIEF_INLINE LaneMask test_children(const Node& node, const PacketBounds& bounds) {
    using Plane = decltype(load_plane(node, 0, 0));
    Plane entry(bounds.t_min), exit(bounds.t_max);
    for (int k = 0; k < 3; ++k) {
        const Plane least(bounds.least_reciprocal[k]), greatest(bounds.greatest_reciprocal[k]);
        const Plane near = load_plane(node, bounds.near_plane[k], k) - Plane(bounds.near_origin[k]);
        const Plane far = load_plane(node, bounds.far_plane[k], k) - Plane(bounds.far_origin[k]);
        entry = max(entry, min(near * least, near * greatest));
        exit = min(exit, max(far * least, far * greatest));
    }
    return less_equal(entry, exit * Plane(kBoxSlack)) & mask_children(node);
}

/// Lanes of `mask` that enter child k, and a lower bound of their nearest entry (of all lanes).
template <class Node>
RELIEF_INLINE LaneMask test_child(const Node& node, uint32_t k, const Packet& packet, LaneMask mask,
                                  float& nearest) {
    Lanes16 near[3], far[3];
    for (int axis = 0; axis < 3; ++axis) {
        const Lanes16 lower(get_plane(node, axis, axis, k)), upper(get_plane(node, 3 + axis, axis, k));
        const Lanes16 a = (lower - packet.lower_origin[axis]) * packet.reciprocal[axis];
        const Lanes16 b = (upper - packet.upper_origin[axis]) * packet.reciprocal[axis];
        near[axis] = min(a, b), far[axis] = max(a, b);
    }
    const Lanes16 entry = max(max(near[0], near[1]), max(near[2], packet.t_min));
    const Lanes16 exit = min(min(far[0], far[1]), min(far[2], Lanes16::load(packet.t_max)));
    mask &= less_equal(entry, exit * Lanes16(kBoxSlack));
    if (mask) nearest = reduce_min(entry);
    return mask;
}

struct PacketEntry {
    uint32_t child;
    LaneMask mask;
    float entry;
};

/// Calls take(child, lanes, nearest entry) for the boxes of a node that lanes of `mask` enter.
template <class Node, class Take>
RELIEF_INLINE void find_entered(const Node& node, const Packet& packet, LaneMask mask, Take take) {
    for (LaneMask children = test_children(node, packet.bounds); children; children &= children - 1) {
        const uint32_t k = uint32_t(__builtin_ctz(children));
        float nearest = 0;
        if (const LaneMask entered = test_child(node, k, packet, mask, nearest)) take(k, entered, nearest);
    }
}

/// A packet inside a patch. All of its rays have one LOD bias, hence one tree.
template <Query kQuery> struct PacketProbe {
    static constexpr bool kListsLeaves = false;

    PatchVisit visit;
    Packet& packet;
    LaneMask hits = 0;

    void count_pairs(LaneMask rays) const {
        visit.count_pairs(uint32_t(__builtin_popcount(rays)), uint32_t(__builtin_popcount(hits)));
    }

    template <size_t W, class Visit>
    RELIEF_INLINE bool visit_children(const float (&bounds)[6][W], LaneMask rays, Visit visit_child) {
        PacketEntry order[W];
        uint32_t size = 0;
        find_entered(bounds, packet, rays, [&](uint32_t k, LaneMask entered, float nearest) {
            insert_sorted<kNearestFirst>({k, entered, nearest}, order, size);
        });
        for (uint32_t k = 0; k < size; ++k)
            if (const LaneMask left = order[k].mask & packet.active) visit_child(order[k].child, left);
        return false;
    }

    RELIEF_INLINE bool test_block(const cpu::PatchTree& tree, int level, uint32_t block, LaneMask rays) {
        if (!(rays &= packet.active)) return false;
        // Put together once for all rays; box leaves do not look at them.
        const BlockPlace place(tree, level, block);
        alignas(64) float vertices[3][16];
        if (visit.scene->leaf == LeafKind::exact)
            for (int axis = 0; axis < 3; ++axis) place.load(axis).store(vertices[axis]);
        const auto load = [&](int axis) { return Lanes16::load(vertices[axis]); };
        for (; rays; rays &= rays - 1) {
            const uint32_t lane = uint32_t(__builtin_ctz(rays));
            if (!intersect_block<kQuery>(visit, tree, block, load, packet.ray[lane])) continue;
            hits |= 1u << lane;
            packet.t_max[lane] = packet.ray[lane].t_max;
            if constexpr (kQuery == Query::any) packet.active &= ~(1u << lane);
        }
        if (kQuery == Query::closest && hits != 0) packet.update_reach();
        return false;
    }
};

/// A packet in a wide tree. traverse_single(child, lane) takes subtrees that few rays enter.
template <class TraverseSingle> struct PacketWalker {
    using Entry = PacketEntry;

    Packet& packet;
    TraverseSingle traverse_single;

    RELIEF_INLINE bool enter(PacketEntry& top) {
        top.mask &=
            packet.active & less_equal(Lanes16(top.entry), Lanes16::load(packet.t_max) * Lanes16(kBoxSlack));
        if (__builtin_popcount(top.mask) >= kLeastPacket) return true;
        for (LaneMask left = top.mask; left; left &= left - 1)
            traverse_single(top.child, uint32_t(__builtin_ctz(left)));
        return false;
    }
    template <class Node>
    RELIEF_INLINE bool open(const Node& node, PacketEntry& top, PacketEntry* stack, uint32_t& size) {
        uint32_t count = 0;
        find_entered(node, packet, top.mask, [&](uint32_t k, LaneMask entered, float nearest) {
            insert_sorted<kFarthestFirst>({node.child[k], entered, nearest}, stack + size, count);
        });
        size += count;
        return false;
    }
};
template <class TraverseSingle> PacketWalker(Packet&, TraverseSingle) -> PacketWalker<TraverseSingle>;

/// A lane that was traced by itself, or against a block of polygons.
template <Query kQuery> RELIEF_INLINE void take_hit(Packet& packet, uint32_t lane, bool has_hit) {
    packet.t_max[lane] = packet.ray[lane].t_max;
    if (kQuery == Query::any && has_hit) packet.active &= ~(1u << lane);
    if (kQuery == Query::closest && has_hit) packet.update_reach();
}

/// Everything of one instance for the lanes of `mask`.
template <Query kQuery>
RELIEF_INLINE void trace_surface(const cpu::SceneView& scene, cpu::TraceContext& context, uint32_t surface,
                                 Packet& packet, LaneMask mask) {
    PacketWalker walker{packet, [&](uint32_t child, uint32_t lane) {
                            take_hit<kQuery>(packet, lane,
                                             trace_instance<kQuery>(scene, context, packet.world[lane], child,
                                                                    packet.ray[lane]));
                        }};
    if (scene.surfaces[surface].has_displacement) {
        walk_primitives(scene.surface_trees[surface], context, walker, {0, mask, 0},
                        [&](uint32_t patch, const PacketEntry& leaf) {
                            const LaneMask left = leaf.mask & packet.active;
                            if (left == 0) return false;
                            const uint32_t lane = uint32_t(__builtin_ctz(left)); // all have one LOD bias
                            PacketProbe<kQuery> probe{{scene, context, packet.ray[lane].instance, patch,
                                                       packet.world[lane].lod_bias},
                                                      packet};
                            visit_patch(probe, left);
                            return false;
                        });
        return;
    }
    const cpu::PolygonTree& tree = scene.polygon_trees[surface];
    uint32_t visited = 0;
    walk_wide_tree(tree.nodes, walker, {0, mask, 0}, visited, [&](const PacketEntry& leaf) {
        const cpu::TriangleBlock& block = tree.blocks[cpu::PolygonNode::leaf_first(leaf.child)];
        for (LaneMask left = leaf.mask & packet.active; left; left &= left - 1) {
            const uint32_t lane = uint32_t(__builtin_ctz(left));
            take_hit<kQuery>(packet, lane, intersect_triangles<kQuery>(block, packet.ray[lane]));
        }
        return false;
    });
}

/// The lanes of `mask` that begin far away from an instance go there by themselves, each moved; returns the
/// others.
template <Query kQuery>
RELIEF_INLINE LaneMask visit_from_far(const cpu::SceneView& scene, cpu::TraceContext& context,
                                      uint32_t instance, Packet& world, LaneMask mask) {
    LaneMask far = world.lanes->find_far_away(scene.instances[instance]) & mask;
    const LaneMask near = mask & ~far;
    for (; far; far &= far - 1) {
        const uint32_t lane = uint32_t(__builtin_ctz(far));
        take_hit<kQuery>(
            world, lane,
            visit_instance<kQuery>(scene, context, world.world[lane], instance, world.ray[lane]));
    }
    return near;
}

/// The instance for the lanes of `mask`; results go back to the packet of world rays.
template <Query kQuery>
void trace_instance(const cpu::SceneView& scene, cpu::TraceContext& context, uint32_t instance, Packet& world,
                    LaneMask mask) {
    if (!scene.is_visible(instance)) return;
    mask = visit_from_far<kQuery>(scene, context, instance, world, mask);
    if (mask == 0) return;
    const Instance& placed = scene.instances[instance];
    if (placed.is_in_place) {
        for (RayState& ray : world.ray) ray.instance = instance;
        trace_surface<kQuery>(scene, context, placed.surface, world, mask);
        return;
    }
    Packet local;
    local.world = world.world, local.lanes = world.lanes;
    local.active = mask;
    for (int lane = 0; lane < 16; ++lane) local.ray[lane].hit = world.ray[lane].hit;
    enter_object(*world.lanes, Lanes16::load(world.t_max), placed.object_space, instance, local);
    trace_surface<kQuery>(scene, context, placed.surface, local, mask);
    for (LaneMask left = mask; left; left &= left - 1) {
        const uint32_t lane = uint32_t(__builtin_ctz(left));
        take_over(world.ray[lane], local.ray[lane]);
        world.t_max[lane] = local.ray[lane].t_max;
    }
    world.update_reach();
    world.active &= ~(mask & ~local.active);
}

/// The whole scene for sixteen rays, `lanes` in lanes. Returns the lanes with a hit (Query::any).
template <Query kQuery>
LaneMask trace_packet(const cpu::SceneView& scene, cpu::TraceContext& context, const cpu::TraceRay* rays,
                      const RayLanes& lanes, Packet& packet) {
    packet.world = rays, packet.lanes = &lanes;
    packet.active = 0xffff;
    if (scene.instance_count == 1 && lanes.find_far_away(scene.instances[0]) == 0) {
        enter_object(lanes, lanes.t_max, scene.instances[0].object_space, 0, packet);
        trace_surface<kQuery>(scene, context, scene.instances[0].surface, packet, 0xffff);
        return ~packet.active & 0xffff;
    }
    enter_object(lanes, lanes.t_max, {}, kNoIndex, packet);
    PacketWalker walker{packet, [&](uint32_t child, uint32_t lane) {
                            take_hit<kQuery>(
                                packet, lane,
                                trace_scene<kQuery>(scene, context, rays[lane], child, packet.ray[lane]));
                        }};
    walk_primitives(*scene.instance_tree, context, walker, {0, 0xffff, 0},
                    [&](uint32_t instance, const PacketEntry& leaf) {
                        if (const LaneMask left = leaf.mask & packet.active)
                            trace_instance<kQuery>(scene, context, instance, packet, left);
                        return false;
                    });
    return ~packet.active & 0xffff;
}

} // namespace relief::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
