#include "lab/vulkan/device_tree.h"

#include <algorithm>
#include <initializer_list>

#include <fmt/format.h>

#include "formulas/tree.h"
#include "relief/error.h"

namespace relief::vulkan {
namespace {

Buffer make_buffer(const Device& device, const char* name, uint64_t bytes, TexelFormat format) {
    return {device, {.name = name, .bytes = bytes, .purpose = Purpose::structures, .format = format}};
}

template <class T> void fill(Buffer& buffer, const std::vector<T>& values) {
    if (!values.empty()) buffer.upload(values);
}

/// What all forms have; `capacity` names the rest.
template <class Tree, class Node>
DeviceTree upload_nodes(const Device& device, TreeForm form, const Tree& tree, const std::vector<Node>& nodes,
                        TreeCapacity capacity) {
    capacity.nodes = nodes.size(), capacity.primitive_ids = tree.primitive_ids.size();
    DeviceTree result = make_device_tree(device, form, capacity);
    result.node_count = uint32_t(nodes.size());
    fill(result.nodes, nodes);
    fill(result.primitive_ids, tree.primitive_ids);
    return result;
}

Buffer make_geometry(const Device& device, const char* name, TexelFormat format,
                     const std::vector<uint32_t>& words) {
    Buffer buffer(device,
                  {.name = name, .bytes = words.size() * 4, .purpose = Purpose::geometry, .format = format});
    fill(buffer, words);
    return buffer;
}

} // namespace

DeviceMesh upload_mesh(const Device& device, std::span<const Vec3f> positions,
                       std::span<const uint32_t> indices) {
    std::vector<uint32_t> vertices, triangles;
    vertices.reserve(4 * positions.size());
    for (const Vec3f& p : positions)
        vertices.insert(vertices.end(), {std::bit_cast<uint32_t>(p.x), std::bit_cast<uint32_t>(p.y),
                                         std::bit_cast<uint32_t>(p.z), 0u});
    triangles.reserve(indices.size() / 3 * 4);
    for (size_t k = 0; k + 2 < indices.size(); k += 3) {
        for (size_t corner = 0; corner < 3; ++corner)
            if (indices[k + corner] >= positions.size())
                throw Error(ErrorKind::bad_input,
                            {fmt::format("vertex {} is out of range, there are {}", indices[k + corner],
                                         positions.size()),
                             fmt::format("mesh, triangle {}", k / 3), "write the indices from 0 on"});
        triangles.insert(triangles.end(), {indices[k], indices[k + 1], indices[k + 2], 0u});
    }
    return {make_geometry(device, "mesh positions", TexelFormat::rgba32_float, vertices),
            make_geometry(device, "mesh triangles", TexelFormat::rgba32_uint, triangles),
            uint32_t(indices.size() / 3)};
}

uint64_t DeviceTree::byte_count() const {
    uint64_t bytes = 0;
    for (const Buffer* buffer : {&nodes, &primitive_ids, &parents, &skips, &blocks, &bricks, &cells})
        bytes += buffer->byte_count();
    return bytes;
}

DeviceTree make_device_tree(const Device& device, TreeForm form, const TreeCapacity& capacity) {
    DeviceTree tree;
    tree.form = form;
    const bool is_kd = form == TreeForm::kd;
    tree.nodes = make_buffer(device, "tree nodes",
                             capacity.nodes * (is_kd ? sizeof(scalar::KdNode) : sizeof(TreeNode)),
                             is_kd ? TexelFormat::rg32_uint : TexelFormat::rgba32_uint);
    tree.primitive_ids = make_buffer(device, "tree ids", capacity.primitive_ids * 4, TexelFormat::r32_uint);
    tree.parents = make_buffer(device, "tree parents", capacity.parents * 4, TexelFormat::r32_uint);
    tree.skips = make_buffer(device, "tree skips", capacity.skips * 4, TexelFormat::r32_uint);
    tree.blocks =
        make_buffer(device, "heap blocks", capacity.blocks * sizeof(scalar::HeapBlock), TexelFormat::none);
    tree.bricks =
        make_buffer(device, "heap bricks", capacity.bricks * sizeof(scalar::HeapBrick), TexelFormat::none);
    tree.cells =
        make_buffer(device, "kd cells", capacity.cells * sizeof(scalar::KdBox), TexelFormat::rgba32_uint);
    return tree;
}

DeviceTree upload_tree(const Device& device, const LinkedBvh& tree) {
    DeviceTree result = upload_nodes(device, TreeForm::linked, tree, tree.nodes,
                                     {.parents = tree.parents.size(), .skips = tree.skips.size()});
    result.depth = tree.depth;
    fill(result.parents, tree.parents);
    fill(result.skips, tree.skips);
    return result;
}

DeviceTree upload_tree(const Device& device, const DenseHeap& tree) {
    DeviceTree result = upload_nodes(device, TreeForm::dense_heap, tree, tree.nodes, {});
    result.depth = std::max(tree.levels - 1, 0);
    return result;
}

DeviceTree upload_tree(const Device& device, const SuccinctHeap& tree) {
    DeviceTree result = upload_nodes(device, TreeForm::succinct_heap, tree, tree.nodes,
                                     {.blocks = tree.blocks.size(), .bricks = tree.bricks.size()});
    result.depth = tree.depth;
    result.heap_form = tree.form;
    fill(result.blocks, tree.blocks);
    fill(result.bricks, tree.bricks);
    return result;
}

DeviceTree upload_tree(const Device& device, const KdTree& tree) {
    DeviceTree result = upload_nodes(device, TreeForm::kd, tree, tree.nodes, {.cells = tree.cells.size()});
    result.depth = tree.depth;
    result.bounds = tree.bounds;
    fill(result.cells, tree.cells);
    return result;
}

bool can_walk(TraversalKind traversal, const DeviceTree& tree) {
    using T = TraversalKind;
    const auto is_one_of = [traversal](std::initializer_list<T> kinds) {
        return std::find(kinds.begin(), kinds.end(), traversal) != kinds.end();
    };
    if (tree.form == TreeForm::linked)
        return is_one_of({T::stack, T::restart_trail, T::parent_link, T::skip_link});
    if (tree.form != TreeForm::kd) return is_one_of({T::trail, T::pair_trail});
    const bool has_cells = tree.node_count == 0 || tree.cells.byte_count() > 0;
    return is_one_of({T::restart, T::push_down}) || (has_cells && traversal == T::backtrack);
}

} // namespace relief::vulkan
