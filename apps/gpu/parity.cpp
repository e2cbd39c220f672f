#include "gpu/parity.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "relief/error.h"
#include "relief/samples.h"
#include "relief/scene.h"

namespace relief::gpu {

namespace {

constexpr int kBlocks = 16; ///< per side

size_t get_channel(const Image& image, const char* name) {
    const auto channel = image.find_channel(name);
    if (!channel) throw Error(ErrorKind::failed, {"a picture lacks a layer that parity needs", name, ""});
    return *channel;
}

/// Sums over the pixels of a block: radiance (mean of R, G, B) and its variance, conservatively assuming
/// fully correlated noise of the channels.
struct Block {
    double sum = 0, variance = 0, pixels = 0;
};

std::vector<Block> sum_blocks(const Image& image) {
    constexpr std::array<const char*, 3> colors = {"R", "G", "B"};
    constexpr std::array<const char*, 3> variances = {"variance.R", "variance.G", "variance.B"};
    std::vector<Block> blocks(kBlocks * kBlocks);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            Block& block = blocks[size_t(y * kBlocks / image.height * kBlocks + x * kBlocks / image.width)];
            double deviation = 0;
            for (size_t c = 0; c < 3; ++c) {
                block.sum += image.at(x, y, get_channel(image, colors[c])) / 3;
                deviation += std::sqrt(image.at(x, y, get_channel(image, variances[c]))) / 3;
            }
            block.variance += deviation * deviation;
            block.pixels += 1;
        }
    return blocks;
}

/// A change to the settings, and its name.
struct Setting {
    std::string name;
    std::function<void(RenderSettings&)> apply;
};

std::vector<Setting> list_settings() {
    std::vector<Setting> settings = {{"auto", [](RenderSettings&) {}}};
    for (int level = 3; level <= 6; ++level)
        settings.push_back(
            {fmt::format("level {}", level), [level](RenderSettings& s) { s.surface.level = level; }});
    settings.push_back({"box leaves", [](RenderSettings& s) { s.surface.leaf = LeafKind::box; }});
    settings.push_back({"level a ray", [](RenderSettings& s) { s.surface.lod = LodRule::ray; }});
    settings.push_back({"no cache", [](RenderSettings& s) { s.surface.cache_bytes = 0; }});
    settings.push_back({"small cache", [](RenderSettings& s) { s.surface.cache_bytes = size_t(1) << 20; }});
    settings.push_back({"tessellated", [](RenderSettings& s) { s.surface.mode = SurfaceMode::tessellated; }});
    return settings;
}

class Parity {
  public:
    Parity(const ParityOptions& options, const bench::Report& report) : options_(options), report_(report) {}

    Value run() {
        for (const std::string& name : options_.scenes) {
            report_(fmt::format("making the scene {}", name));
            // One scene with shared meshes: all its instances share the jobs of a patch.
            check_scene(name,
                        make_sample_scene(name, name == "barks" ? Instancing::shared : Instancing::none));
        }
        return {
            {"cases", std::move(cases_)}, {"passed", passed_}, {"failed", failed_}, {"refused", refused_}};
    }

  private:
    void check_scene(const std::string& scene_name, const Scene& scene) {
        for (const Setting& setting : list_settings()) check_setting(scene_name, scene, setting);
        add_case("same bits twice, " + scene_name, [&](Value&) { return check_repeat(scene); });
        add_case("means, " + scene_name, [&](Value& entry) { return check_means(scene, entry); });
    }

    /// Compares both forms of the patch tree kernels, where used, with one picture of the CPU engine.
    void check_setting(const std::string& scene_name, const Scene& scene, const Setting& setting) {
        RenderSettings settings = options_.settings;
        settings.image.spp = 1, settings.image.bounces = 0;
        settings.image.layers = {"depth", "id"};
        setting.apply(settings);
        const std::string name = fmt::format("hits, {}, {}", scene_name, setting.name);
        std::optional<Image> expected;
        const auto add_form = [&](const std::string& case_name, BottomForm form) {
            settings.experiment.bottom = form;
            add_case(case_name, [&](Value& entry) {
                if (!expected) expected = render_cpu(scene, settings).image;
                return check_hits(scene, settings, *expected, entry);
            });
        };
        if (settings.surface.mode == SurfaceMode::tessellated) return add_form(name, BottomForm::automatic);
        add_form(name + ", split", BottomForm::split);
        add_form(name + ", fused", BottomForm::fused);
    }

    /// Runs a check that fills in its findings and returns whether it passed.
    void add_case(const std::string& name, const std::function<bool(Value&)>& check) {
        if (name.find(options_.only) == std::string::npos) return;
        report_(name);
        Value entry = {{"name", name}, {"outcome", ""}};
        try {
            entry["outcome"] = check(entry) ? "passed" : "failed";
        } catch (const Error& error) {
            if (error.kind() == ErrorKind::device_missing) throw;
            // A scene that does not fit into memory is not a failure of the engine.
            entry["outcome"] = error.kind() == ErrorKind::out_of_memory ? "refused" : "failed";
            entry["message"] = error.what();
        }
        passed_ += entry["outcome"] == "passed";
        failed_ += entry["outcome"] == "failed";
        refused_ += entry["outcome"] == "refused";
        cases_.push_back(std::move(entry));
    }

