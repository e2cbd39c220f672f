#include "bench/paper2.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "bench/doubtful_hits.h"
#include "bench/machine.h"
#include "bench/paper2_figures.h"
#include "bench/paper2_goals.h"
#include "bench/tree_rays.h"
#include "relief/error.h"

namespace relief::bench {

namespace {

bool is_heap(TreeKind kind) {
    return kind == TreeKind::heap || kind == TreeKind::succinct_lbvh || kind == TreeKind::succinct_sah;
}

Value describe_parts(const std::vector<TreeBuild>& builds, uint32_t triangles) {
    Value parts = Value::list();
    for (size_t part = 0; part < builds.front().parts.size(); ++part) {
        std::vector<double> seconds;
        for (const TreeBuild& build : builds) seconds.push_back(build.parts[part].seconds);
        const TreeBuildPart& first = builds.front().parts[part];
        parts.push_back({{"name", first.name},
                         {"seconds", summarize(seconds)},
                         {"traffic_bytes_a_triangle", double(first.traffic_bytes) / triangles}});
    }
    return parts;
}

Value describe_builds(TreeKind kind, const std::vector<TreeBuild>& builds, uint32_t triangles) {
    std::vector<double> seconds, shares;
    for (const TreeBuild& build : builds)
        seconds.push_back(build.seconds), shares.push_back(build.bound_share);
    const TreeBuild& last = builds.back();
    const Value summary = summarize(seconds);
    Value entry = {{"tree", tree_name(kind)},
                   {"built_on", last.is_on_device ? "device" : "host"},
                   {"seconds", summary},
                   {"triangles_per_s", triangles / summary["median"].get<double>()},
                   {"bytes", last.bytes},
                   {"bytes_a_triangle", double(last.bytes) / triangles},
                   {"link_bytes", last.link_bytes},
                   {"slots", last.slots},
                   {"used_slots", last.used},
                   {"used_share", double(last.used) / double(last.slots)},
                   {"entries_a_triangle", double(last.entries) / triangles},
                   {"depth", last.depth}};
    if (!last.is_on_device) return entry;
    entry["parts"] = describe_parts(builds, triangles);
    entry["share_of_bandwidth_bound"] = summarize(shares);
    return entry;
}

/// Start node of rays in a tree.
enum class Start { root, last_hit };

/// All measurements of one mesh.
class MeshMeasure {
  public:
    MeshMeasure(const Paper2Options& options, const Scene& scene, Report report)
        : options_(options),
          mesh_(scene.meshes.at(0)),
          report_(std::move(report)),
          trees_(mesh_, options.settings),
          doubts_(mesh_) {
        // Reference hits, from the first tree: all others must agree.
        trees_.build(TreeKind::sah);
        sets_.push_back(
            make_primary_rays(scene.camera, options.settings.image.width, options.settings.image.height));
        expected_.push_back(find_hits({TraversalKind::stack}, sets_[0], {}));
        Vec3f to_light{0.5f, 0.8f, 0.35f};
        if (!scene.lights.empty() && scene.lights[0].type == LightType::sun) {
            const Vec3f& d = scene.lights[0].direction;
            to_light = {-d.x, -d.y, -d.z};
        }
        for (RaySet& set : make_secondary_rays(mesh_, sets_[0], expected_[0], to_light)) {
            expected_.push_back(find_hits({TraversalKind::stack, set.kind}, set, {}));
            sets_.push_back(std::move(set));
        }
    }

    Value run(const std::string& name) {
        for (const Paper2Model& model : kPaper2Models)
            if (model.stands_for == name && options_.detail == MeshDetail::full)
                heap_levels_ = int(model.levels);
        Value builds = Value::list();
        for (const TreeKind kind : tree_kinds()) builds.push_back(measure_tree(kind));
        Value rays;
        for (const RaySet& set : sets_) rays[set.name] = set.rays.size();
        return {{"mesh", name},
                {"triangles", trees_.triangle_count()},
                {"rays", rays},
                {"device", trees_.device_name()},
                {"copy_bytes_per_s", trees_.copy_bandwidth()},
                {"builds", std::move(builds)},
                {"combinations_that_agree", combinations_},
                {"doubtful_hits", doubtful_hits_},
                {"casts", std::move(casts_)}};
    }

  private:
    Value measure_tree(TreeKind kind) {
        report_(fmt::format("build {}", tree_name(kind)));
        trees_.build(kind, heap_levels_); // warm-up
        std::vector<TreeBuild> builds;
        for (int run = 0; run < options_.runs; ++run) builds.push_back(trees_.build(kind, heap_levels_));
        for (const TraversalKind traversal : tree_traversals(kind)) {
            report_(fmt::format("cast {}, {}", tree_name(kind), traversal_name(traversal)));
            std::vector<uint64_t> leaves;
            for (size_t s = 0; s < sets_.size(); ++s) {
                measure_cast(kind, traversal, s, Start::root, {});
                if (!is_heap(kind)) continue;
                if (s == 0)
                    leaves = find_leaves(traversal);
                else
                    measure_cast(kind, traversal, s, Start::last_hit, leaves);
            }
        }
        return describe_builds(kind, builds, trees_.triangle_count());
    }

    std::vector<TreeHit> find_hits(const TreeQuery& query, const RaySet& set, std::span<uint64_t> keys) {
        std::vector<TreeHit> hits(set.rays.size());
        counts_ = trees_.cast(query, {set.rays, hits, keys});
        return hits;
    }

    /// Leaf of the hit of each primary ray; the root for misses.
    std::vector<uint64_t> find_leaves(TraversalKind traversal) {
        std::vector<uint64_t> keys(sets_[0].rays.size(), kRootKey);
        find_hits({traversal}, sets_[0], keys);
        return keys;
    }

