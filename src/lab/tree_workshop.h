// What both engines offer behind lab/trees.h, and the trees that the host builds for either.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "bvh/tree_links.h"
#include "lab/trees.h"
#include "lab/trees/heap_tree.h"
#include "lab/trees/sah_kdtree.h"

namespace relief {

/// Three indices a triangle.
struct TriangleSoup {
    std::vector<Vec3f> positions;
    std::vector<uint32_t> indices;

    uint32_t triangle_count() const { return uint32_t(indices.size() / 3); }
};

class TreeWorkshop {
  public:
    explicit TreeWorkshop(TriangleSoup soup) : soup_(std::move(soup)) {}
    virtual ~TreeWorkshop() = default;

    const TriangleSoup& soup() const { return soup_; }
    const std::string& device_name() const { return device_name_; }
    double copy_bandwidth() const { return copy_bandwidth_; }

    virtual TreeBuild build(TreeKind kind, int heap_levels) = 0;
    /// The traversal is one of tree_traversals. Throws Error{usage} for one that is none of them.
    virtual TreeCast cast(const TreeQuery& query, const TreeCastData& data) = 0;
    /// Whether the tree, a heap, has a node of that key. Several threads may ask at once.
    virtual bool contains_key(uint64_t key) const = 0;

  protected:
    TriangleSoup soup_;
    std::string device_name_;
    double copy_bandwidth_ = 0;
};

using HostTree = std::variant<LinkedBvh, DenseHeap, SuccinctHeap, KdTree>;

/// Faces cut into fans.
TriangleSoup make_soup(const Mesh& mesh);
std::vector<Box> compute_triangle_boxes(const TriangleSoup& soup);

struct BuiltTree {
    HostTree tree;
    TreeBuild report;
};
BuiltTree build_host_tree(std::span<const Box> boxes, TreeKind kind, int heap_levels);

std::unique_ptr<TreeWorkshop> make_cpu_tree_workshop(TriangleSoup soup);
std::unique_ptr<TreeWorkshop> make_vulkan_tree_workshop(TriangleSoup soup, const RenderSettings& settings);

} // namespace relief
