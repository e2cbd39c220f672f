#include "bench/peers.h"

#include <algorithm>
#include <functional>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "bench/machine.h"
#include "bench/peer_casts.h"
#include "bench/peer_cold.h"
#include "bench/peers_goals.h"
#include "lab/scenes/peer_scenes.h"
#include "relief/error.h"
#include "relief/inspect.h"
#include "relief/samples.h"

namespace relief::bench {

namespace {

constexpr float kRough = 1, kMild = 0.3f;
constexpr const char* kParty = "party";

/// Bytes of Embree's triangles with their buffers, measured; Relief's tessellated surface needs less.
constexpr uint64_t kTessellatedBytesPerQuad = 200;

struct NamedScene {
    std::string name;
    std::function<Scene()> make;
};

std::vector<NamedScene> list_scenes() {
    std::vector<NamedScene> scenes;
    for (const std::string& name : peer_scene_names())
        for (const auto& [suffix, roughness] : {std::pair("", kRough), {"_mild", kMild}})
            scenes.push_back({name + suffix, [name, r = roughness] {
                                  return make_peer_scene(name, r, PeerWorld::constant);
                              }});
    for (const char* name : {"pumpkin", "bark"})
        scenes.push_back({name, [name] { return make_sample_scene(name, Instancing::none); }});
    return scenes;
}

/// State of a running suite.
class Peers {
  public:
    Peers(const PeersOptions& options, const Report& report) : options_(options), report_(report) {
        settings_.image.width = options.width, settings_.image.height = options.height;
        settings_.device.isa = options.isa;
        settings_.device.threads =
            options.threads > 0 ? options.threads : int(std::max(1u, std::thread::hardware_concurrency()));
        settings_.image.spp = 1;
        settings_.surface.cache_bytes = kDefaultCacheBytes; // memory is compared: no growth
    }

    Value run() {
        check_scenes();
        begin();
        // First, before the process has held anything else.
        if (is_asked_for(kParty)) measure_party();
        for (const NamedScene& named : list_scenes())
            if (is_asked_for(named.name)) measure_levels(named.name, named.make());
        for (const Scene& scene : options_.files) measure_levels(scene.source, scene);
        result_["goals"] = make_peers_goals(result_);
        return std::move(result_);
    }

  private:
    bool is_asked_for(const std::string& name) const {
        return std::find(options_.scenes.begin(), options_.scenes.end(), name) != options_.scenes.end();
    }

    void check_scenes() const {
        const std::vector<std::string> known = peers_scene_names();
        for (const std::string& name : options_.scenes)
            if (std::find(known.begin(), known.end(), name) == known.end())
                throw Error(ErrorKind::usage,
                            {fmt::format("'{}' is not one of: {}", name, fmt::join(known, ", ")), "", ""});
    }

    void begin() {
        std::vector<std::string> levels;
        for (const int level : options_.levels) levels.push_back(format_level(level));
        result_ = {{"suite", "peers"},
                   {"build", describe_build()},
                   {"machine", describe_machine()},
                   {"settings",
                    {{"width", options_.width},
                     {"height", options_.height},
                     {"runs", options_.runs},
                     {"warm_up_runs", 1},
                     {"threads", settings_.device.threads},
                     {"levels", levels},
                     {"bottom_cache_bytes", *settings_.surface.cache_bytes},
                     {"tessellated_limit_bytes", options_.tessellated_limit_bytes},
                     {"scenes", options_.scenes}}},
                   {"embree_version", embree_version()},
                   {"scenes", Value::list()}};
    }

    void measure_party() {
        report_("party: memory and first image");
        RenderSettings settings = settings_;
        settings.image.bounces = 0;
        const Statistics s = render(make_sample_scene(kParty, Instancing::none), settings).statistics;
        result_["party"] = {{"patches", s.patches},
                            {"peak_resident_bytes", s.peak_resident_bytes},
                            {"first_image_s", s.first_image_s}};
    }

    void measure_levels(const std::string& name, const Scene& scene) {
        for (const int level : options_.levels) measure_level(name, scene, level);
    }

    void measure_level(const std::string& name, const Scene& scene, int level) {
        RenderSettings settings = settings_;
        settings.surface.level = level;
        const std::string full_name = fmt::format("{}, level {}", name, format_level(level));
        const uint64_t bytes = kTessellatedBytesPerQuad * estimate_tessellation(scene, settings).micro_quads;
        const bool has_triangles = bytes <= options_.tessellated_limit_bytes;
        const PeerScene peer{scene, full_name, settings, options_.runs, has_triangles, report_};
        report_(full_name + ": making rays");
        const TracerProbe probe(scene, settings);
        const std::vector<PeerRays> sets = make_peer_rays(probe, scene.camera);
        PeerCasts casts = measure_casts(peer, probe, sets);
        Value entry = {{"scene", name}, {"level", format_level(level)}, {"isa", probe.isa()}};
        if (!has_triangles)
            entry["triangles_left_out"] = fmt::format("they would need {} bytes, the limit of this run is {}",
                                                      bytes, options_.tessellated_limit_bytes);
        entry["memory"] = std::move(casts.memory);
        entry["agreement"] = std::move(casts.agreements);
        entry["casts"] = std::move(casts.casts);
        entry["cold"] = measure_cold(peer, sets);
        entry["bounces"] = measure_bounces(peer);
        result_["scenes"].push_back(std::move(entry));
    }

    /// Relief's own paths with white materials: seconds per ray by depth.
    Value measure_bounces(const PeerScene& peer) const {
        RenderSettings settings = peer.settings;
        settings.image.bounces = kPeerBounces;
        std::vector<Variant> variants = {{peer.name + ": paths", settings, {}, {}}};
        measure_in_turn(make_white(peer.scene), peer.runs, variants, peer.report);
        Value bounces = Value::list();
        if (!variants[0].refusal.empty()) return bounces;
        for (const Value& cast : describe_casts(variants[0].runs))
            if (cast["kind"] == "bounce" && cast["rays"].get<double>() > 0)
                bounces.push_back({{"depth", cast["depth"]},
                                   {"rays", cast["rays"]},
                                   {"total_s", cast["total_s"]},
                                   {"seconds_a_ray",
                                    cast["total_s"]["median"].get<double>() / cast["rays"].get<double>()}});
        return bounces;
    }

    const PeersOptions& options_;
    const Report& report_;
    RenderSettings settings_;
    Value result_;
};

} // namespace

std::vector<std::string> peers_scene_names() {
    std::vector<std::string> names = {kParty};
    for (const NamedScene& scene : list_scenes()) names.push_back(scene.name);
    return names;
}

const char* way_name(EmbreeWay way) {
    switch (way) {
    case EmbreeWay::triangles:
        return "triangles";
    case EmbreeWay::grid:
        return "grid";
    case EmbreeWay::subdivision:
        return "subdivision";
    }
    return "";
}

std::string format_level(int level) { return level == kAutoLevel ? "auto" : std::to_string(level); }

PeersOptions make_quick_options(PeersOptions options) {
    options.width = 64, options.height = 36;
    options.runs = 1;
    if (options.scenes == peers_scene_names()) options.scenes = {"rock", "pumpkin"};
    if (options.levels == PeersOptions{}.levels) options.levels = {3, kAutoLevel};
    return options;
}

Value run_peers(const PeersOptions& options, const Report& report) { return Peers(options, report).run(); }

} // namespace relief::bench
