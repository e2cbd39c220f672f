#include "bench/peer_cold.h"

#include <algorithm>
#include <map>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "bench/embree_scene.h"
#include "bench/peers.h"
#include "bench/resident.h"

namespace relief::bench {

namespace {

/// Values of all runs by name.
using Record = std::map<std::string, std::vector<double>>;

const std::vector<std::string> kParts = {
    "tessellate_s",    "prepare_s",         "build_s",         "primary_s", "occlusion_s",        "diffuse_s",
    "first_primary_s", "first_occlusion_s", "first_diffuse_s", "bytes",     "peak_resident_bytes"};

class ColdMeasure {
  public:
    ColdMeasure(const PeerScene& scene, const std::vector<PeerRays>& sets)
        : scene_(scene),
          primary_(find_rays(sets, "primary")),
          occlusion_(find_rays(sets, "occlusion")),
          diffuse_(find_rays(sets, "diffuse_1")),
          surface_(scene.scene, scene.settings) {}

    Value run() {
        for (int run = 0; run <= scene_.runs; ++run) {
            scene_.report(fmt::format("{}: first images, {}", scene_.name,
                                      run == 0 ? std::string("warm-up") : fmt::format("run {}", run)));
            is_counting_ = run > 0;
            run_relief();
            for (const EmbreeWay way : kEmbreeWays)
                if (way != EmbreeWay::triangles || scene_.has_triangles) run_embree(way);
        }
        Value result;
        for (auto& [way, record] : records_) result[way] = describe(record);
        return result;
    }

  private:
    static Value describe(const Record& record) {
        Value result;
        for (const std::string& part : kParts)
            if (const auto found = record.find(part); found != record.end())
                result[part] = summarize(found->second);
        return result;
    }

    void add(const std::string& way, const char* part, double value) {
        if (is_counting_) records_[way][part].push_back(value);
    }

    void add_peak(const std::string& way, const ResidentMeter& meter) {
        if (const std::optional<uint64_t> growth = meter.growth())
            add(way, "peak_resident_bytes", double(*growth));
    }

    /// Two passes: trees built for occlusion rays must not benefit diffuse rays.
    void run_relief() {
        const std::string way = "relief";
        for (const bool is_occlusion : {true, false}) {
            Scene copy = scene_.scene;
            const ResidentMeter meter;
            const TracerProbe probe(std::move(copy), scene_.settings);
            const double prepare = probe.preparation().surfaces_s, build = probe.preparation().trees_s;
            const PeerRays& set = is_occlusion ? occlusion_ : diffuse_;
            camera_room_ = probe.trace_camera(std::move(camera_room_));
            second_room_ = probe.trace(set.rays, set.kind, RayGrouping::packets, std::move(second_room_));
            const double primary = camera_room_.seconds, second = second_room_.seconds;
            add(way, is_occlusion ? "occlusion_s" : "diffuse_s", second);
            add(way, is_occlusion ? "first_occlusion_s" : "first_diffuse_s",
                prepare + build + primary + second);
            if (!is_occlusion) continue;
            add_peak(way, meter);
            add(way, "prepare_s", prepare);
            add(way, "build_s", build);
            add(way, "primary_s", primary);
            add(way, "first_primary_s", prepare + build + primary);
            const ProbeCounts counts = probe.count();
            add(way, "bytes", double(counts.geometry_bytes + counts.structures_bytes + counts.cache_bytes));
        }
    }

    double trace(const EmbreeScene& embree, const PeerRays& set, const EmbreeQuery& query) {
        embree_room_ = embree.trace(set.rays, query, std::move(embree_room_));
        return embree_room_.seconds;
    }

    void run_embree(EmbreeWay kind) {
        const std::string way = way_name(kind);
        const ResidentMeter meter;
        const EmbreeScene embree(surface_, kind, scene_.settings.device.threads);
        const double ready = embree.tessellate_s() + embree.build_s();
        const double primary = trace(embree, primary_, {HitKind::closest, 16, true});
        const double occlusion = trace(embree, occlusion_, {HitKind::any, 1, false});
        const double diffuse = trace(embree, diffuse_, {HitKind::closest, 1, false});
        add_peak(way, meter);
        add(way, "tessellate_s", embree.tessellate_s());
        add(way, "build_s", embree.build_s());
        add(way, "primary_s", primary);
        add(way, "occlusion_s", occlusion);
        add(way, "diffuse_s", diffuse);
        add(way, "first_primary_s", ready + primary);
        add(way, "first_occlusion_s", ready + primary + occlusion);
        add(way, "first_diffuse_s", ready + primary + diffuse);
        add(way, "bytes", double(embree.byte_count()));
    }

    const PeerScene& scene_;
    const PeerRays &primary_, &occlusion_, &diffuse_;
    TracerProbe surface_; ///< input of Embree, prepared before its timer starts
    std::map<std::string, Record> records_;
    bool is_counting_ = false;
    /// Hits go to the same memory in every run, so it does not count for any program.
    ProbeRun camera_room_, second_room_;
    EmbreeRun embree_room_;
};

} // namespace

Value measure_cold(const PeerScene& scene, const std::vector<PeerRays>& sets) {
    return ColdMeasure(scene, sets).run();
}

} // namespace relief::bench
