#include "lab/trees.h"

#include <algorithm>
#include <atomic>
#include <utility>

#include <fmt/format.h>

#include "base/parallel.h"
#include "lab/tree_workshop.h"
#include "relief/error.h"

namespace relief {

namespace {

std::unique_ptr<TreeWorkshop> make_workshop(TriangleSoup soup, const RenderSettings& settings) {
    if (settings.device.engine == EngineKind::cpu) return make_cpu_tree_workshop(std::move(soup));
#ifdef RELIEF_VULKAN
    return make_vulkan_tree_workshop(std::move(soup), settings);
#else
    throw Error(ErrorKind::device_missing, {"this build has no Vulkan", "trees over a mesh",
                                            "device.engine = cpu, or configure it with -DRELIEF_VULKAN=ON"});
#endif
}

void refuse(std::string message, const char* hint) {
    throw Error(ErrorKind::usage, {std::move(message), "trees over a mesh", hint});
}

void check_cast(std::optional<TreeKind> kind, const TreeQuery& query, const TreeCastData& data) {
    if (!kind) refuse("there is no tree yet", "build one first");
    const std::vector<TraversalKind> valid = tree_traversals(*kind);
    if (std::find(valid.begin(), valid.end(), query.traversal) == valid.end())
        refuse(fmt::format("{} does not walk the tree {}", traversal_name(query.traversal), tree_name(*kind)),
               "choose one of tree_traversals()");
    if (data.hits.size() != data.rays.size() || (!data.keys.empty() && data.keys.size() != data.rays.size()))
        refuse(fmt::format("{} rays but room for {} hits and {} keys", data.rays.size(), data.hits.size(),
                           data.keys.size()),
               "give spans of equal length");
    const bool is_trail =
        query.traversal == TraversalKind::trail || query.traversal == TraversalKind::pair_trail;
    if (!data.keys.empty() && !is_trail) refuse("only trails start at a key", "leave the keys out");
}

/// A walk from a key that is not in its tree would read anything.
void check_keys(const TreeWorkshop& workshop, std::span<const uint64_t> keys) {
    std::atomic<size_t> first_foreign{keys.size()};
    parallel_for("check_keys", keys.size(), 4096, [&](size_t begin, size_t end) {
        for (size_t k = begin; k < end; ++k) {
            if (workshop.contains_key(keys[k])) continue;
            size_t first = first_foreign;
            while (k < first && !first_foreign.compare_exchange_weak(first, k)) {
            }
            return;
        }
    });
    if (first_foreign < keys.size())
        refuse(fmt::format("key {} of ray {} names no node of the tree built last", keys[first_foreign],
                           first_foreign.load()),
               "start with kRootKey after every build");
}

} // namespace

std::vector<TreeKind> tree_kinds() {
    return {TreeKind::sah,  TreeKind::sah_wide,      TreeKind::lbvh30,       TreeKind::lbvh63,
            TreeKind::heap, TreeKind::succinct_lbvh, TreeKind::succinct_sah, TreeKind::kdtree};
}

const char* tree_name(TreeKind kind) {
    constexpr const char* kNames[] = {"sah",  "sah 3.0/1.5",   "lbvh 30",      "lbvh 63",
                                      "heap", "succinct lbvh", "succinct sah", "kdtree"};
    return kNames[size_t(kind)];
}

std::vector<TraversalKind> tree_traversals(TreeKind kind) {
    using T = TraversalKind;
    switch (kind) {
    case TreeKind::heap:
    case TreeKind::succinct_lbvh:
    case TreeKind::succinct_sah:
        return {T::trail, T::pair_trail};
    case TreeKind::kdtree:
        return {T::restart, T::push_down, T::backtrack};
    default:
        return {T::stack, T::restart_trail, T::parent_link, T::skip_link};
    }
}

MeshTrees::MeshTrees(const Mesh& mesh, const RenderSettings& settings) : threads_(settings.device.threads) {
    validate_mesh(mesh);
    workshop_ = make_workshop(make_soup(mesh), settings);
}

MeshTrees::~MeshTrees() = default;

uint32_t MeshTrees::triangle_count() const { return workshop_->soup().triangle_count(); }
const std::string& MeshTrees::device_name() const { return workshop_->device_name(); }
double MeshTrees::copy_bandwidth() const { return workshop_->copy_bandwidth(); }

TreeBuild MeshTrees::build(TreeKind kind, int heap_levels) {
    if (heap_levels < 0 || heap_levels > DenseHeap::kMaxLevels)
        refuse(fmt::format("a heap of {} levels", heap_levels), "0 to 26");
    TreeBuild report;
    kind_.reset();
    with_threads(threads_, [&] { report = workshop_->build(kind, heap_levels); });
    kind_ = kind;
    return report;
}

TreeCast MeshTrees::cast(const TreeQuery& query, const TreeCastData& data) {
    check_cast(kind_, query, data);
    TreeCast result;
    with_threads(threads_, [&] {
        check_keys(*workshop_, data.keys);
        result = workshop_->cast(query, data);
    });
    return result;
}

} // namespace relief
