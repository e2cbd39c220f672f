
#include <array>
#include <span>

#include "cpu/patch_trees/patch_tree.h"

namespace relief::cpu {

namespace {

void store_box(Node16& node, uint32_t child, const Box& box) {
    for (int axis = 0; axis < 3; ++axis) {
        node.bounds[axis][child] = get_component(box.lower, axis);
        node.bounds[3 + axis][child] = get_component(box.upper, axis);
    }
}

} // namespace

void build_tile_directory(const Surface& surface, const PatchLevels& levels, TileDirectory& directory) {
    const DirectoryPlace place = DirectoryPlace::from_number(directory.key.tile);
    const uint32_t bits = DirectoryPlace::shift(levels.patch, place.step);
    const uint32_t cells = (1u << levels.patch) / (DirectoryPlace::side(levels.patch, place.step) << bits);
    std::array<Cells, 16> parts;
    std::array<Box, 16> boxes; // empty beyond the children
    const size_t count = size_t(1) << 2 * bits;
    for (uint32_t number = 0; number < count; ++number) {
        const DirectoryPlace child = place.child(levels.patch, number);
        parts[number] = {child.x * cells, child.y * cells, (child.x + 1) * cells, (child.y + 1) * cells};
    }
    compute_tile_boxes(surface, directory.key.patch, levels, std::span(parts).first(count),
                       std::span(boxes).first(count));
    for (uint32_t number = 0; number < boxes.size(); ++number)
        store_box(directory.node, number, boxes[number]);
}

} // namespace relief::cpu