    void measure_cast(TreeKind kind, TraversalKind traversal, size_t s, Start start,
                      const std::vector<uint64_t>& leaves) {
        const RaySet& set = sets_[s];
        if (set.rays.empty()) return;
        std::vector<uint64_t> starts, keys;
        if (start == Start::last_hit)
            for (const uint32_t parent : set.parents) starts.push_back(leaves[parent]);
        TreeQuery query{traversal, set.kind, Counting::on};
        keys = starts;
        const std::vector<TreeHit> hits = find_hits(query, set, keys);
        require_equal(hits, s, fmt::format("{}, {}", tree_name(kind), traversal_name(traversal)));
        const double count = double(set.rays.size());
        Value entry = {{"tree", tree_name(kind)},
                       {"traversal", traversal_name(traversal)},
                       {"rays", set.name},
                       {"start", start == Start::root ? "root" : "last hit"},
                       {"boxes_a_ray", double(counts_.box_tests) / count},
                       {"triangles_a_ray", double(counts_.triangle_tests) / count},
                       {"bytes_a_ray", double(counts_.bytes) / count},
                       {"restarts_a_ray", double(counts_.restarts) / count}};
        query.counting = Counting::off;
        std::vector<double> seconds;
        for (int run = 0; run <= options_.runs; ++run) {
            keys = starts;
            find_hits(query, set, keys);
            if (run > 0) seconds.push_back(counts_.seconds);
        }
        entry["seconds"] = summarize(seconds);
        entry["rays_per_s"] = count / entry["seconds"]["median"].get<double>();
        casts_.push_back(std::move(entry));
    }

    /// Compares closest hits bitwise, any hits by occlusion. Doubtful hits may differ and are counted.
    void require_equal(const std::vector<TreeHit>& hits, size_t s, const std::string& name) {
        size_t different = 0;
        for (size_t k = 0; k < hits.size(); ++k) {
            const TreeHit &a = hits[k], &b = expected_[s][k];
            const bool is_same = sets_[s].kind == HitKind::any
                                     ? (a.primitive == kNoIndex) == (b.primitive == kNoIndex)
                                     : a.primitive == b.primitive && a.t == b.t;
            if (is_same) continue;
            const Ray& ray = sets_[s].rays[k];
            if (doubts_.is_doubtful(ray, a) || doubts_.is_doubtful(ray, b))
                ++doubtful_hits_;
            else
                ++different;
        }
        if (different > 0)
            throw Error(ErrorKind::failed, {fmt::format("{} of {} {} rays hit otherwise than by sah, stack",
                                                        different, hits.size(), sets_[s].name),
                                            name, "no figures are reported for walks that do not agree"});
        ++combinations_;
    }

    const Paper2Options& options_;
    const Mesh& mesh_;
    const Report report_;
    MeshTrees trees_;
    const DoubtfulHits doubts_;
    std::vector<RaySet> sets_;
    std::vector<std::vector<TreeHit>> expected_;
    TreeCast counts_; ///< of the last cast
    int combinations_ = 0;
    uint64_t doubtful_hits_ = 0; ///< differing ones, over all casts
    int heap_levels_ = 0;        ///< as in the paper if it has this mesh
    Value casts_ = Value::list();
};

Value make_head(const Paper2Options& options) {
    const RenderSettings& s = options.settings;
    Value head = {{"suite", "paper2"}, {"build", describe_build()}, {"machine", describe_machine()}};
    head["settings"] = {{"engine", s.device.engine == EngineKind::cpu ? "cpu" : "vulkan"},
                        {"device", s.device.index},
                        {"threads", s.device.threads},
                        {"width", s.image.width},
                        {"height", s.image.height},
                        {"runs", options.runs},
                        {"warm_up_runs", 1},
                        {"meshes", options.detail == MeshDetail::full ? "full" : "reduced"}};
    head["comparable"] = kPaper2Comparable;
    for (const PaperStatement& statement : kPaper2Statements)
        head["paper_says"].push_back({{"about", statement.about}, {"text", statement.text}});
    for (const Paper2Model& m : kPaper2Models)
        head["paper_models"].push_back({{"stands_for", m.stands_for},
                                        {"model", m.model},
                                        {"triangles", m.triangles},
                                        {"heap_levels", m.levels},
                                        {"frames_per_s", m.frames_per_second},
                                        {"triangles_a_leaf", m.triangles_a_leaf},
                                        {"used_share", m.used_share},
                                        {"heap_bytes", m.heap_bytes},
                                        {"bytes_a_triangle", m.heap_bytes / m.triangles}});
    return head;
}

} // namespace

Paper2Options make_quick_options(Paper2Options options) {
    options.settings.image.width = 32, options.settings.image.height = 18;
    options.runs = 1;
    options.detail = MeshDetail::reduced;
    return options;
}

Value run_paper2(const Paper2Options& options, const Report& report) {
    Value result = make_head(options);
    result["meshes"] = Value::list();
    const auto measure = [&](const std::string& name, const Scene& scene) {
        const Report tell = [&](const std::string& line) { report(name + ": " + line); };
        result["meshes"].push_back(MeshMeasure(options, scene, tell).run(name));
    };
    for (const std::string& name : options.scenes) {
        report("making the mesh " + name);
        measure(name, make_structure_scene(name, options.detail));
    }
    for (const Scene& scene : options.meshes) measure(scene.meshes.at(0).name, scene);
    result["goals"] = make_paper2_goals(result);
    return result;
}

} // namespace relief::bench
