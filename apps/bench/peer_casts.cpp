#include "bench/peer_casts.h"

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "bench/embree_scene.h"
#include "bench/peer_agreement.h"
#include "bench/peers.h"

namespace relief::bench {

namespace {

constexpr std::array<int, 3> kWidths = {1, 8, 16};

/// One method to trace a set of rays, and its name in the results.
struct CastWay {
    Value labels;
    Measure measure;
};

struct BuiltWay {
    EmbreeWay way;
    std::unique_ptr<EmbreeScene> scene;
};

class CastMeasure {
  public:
    CastMeasure(const PeerScene& scene, const TracerProbe& probe, const std::vector<PeerRays>& sets)
        : scene_(scene), probe_(probe), sets_(sets) {
        for (const EmbreeWay way : kEmbreeWays)
            if (way != EmbreeWay::triangles || scene.has_triangles)
                built_.push_back(
                    {way, std::make_unique<EmbreeScene>(probe, way, scene.settings.device.threads)});
        if (probe.isa() == "avx512") add_variant("avx2", Isa::avx2, scene.settings.device.threads);
        if (scene.settings.device.threads > 1) add_variant(probe.isa(), scene.settings.device.isa, 1);
    }

    PeerCasts run() {
        PeerCasts result;
        scene_.report(scene_.name + ": comparing hits");
        compare(result.agreements);
        result.memory = describe_memory();
        result.casts = Value::list();
        for (const PeerRays& set : sets_) {
            scene_.report(fmt::format("{}: {} rays", scene_.name, set.name));
            result.casts.push_back(measure(set));
        }
        return result;
    }

  private:
    /// Relief with other settings.
    struct Variant {
        RenderSettings settings;
        std::string isa;
        std::unique_ptr<TracerProbe> probe;
    };

    void add_variant(const std::string& isa, Isa kind, int threads) {
        RenderSettings settings = scene_.settings;
        settings.device.isa = kind, settings.device.threads = threads;
        variants_.push_back({settings, isa, std::make_unique<TracerProbe>(scene_.scene, settings)});
    }

    void compare(Value& agreements) {
        agreements = Value::list();
        const auto add = [&](const Agreement& agreement) {
            agreements.push_back(describe_agreement(agreement));
            require_agreement(scene_.name, agreement);
        };
        for (const PeerRays& set : sets_)
            for (const BuiltWay& built : built_)
                add(compare_with_embree(probe_, *built.scene, built.way, set));
        if (!scene_.has_triangles) return;
        RenderSettings settings = scene_.settings;
        settings.surface.mode = SurfaceMode::tessellated;
        const TracerProbe tessellated(scene_.scene, settings);
        for (const char* name : {"primary", "diffuse_1"})
            add(compare_with_tessellated(probe_, tessellated, find_rays(sets_, name)));
    }

    /// After all kinds of rays have been traced, so that all patch trees are built.
    Value describe_memory() const {
        const ProbeCounts counts = probe_.count();
        Value memory = {{"patches", counts.patches},
                        {"micro_quads", counts.micro_quads},
                        {"triangles", counts.triangles},
                        {"geometry_bytes", counts.geometry_bytes},
                        {"structures_bytes", counts.structures_bytes},
                        {"plain_bytes", counts.plain_bytes},
                        {"cache_bytes", counts.cache_bytes},
                        {"bottom_trees_built", counts.trees_built}};
        if (counts.patches > 0)
            memory["bytes_a_patch"] =
                double(counts.geometry_bytes + counts.structures_bytes - counts.plain_bytes) /
                double(counts.patches);
        if (counts.built_quads > 0)
            memory["bytes_a_micro_quad"] = double(counts.built_bytes) / double(counts.built_quads);
        for (const BuiltWay& built : built_) {
            memory["embree"][way_name(built.way)] = {{"bytes", built.scene->byte_count()}};
            if (counts.micro_quads > 0)
                memory["embree"][way_name(built.way)]["bytes_a_micro_quad"] =
                    double(built.scene->byte_count()) / double(counts.micro_quads);
        }
        return memory;
    }