    static bool check_hits(const Scene& scene, const RenderSettings& settings, const Image& expected,
                           Value& entry) {
        const RenderResult found = render_vulkan(scene, settings);
        const HitDifference d = compare_hits(found.image, expected);
        const Statistics& s = found.statistics;
        entry.update(Value{{"pixels", d.pixels},
                           {"one_only", d.one_only},
                           {"other_depth", d.other_depth},
                           {"other_id", d.other_id},
                           {"largest_depth_difference", d.largest_depth_difference},
                           {"render_s", s.render_s},
                           {"pairs", s.pairs_emitted},
                           {"bottom_built", s.bottom_built}});
        return d.share() <= kLargestShare;
    }

    bool check_repeat(const Scene& scene) const {
        RenderSettings settings = options_.settings;
        settings.image.spp = 2, settings.image.bounces = 3;
        const auto same_bits = [](float a, float b) { return a == b || (std::isnan(a) && std::isnan(b)); };
        const Image first = render_vulkan(scene, settings).image;
        const Image second = render_vulkan(scene, settings).image;
        return std::equal(first.pixels.begin(), first.pixels.end(), second.pixels.begin(),
                          second.pixels.end(), same_bits);
    }

    bool check_means(const Scene& scene, Value& entry) const {
        RenderSettings settings = options_.settings;
        settings.image.width = std::max(1, settings.image.width / 4),
        settings.image.height = std::max(1, settings.image.height / 4);
        settings.image.spp = options_.noise_samples, settings.image.bounces = 4;
        settings.image.layers = {"variance"};
        const Image found = render_vulkan(scene, settings).image;
        settings.image.seed += 1; // independent samples
        const double z = compute_largest_z(found, render_cpu(scene, settings).image);
        entry["largest_z"] = z;
        return z <= kLargestZ;
    }

    static RenderResult render_vulkan(const Scene& scene, RenderSettings settings) {
        settings.device.engine = EngineKind::vulkan;
        RenderResult result = render(scene, settings);
        if (result.statistics.engine != "vulkan")
            throw Error(ErrorKind::failed,
                        {"asked for the Vulkan engine, got " + result.statistics.engine, "", ""});
        return result;
    }

    static RenderResult render_cpu(const Scene& scene, RenderSettings settings) {
        settings.device.engine = EngineKind::cpu;
        settings.device.index = -1, settings.experiment.bottom = BottomForm::automatic;
        settings.surface.cache_bytes = RenderSettings{}.surface.cache_bytes; // affects only the time
        return render(scene, settings);
    }

    const ParityOptions& options_;
    const bench::Report& report_;
    Value cases_ = Value::list();
    int passed_ = 0, failed_ = 0, refused_ = 0;
};

} // namespace

HitDifference compare_hits(const Image& a, const Image& b) {
    HitDifference difference;
    const size_t depth_a = get_channel(a, "depth.Z"), depth_b = get_channel(b, "depth.Z");
    const size_t id_a = get_channel(a, "id.I"), id_b = get_channel(b, "id.I");
    for (int y = 0; y < a.height; ++y)
        for (int x = 0; x < a.width; ++x) {
            ++difference.pixels;
            const double za = a.at(x, y, depth_a), zb = b.at(x, y, depth_b);
            if (std::isfinite(za) != std::isfinite(zb)) {
                ++difference.one_only;
                continue;
            }
            if (!std::isfinite(za)) continue;
            const double relative = std::fabs(za - zb) / std::max(std::fabs(za), std::fabs(zb));
            if (!(relative <= kLargestDepthDifference))
                ++difference.other_depth;
            else if (a.at(x, y, id_a) != b.at(x, y, id_b))
                ++difference.other_id;
            else
                difference.largest_depth_difference = std::max(difference.largest_depth_difference, relative);
        }
    return difference;
}

double compute_largest_z(const Image& a, const Image& b) {
    /// Tolerance of a mean for rounding.
    constexpr double kRelativeFloor = 1e-4;
    const std::vector<Block> blocks_a = sum_blocks(a), blocks_b = sum_blocks(b);
    double largest = 0;
    for (size_t k = 0; k < blocks_a.size(); ++k) {
        if (blocks_a[k].pixels == 0) continue;
        const double error =
            std::sqrt(blocks_a[k].variance + blocks_b[k].variance) + kRelativeFloor * blocks_a[k].sum;
        const double difference = std::fabs(blocks_a[k].sum - blocks_b[k].sum);
        if (difference > 0) largest = std::max(largest, difference / error);
    }
    return largest;
}

Value run_parity(const ParityOptions& options, const bench::Report& report) {
    return Parity(options, report).run();
}

} // namespace relief::gpu
