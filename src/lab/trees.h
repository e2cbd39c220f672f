// Trees over one triangle mesh, built and walked for themselves, to compare structures and traversals.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "relief/intersect.h"
#include "relief/render.h"
#include "relief/scene.h"

namespace relief {

/// docs/structures.md has a page for each.
enum class TreeKind {
    sah,           ///< binned surface-area heuristic, costs 1 and 1
    sah_wide,      ///< sweep with the costs of GRAPP 2019: 3.0 and 1.5
    lbvh30,        ///< linear, codes of 30 bits
    lbvh63,        ///< linear, codes of 63 bits
    heap,          ///< linear, 30 bits, in the heap of Murguia et al. 2013
    succinct_lbvh, ///< lbvh30 as a heap without empty slots
    succinct_sah,  ///< sah as a heap without empty slots
    kdtree         ///< sweep with the costs of GRAPP 2019: 3.0 and 1.5
};

/// All, in that order.
std::vector<TreeKind> tree_kinds();

/// As results spell it: "sah 3.0/1.5".
const char* tree_name(TreeKind kind);

/// What walks such a tree, in both engines.
std::vector<TraversalKind> tree_traversals(TreeKind kind);

struct TreeBuildPart {
    std::string name;
    double seconds = 0;
    uint64_t traffic_bytes = 0; ///< that the kernels read and write
};

struct TreeBuild {
    double seconds = 0;           ///< from boxes to a tree that can be walked; on a device from triangles
    uint64_t bytes = 0;           ///< held for nodes, directories, ids; links not included
    uint64_t link_bytes = 0;      ///< what parent links, skip links or backtrack have besides, one of them
    uint64_t slots = 0, used = 0; ///< nodes that there is room for, and those that are there
    uint64_t entries = 0;         ///< ids in leaves: more than triangles in kd-trees
    int depth = 0;                ///< edges on the longest way down
    bool is_on_device = false;    ///< else the host built it
    std::vector<TreeBuildPart> parts; ///< of a build on a device
    /// Of the rate that memory traffic alone allows (docs/structures/lbvh.md); 0: not built on a device.
    double bound_share = 0;
};

enum class HitKind { closest, any };
enum class Counting { off, on };

struct TreeQuery {
    TraversalKind traversal = TraversalKind::stack;
    HitKind kind = HitKind::closest;
    Counting counting = Counting::off;
};

/// Of hits at one distance the lowest primitive; of any hits whichever came first.
struct TreeHit {
    float t = std::numeric_limits<float>::infinity(); ///< infinity: nothing
    uint32_t primitive = kNoIndex;                    ///< triangle, faces cut into fans in their order
};

/// Spans of equal length. `keys`, for trails over heaps: where each ray starts (kRootKey or a key of an
/// earlier cast); becomes the leaf of its hit, if there is one. May be empty: all start at the root.
struct TreeCastData {
    std::span<const Ray> rays;
    std::span<TreeHit> hits;
    std::span<uint64_t> keys;
};

inline constexpr uint64_t kRootKey = 1;

/// Sums over rays; zeros where counting is off.
struct TreeCast {
    double seconds = 0; ///< of the walk alone; on a device without transfers
    uint64_t box_tests = 0, triangle_tests = 0, restarts = 0;
    uint64_t bytes = 0; ///< of nodes, links and directories; not of triangles
};

class TreeWorkshop;

/// One tree at a time over one mesh. One thread at a time; all of `settings.device.threads` work.
class MeshTrees {
  public:
    /// Of `settings` engine, device, pipeline_cache and threads. Throws Error: device_missing, out_of_memory,
    /// bad_input for what validate_mesh refuses.
    MeshTrees(const Mesh& mesh, const RenderSettings& settings);
    ~MeshTrees();

    uint32_t triangle_count() const;
    const std::string& device_name() const;

    /// Takes the place of the tree before. Trees deeper than 62 levels are cut off there. `heap_levels`, of
    /// TreeKind::heap alone: 2^heap_levels slots, [1, 26]; 0: about four slots a triangle.
    TreeBuild build(TreeKind kind, int heap_levels = 0);

    /// Throws Error{usage} where nothing is built, for a traversal that is not among tree_traversals of the
    /// tree, for spans of other lengths, and for a key that names no node of the tree.
    TreeCast cast(const TreeQuery& query, const TreeCastData& data);

    /// Bytes a second that copies read and write in the device's memory; 0 for the CPU engine.
    double copy_bandwidth() const;

  private:
    std::unique_ptr<TreeWorkshop> workshop_;
    std::optional<TreeKind> kind_; ///< of the tree built last
    int threads_ = 0;
};

} // namespace relief