    CastWay make_relief(const TracerProbe& probe, const std::string& isa, int threads,
                        const PeerRays& set) const {
        return {{{"program", "relief"}, {"way", "rays"}, {"threads", threads}, {"isa", isa}},
                [&probe, &set] { return probe.trace(set.rays, set.kind, RayGrouping::packets).seconds; }};
    }

    /// Frames by the engine's own camera path, with a full cache, or an empty one at the start of each frame.
    void add_frames(const RenderSettings& settings, const std::string& isa, std::vector<CastWay>& ways) {
        frame_probes_.push_back(std::make_unique<TracerProbe>(scene_.scene, settings));
        TracerProbe& probe = *frame_probes_.back();
        const auto label = [&](const char* way) {
            return Value{
                {"program", "relief"}, {"way", way}, {"threads", settings.device.threads}, {"isa", isa}};
        };
        ways.push_back({label("frame"), [&probe] { return probe.trace_camera().seconds; }});
        ways.push_back({label("frame_from_empty_cache"), [&probe] {
                            probe.empty_cache();
                            return probe.trace_camera().seconds;
                        }});
    }

    CastWay make_embree(const BuiltWay& built, int width, int threads, const PeerRays& set) const {
        const bool is_any = set.kind == HitKind::any;
        return {
            {{"program", "embree"},
             {"way", way_name(built.way)},
             {"call", fmt::format("{}{}", is_any ? "rtcOccluded" : "rtcIntersect", width)},
             {"threads", threads}},
            [&scene = *built.scene, &set, query = EmbreeQuery{set.kind, width, set.is_coherent, threads}] {
                return scene.trace(set.rays, query).seconds;
            }};
    }

    std::vector<CastWay> list_ways(const PeerRays& set) {
        const int threads = scene_.settings.device.threads;
        std::vector<CastWay> ways = {make_relief(probe_, probe_.isa(), threads, set)};
        for (const Variant& variant : variants_)
            ways.push_back(make_relief(*variant.probe, variant.isa, variant.settings.device.threads, set));
        for (const BuiltWay& built : built_)
            for (const int width : kWidths) {
                ways.push_back(make_embree(built, width, threads, set));
                if (threads > 1 && width != 8) ways.push_back(make_embree(built, width, 1, set));
            }
        if (set.name != "primary") return ways;
        add_frames(scene_.settings, probe_.isa(), ways);
        for (const Variant& variant : variants_) add_frames(variant.settings, variant.isa, ways);
        return ways;
    }

    Value measure(const PeerRays& set) {
        const std::vector<CastWay> ways = list_ways(set);
        std::vector<Measure> measures;
        for (const CastWay& way : ways) measures.push_back(way.measure);
        const std::vector<std::vector<double>> seconds = time_in_turn(measures, scene_.runs);
        Value cast = {{"rays", set.name},
                      {"kind", set.kind == HitKind::any ? "any" : "closest"},
                      {"coherent", set.is_coherent},
                      {"count", set.rays.size()},
                      {"hits", probe_.trace(set.rays, set.kind, RayGrouping::packets).hit_count},
                      {"ways", Value::list()}};
        for (size_t k = 0; k < ways.size(); ++k) {
            Value entry = ways[k].labels;
            entry["seconds"] = summarize(seconds[k]);
            entry["rays_per_s"] = double(set.rays.size()) / entry["seconds"]["median"].get<double>();
            cast["ways"].push_back(std::move(entry));
        }
        frame_probes_.clear();
        return cast;
    }

    const PeerScene& scene_;
    const TracerProbe& probe_;
    const std::vector<PeerRays>& sets_;
    std::vector<BuiltWay> built_;
    std::vector<Variant> variants_;
    std::vector<std::unique_ptr<TracerProbe>> frame_probes_; ///< with caches that may be cleared
};

} // namespace

PeerCasts measure_casts(const PeerScene& scene, const TracerProbe& probe, const std::vector<PeerRays>& sets) {
    return CastMeasure(scene, probe, sets).run();
}

} // namespace relief::bench
