// Trees and triangle meshes in device memory, as tree_walk.comp reads them.
#pragma once

#include <cstdint>
#include <span>

#include "formulas/tree.h"
#include "lab/walks/walks.h"
#include "vulkan/device/buffer.h"

namespace relief::vulkan {

struct DeviceMesh {
    Buffer positions; ///< four floats a vertex
    Buffer triangles; ///< four words a triangle: three vertices and 0
    uint32_t triangle_count = 0;
};

/// Three indices a triangle. Throws Error{bad_input} for a vertex that is not there, Error{out_of_memory}.
DeviceMesh upload_mesh(const Device& device, std::span<const Vec3f> positions,
                       std::span<const uint32_t> indices);

enum class TreeForm { linked, dense_heap, succinct_heap, kd };

/// Any tree of src/lab/trees. All buffers are there, though some hold nothing.
struct DeviceTree {
    TreeForm form = TreeForm::linked;
    uint32_t node_count = 0; ///< of heaps: slots; 0: no primitives
    int depth = 0;           ///< edges on the longest way down
    scalar::HeapForm heap_form{};
    Box bounds; ///< of kd-trees: the root's cell
    Buffer nodes, primitive_ids;
    Buffer parents, skips; ///< of linked trees
    Buffer blocks, bricks; ///< of succinct heaps
    Buffer cells;          ///< of kd-trees, as built

    uint64_t byte_count() const;
};

/// Throw Error{out_of_memory} for what does not fit.
DeviceTree upload_tree(const Device& device, const LinkedBvh& tree);
DeviceTree upload_tree(const Device& device, const DenseHeap& tree);
DeviceTree upload_tree(const Device& device, const SuccinctHeap& tree);
DeviceTree upload_tree(const Device& device, const KdTree& tree);

/// Numbers of items that a tree's buffers have room for.
struct TreeCapacity {
    uint64_t nodes = 0, primitive_ids = 0, parents = 0, skips = 0, blocks = 0, bricks = 0, cells = 0;
};

/// Its buffers are made and hold nothing yet.
DeviceTree make_device_tree(const Device& device, TreeForm form, const TreeCapacity& capacity);

/// Whether `traversal` walks such trees.
bool can_walk(TraversalKind traversal, const DeviceTree& tree);

} // namespace relief::vulkan
