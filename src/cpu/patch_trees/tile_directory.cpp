
#include "cpu/patch_trees/patch_tree.h"

namespace relief::cpu {

namespace {

void store_box(Node16& node, uint32_t child, const Box& box) {
    for (int axis = 0; axis < 3; ++axis) {
        node.bounds[axis][child] = get_component(box.lower, axis);
        node.bounds[3 + axis][child] = get_component(box.upper, axis);
    }
}

Box compute_union(const Node16& node) {
    Box box;
    for (int child = 0; child < 16; ++child) {
        box.lower = min(box.lower, {node.bounds[0][child], node.bounds[1][child], node.bounds[2][child]});
        box.upper = max(box.upper, {node.bounds[3][child], node.bounds[4][child], node.bounds[5][child]});
    }
    return box;
}

} // namespace

void build_tile_directory(const Surface& surface, const PatchLevels& levels, TileDirectory& directory) {
    const uint32_t depth = directory.depth, steps = TileDirectory::step_count(depth);
    Node16* nodes = directory.nodes();
    for (uint32_t step = steps; step-- > 0;) {
        const uint32_t side = TileDirectory::step_side(depth, step),
                       fanout = TileDirectory::fanout(depth, step);
        const uint32_t begin = TileDirectory::step_begin(depth, step);
        const uint32_t next_begin = TileDirectory::step_begin(depth, step + 1), next_side = side * fanout;
        for (uint32_t index = 0; index < side * side; ++index) {
            const uint32_t x = index % side, y = index / side;
            for (uint32_t child = 0; child < 16; ++child) {
                Box box;
                if (child < fanout * fanout) {
                    const uint32_t cx = x * fanout + child % fanout, cy = y * fanout + child / fanout;
                    constexpr uint32_t kSide = 1u << kQuarterLevel;
                    box = step + 1 == steps
                              ? compute_tile_box(surface, directory.key.patch, levels,
                                                 {cx * kSide, cy * kSide, (cx + 1) * kSide, (cy + 1) * kSide})
                              : compute_union(nodes[next_begin + cy * next_side + cx]);
                }
                store_box(nodes[begin + index], child, box);
            }
        }
    }
}

} // namespace relief::cpu
