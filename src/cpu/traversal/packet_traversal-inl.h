// Sixteen coherent rays at once: every box is tested against all of them, every leaf block against those that
// enter it. Boxes and triangles are the very tests of the single ray, so that a ray's hit does not depend on
// its company.
// Many rays from one point, and those through a lens, travel as a bundle instead (bundle_traversal-inl.h).
#if defined(RELIEF_PACKET_TRAVERSAL_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RELIEF_PACKET_TRAVERSAL_INL_H
#undef RELIEF_PACKET_TRAVERSAL_INL_H
#else
#define RELIEF_PACKET_TRAVERSAL_INL_H
#endif

#include <optional>

#include "cpu/traversal/ray_packet-inl.h"
#include "cpu/traversal/scene_traversal-inl.h"

HWY_BEFORE_NAMESPACE();
namespace relief::HWY_NAMESPACE {

/// Fewer rays than this go on alone: sixteen lanes for two rays waste more than they share.
inline constexpr int kLeastPacket = 3;

/// Children that some ray of the packet may enter; load(plane) gives a plane of their boxes.
template <size_t W, class Load> HWY_INLINE LaneMask test_planes(const PacketBounds& bounds, Load load) {
    Lanes<W> entry(bounds.t_min), exit(bounds.t_max);
    for (int k = 0; k < 3; ++k) {
        const Lanes<W> least(bounds.least_reciprocal[k]), greatest(bounds.greatest_reciprocal[k]);
        const Lanes<W> near = load(bounds.near_plane[k]) - Lanes<W>(bounds.near_origin[k]);
        const Lanes<W> far = load(bounds.far_plane[k]) - Lanes<W>(bounds.far_origin[k]);
        entry = max(entry, min(near * least, near * greatest));
        exit = min(exit, max(far * least, far * greatest));
    }
    return less_equal(entry, exit * Lanes<W>(kBoxSlack));
}
template <size_t W>
HWY_INLINE LaneMask test_children(const float (&planes)[6][W], const PacketBounds& bounds) {
    return test_planes<W>(bounds, [&](int plane) { return Lanes<W>::load(planes[plane]); });
}
HWY_INLINE LaneMask test_children(const cpu::PolygonNode& node, const PacketBounds& bounds) {
    return test_children(node.bounds, bounds);
}
HWY_INLINE LaneMask test_children(const WideNode& node, const PacketBounds& bounds) {
    const auto load = [&](int plane) {
        const int axis = plane % 3;
        return Lanes8::decode(node.planes[plane], node.origin[axis],
                              WideNode::decode_scale(node.exponent[axis]));
    };
    return test_planes<8>(bounds, load) & ((1u << node.child_count) - 1);
}

/// Lanes of `mask` that enter a box, and the nearest entry among them (other lanes included: a bound from
/// below).
HWY_INLINE LaneMask test_box(const float (&lower)[3], const float (&upper)[3], const Packet& packet,
                             LaneMask mask, float& nearest) {
    Lanes16 near[3], far[3];
    for (int k = 0; k < 3; ++k) {
        const Lanes16 a = (Lanes16(lower[k]) - packet.lower_origin[k]) * packet.reciprocal[k];
        const Lanes16 b = (Lanes16(upper[k]) - packet.upper_origin[k]) * packet.reciprocal[k];
        near[k] = min(a, b), far[k] = max(a, b);
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

/// Child k of a node of boxes stored as lower x y z, upper x y z.
template <class Node>
HWY_INLINE LaneMask test_child(const Node& node, uint32_t k, const Packet& packet, LaneMask mask,
                               float& nearest) {
    const float lower[3] = {node.bounds[0][k], node.bounds[1][k], node.bounds[2][k]};
    const float upper[3] = {node.bounds[3][k], node.bounds[4][k], node.bounds[5][k]};
    return test_box(lower, upper, packet, mask, nearest);
}

/// Calls visit(child, mask) for the children that any lane enters, nearest first.
template <class Node, class Visit>
HWY_INLINE void visit_children(const Node& node, Packet& packet, LaneMask mask, Visit visit) {
    PacketEntry order[16];
    uint32_t size = 0;
    for (LaneMask children = test_children(node.bounds, packet.bounds); children; children &= children - 1) {
        const uint32_t k = uint32_t(__builtin_ctz(children));
        float nearest = 0;
        const LaneMask entered = test_child(node, k, packet, mask, nearest);
        if (!entered) continue;
        uint32_t slot = size++;
        for (; slot > 0 && order[slot - 1].entry > nearest; --slot) order[slot] = order[slot - 1];
        order[slot] = {k, entered, nearest};
    }
    for (uint32_t k = 0; k < size; ++k)
        if (const LaneMask left = order[k].mask & packet.active) visit(order[k].child, left);
}

template <Query kQuery>
HWY_INLINE void trace_block(const PatchVisit& visit, const cpu::BottomTree& tree, uint32_t block,
                            Packet& packet, LaneMask mask, LaneMask& hits) {
    if (!(mask &= packet.active)) return;
    // Put together once for all rays; box leaves do not look at them.
    const BlockPlace place(tree, int(tree.level), block);
    alignas(64) float vertices[3][16];
    if (visit.scene->leaf == LeafKind::exact)
        for (int axis = 0; axis < 3; ++axis) place.load(axis).store(vertices[axis]);
    const auto load = [&](int axis) { return Lanes16::load(vertices[axis]); };
    for (; mask; mask &= mask - 1) {
        const uint32_t lane = uint32_t(__builtin_ctz(mask));
        if (!intersect_block<kQuery>(visit, tree, block, load, packet.ray[lane])) continue;
        hits |= 1u << lane;
        packet.t_max[lane] = packet.ray[lane].t_max;
        if constexpr (kQuery == Query::any) packet.active &= ~(1u << lane);
    }
    if (kQuery == Query::closest && hits != 0) packet.update_reach();
}

template <Query kQuery>
void trace_tree(const PatchVisit& visit, const cpu::BottomTree& tree, Packet& packet, LaneMask mask,
                LaneMask& hits) {
    uint64_t& nodes = visit.context->counters.patch_nodes;
    const auto test_block = [&](uint32_t block, LaneMask entered) {
        trace_block<kQuery>(visit, tree, block, packet, entered, hits);
    };
    const auto test_square = [&](uint32_t square, LaneMask entered) {
        test_block(2 * square, entered);
        test_block(2 * square + 1, entered);
    };
    nodes += tree.level >= 3;
    if (tree.level == 6) {
        visit_children(tree.root(), packet, mask, [&](uint32_t g, LaneMask entered) {
            ++nodes;
            visit_children(tree.wide_group(int(g)), packet, entered,
                           [&](uint32_t k, LaneMask left) { test_square(g * 16 + k, left); });
        });
    } else if (tree.level == 5) {
        visit_children(tree.root(), packet, mask, [&](uint32_t g, LaneMask entered) {
            ++nodes;
            visit_children(tree.group(int(g)), packet, entered,
                           [&](uint32_t k, LaneMask left) { test_block(g * 8 + k, left); });
        });
    } else if (tree.level == 4) {
        visit_children(tree.root(), packet, mask, test_square);
    } else if (tree.level == 3) {
        visit_children(tree.group(0), packet, mask, test_block);
    } else {
        for (uint32_t block = 0; block < cpu::BottomTree::block_count(int(tree.level)); ++block)
            test_block(block, mask);
    }
}

template <Query kQuery>
void trace_directory(const PatchVisit& visit, const cpu::TileDirectory& directory, uint32_t step,
                     uint32_t index, Packet& packet, LaneMask mask, LaneMask& hits) {
    using cpu::TileDirectory;
    const uint32_t depth = directory.depth, fanout = TileDirectory::fanout(depth, step);
    const uint32_t side = TileDirectory::step_side(depth, step), x = index % side, y = index / side;
    const cpu::Node16& node = directory.nodes()[TileDirectory::step_begin(depth, step) + index];
    const bool is_last = step + 1 == TileDirectory::step_count(depth);
    LaneMask visited[4] = {}; // of a tile, by these lanes
    ++visit.context->counters.patch_nodes;
    visit_children(node, packet, mask, [&](uint32_t child, LaneMask entered) {
        const uint32_t cx = x * fanout + child % fanout, cy = y * fanout + child / fanout;
        if (!is_last) {
            trace_directory<kQuery>(visit, directory, step + 1, cy * side * fanout + cx, packet, entered,
                                    hits);
            return;
        }
        LaneMask& before = visited[TileDirectory::find_tile_of_node(child)];
        if (const LaneMask left = entered & ~before) {
            before |= left;
            const uint32_t tile = TileDirectory::find_tile(depth, cx, cy);
            trace_tree<kQuery>(visit, find_tree(visit, tile), packet, left, hits);
        }
    });
}

/// A patch for the lanes of `mask`. All rays of a packet have one bias, hence one tree.
template <Query kQuery>
void trace_patch(const cpu::SceneView& scene, cpu::TraceContext& context, uint32_t patch, Packet& packet,
                 LaneMask mask) {
    const uint32_t lane = uint32_t(__builtin_ctz(mask));
    const PatchVisit visit =
        enter_patch(scene, context, packet.ray[lane].instance, patch, packet.world[lane].bias);
    LaneMask hits = 0;
    const std::optional<Timer> timer = context.is_timed ? std::optional<Timer>(std::in_place) : std::nullopt;
    const double built_before = context.counters.bottom_build_s;
    if (visit.level() <= cpu::kTileLevel)
        trace_tree<kQuery>(visit, find_tree(visit, 0), packet, mask, hits);
    else
        trace_directory<kQuery>(visit, find_directory(visit), 0, 0, packet, mask, hits);
    context.counters.pairs_emitted += uint64_t(__builtin_popcount(mask)) - 1;
    context.counters.pairs_with_hit += uint64_t(__builtin_popcount(hits));
    if (context.is_timed)
        context.counters.sampled_bottom_s +=
            timer->seconds() - (context.counters.bottom_build_s - built_before);
}

/// Calls visit(primitive, mask) for what a leaf of a wide tree holds.
template <class Visit>
HWY_INLINE void visit_primitives(const WideBvh& tree, uint32_t leaf, const Packet& packet, LaneMask mask,
                                 Visit visit) {
    const uint32_t first = WideNode::leaf_first(leaf), count = WideNode::leaf_count(leaf);
    for (uint32_t k = 0; k < count; ++k)
        if (const LaneMask left = mask & packet.active) visit(tree.primitive_at(first + k), left);
}

HWY_INLINE LaneMask test_child(const WideNode& node, uint32_t k, const Packet& packet, LaneMask mask,
                               float& nearest) {
    const Box box = node.child_box(int(k));
    const float lower[3] = {box.lower.x, box.lower.y, box.lower.z};
    const float upper[3] = {box.upper.x, box.upper.y, box.upper.z};
    return test_box(lower, upper, packet, mask, nearest);
}

HWY_INLINE uint32_t count_children(const WideNode& node) { return node.child_count; }
HWY_INLINE uint32_t count_children(const cpu::PolygonNode& node) {
    uint32_t count = 0;
    while (count < 8 && node.child[count] != cpu::PolygonNode::kNoChild) ++count;
    return count;
}

/// Walks a tree of wide nodes with the packet. visit_leaf(child, mask) takes the leaves, go_alone(child,
/// lane) a subtree that few rays enter. Returns how many nodes were visited together.
template <class Nodes, class VisitLeaf, class GoAlone>
uint32_t walk_packet(const Nodes& nodes, Packet& packet, LaneMask mask, VisitLeaf visit_leaf,
                     GoAlone go_alone) {
    using Node = typename Nodes::value_type;
    if (nodes.empty()) return 0;
    PacketEntry stack[kStackSize];
    uint32_t size = 0, visited = 0;
    stack[size++] = {0, mask, 0};
    while (size > 0) {
        PacketEntry top = stack[--size];
        top.mask &=
            packet.active & less_equal(Lanes16(top.entry), Lanes16::load(packet.t_max) * Lanes16(kBoxSlack));
        if (!top.mask) continue;
        if (__builtin_popcount(top.mask) < kLeastPacket) {
            for (LaneMask left = top.mask; left; left &= left - 1)
                go_alone(top.child, uint32_t(__builtin_ctz(left)));
            continue;
        }
        if (Node::is_leaf(top.child)) {
            visit_leaf(top.child, top.mask);
            continue;
        }
        const Node& node = nodes[top.child];
        ++visited;
        const uint32_t base = size;
        DCHECK(size + 8 <= kStackSize);
        for (LaneMask children = test_children(node, packet.bounds); children; children &= children - 1) {
            const uint32_t k = uint32_t(__builtin_ctz(children));
            float nearest = 0;
            const LaneMask entered = test_child(node, k, packet, top.mask, nearest);
            if (!entered) continue;
            uint32_t slot = size++;
            for (; slot > base && stack[slot - 1].entry < nearest; --slot) stack[slot] = stack[slot - 1];
            stack[slot] = {node.child[k], entered, nearest};
        }
    }
    return visited;
}

/// Everything of one instance for the lanes of `mask`.
template <Query kQuery>
HWY_INLINE void walk_surface(const cpu::SceneView& scene, cpu::TraceContext& context, uint32_t surface,
                             Packet& packet, LaneMask mask) {
    const auto take_hit = [&](uint32_t lane, bool has_hit) {
        packet.t_max[lane] = packet.ray[lane].t_max;
        if (kQuery == Query::any && has_hit) packet.active &= ~(1u << lane);
        if (kQuery == Query::closest && has_hit) packet.update_reach();
    };
    const auto go_alone = [&](uint32_t child, uint32_t lane) {
        take_hit(lane, trace_instance<kQuery>(scene, context, packet.world[lane], child, packet.ray[lane]));
    };
    if (!scene.surfaces[surface].has_displacement) {
        const cpu::PolygonTree& tree = scene.polygon_trees[surface];
        const auto visit_block = [&](uint32_t leaf, LaneMask entered) {
            const cpu::TriangleBlock& block = tree.blocks[cpu::PolygonNode::leaf_block(leaf)];
            for (entered &= packet.active; entered; entered &= entered - 1) {
                const uint32_t lane = uint32_t(__builtin_ctz(entered));
                take_hit(lane, intersect_triangles<kQuery>(block, packet.ray[lane]));
            }
        };
        walk_packet(tree.nodes, packet, mask, visit_block, go_alone);
        return;
    }
    const WideBvh& tree = scene.surface_trees[surface];
    const auto visit_leaf = [&](uint32_t leaf, LaneMask entered) {
        visit_primitives(tree, leaf, packet, entered, [&](uint32_t patch, LaneMask left) {
            trace_patch<kQuery>(scene, context, patch, packet, left);
        });
    };
    context.counters.upper_nodes += walk_packet(tree.nodes, packet, mask, visit_leaf, go_alone);
}

/// The instance for the lanes of `mask`; results go back to the packet of world rays.
template <Query kQuery>
void trace_instance(const cpu::SceneView& scene, cpu::TraceContext& context, uint32_t instance, Packet& world,
                    LaneMask mask) {
    if (!scene.is_visible(instance)) return;
    const Instance& placed = scene.instances[instance];
    if (placed.is_in_place) {
        for (RayState& ray : world.ray) ray.instance = instance;
        walk_surface<kQuery>(scene, context, placed.surface, world, mask);
        return;
    }
    Packet local;
    local.world = world.world, local.lanes = world.lanes;
    local.active = mask;
    for (int lane = 0; lane < 16; ++lane) local.ray[lane].hit = world.ray[lane].hit;
    enter_object(*world.lanes, Lanes16::load(world.t_max), placed.object_from_world, instance, local);
    walk_surface<kQuery>(scene, context, placed.surface, local, mask);
    for (LaneMask left = mask; left; left &= left - 1) {
        const uint32_t lane = uint32_t(__builtin_ctz(left));
        world.ray[lane].hit = local.ray[lane].hit;
        world.ray[lane].t_max = world.t_max[lane] = local.ray[lane].t_max;
    }
    world.update_reach();
    world.active &= ~(mask & ~local.active);
}

/// The whole scene for sixteen rays, whose lanes are `lanes`; `packet` is a new one. Returns the lanes with a
/// hit (Query::any).
template <Query kQuery>
LaneMask trace_packet(const cpu::SceneView& scene, cpu::TraceContext& context, const cpu::TraceRay* rays,
                      const RayLanes& lanes, Packet& packet) {
    packet.world = rays, packet.lanes = &lanes;
    packet.active = 0xffff;
    const bool is_alone = scene.instance_count == 1;
    const Affine space_from_world = is_alone ? scene.instances[0].object_from_world : Affine{};
    enter_object(lanes, lanes.t_max, space_from_world, is_alone ? 0 : kNoIndex, packet);
    if (is_alone) {
        walk_surface<kQuery>(scene, context, scene.instances[0].surface, packet, 0xffff);
        return ~packet.active & 0xffff;
    }
    const WideBvh& tree = *scene.instance_tree;
    context.counters.upper_nodes += walk_packet(
        tree.nodes, packet, 0xffff,
        [&](uint32_t leaf, LaneMask mask) {
            visit_primitives(tree, leaf, packet, mask, [&](uint32_t instance, LaneMask left) {
                trace_instance<kQuery>(scene, context, instance, packet, left);
            });
        },
        [&](uint32_t child, uint32_t lane) {
            RayState& ray = packet.ray[lane];
            const bool has_hit = trace_scene<kQuery>(scene, context, rays[lane], child, ray);
            packet.t_max[lane] = ray.t_max;
            if (kQuery == Query::closest && has_hit) packet.update_reach();
            if (kQuery == Query::any && has_hit) packet.active &= ~(1u << lane);
        });
    return ~packet.active & 0xffff;
}

} // namespace relief::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
