#include "bench/edits.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "bench/machine.h"
#include "relief/error.h"
#include "relief/io.h"
#include "relief/samples.h"
#include "relief/session.h"

namespace relief::bench {

namespace {

constexpr double kEditGoal = 10; ///< fresh load over edit
constexpr uint32_t kPlacesPerSide = 4;
constexpr float kBumpHeight = 0.04f; ///< scene units, along the normal; the pumpkin is about two wide

double get_seconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Replicates every texel `times` squared times to reach the requested map size.
std::shared_ptr<const Texture> enlarge(const Texture& map, uint32_t times) {
    auto large = std::make_shared<Texture>(map);
    large->width = map.width * times, large->height = map.height * times;
    const auto repeat = [&](const auto& from, auto& to) {
        if (from.empty()) return;
        to.resize(large->value_count());
        for (size_t y = 0; y < large->height; ++y)
            for (size_t x = 0; x < large->width; ++x)
                std::copy_n(from.begin() + ptrdiff_t(map.find_texel(x / times, y / times)), map.stride,
                            to.begin() + ptrdiff_t(large->find_texel(x, y)));
    };
    repeat(map.floats, large->floats), repeat(map.halves, large->halves);
    return large;
}

/// A smooth bump along the normal.
MapEdit make_edit(const std::string& displacement, uint32_t x, uint32_t y, uint32_t edge) {
    MapEdit edit;
    edit.displacement = displacement, edit.x = x, edit.y = y;
    edit.texels.width = edit.texels.height = edge;
    edit.texels.channel_count = 3;
    edit.texels.file = "bump";
    for (uint32_t k = 0; k < edge * edge; ++k) {
        const float u = (float(k % edge) + 0.5f) / float(edge), v = (float(k / edge) + 0.5f) / float(edge);
        const float height = 16 * kBumpHeight * u * (1 - u) * v * (1 - v);
        edit.texels.floats.insert(edit.texels.floats.end(), {0, 0, height, 1});
    }
    return edit;
}

std::vector<MapEdit> make_edits(const Displacement& map, uint32_t edge) {
    const Texture& texels = *map.tiles.at(0).texture;
    std::vector<MapEdit> edits;
    for (uint32_t k = 0; k < kPlacesPerSide * kPlacesPerSide; ++k) {
        const uint32_t column = k % kPlacesPerSide, row = k / kPlacesPerSide;
        const auto place = [&](uint32_t slot, uint32_t size) {
            return (2 * slot + 1) * size / (2 * kPlacesPerSide) - edge / 2;
        };
        edits.push_back(make_edit(map.name, place(column, texels.width), place(row, texels.height), edge));
    }
    return edits;
}

/// One configuration of the picture.
struct Kind {
    const char* name;
    int samples, bounces;
};

constexpr Kind kKinds[] = {{"a sample, direct light", 1, 0}, {"4 samples, 4 bounces", 4, 4}};

void require_same(const Image& a, const Image& b) {
    if (a.pixels != b.pixels)
        throw Error(ErrorKind::failed,
                    {"the picture after the edits is not that of the edited map", "bench edits", ""});
}

Value measure_fresh(const std::filesystem::path& file, const RenderSettings& settings, int runs) {
    std::vector<double> load, prepare, render, total;
    for (int run = 0; run <= runs; ++run) {
        const double start = get_seconds();
        Scene scene = load_scene(file);
        const double loaded = get_seconds();
        const RenderResult result = relief::render(std::move(scene), settings);
        if (run == 0) continue;
        load.push_back(loaded - start), total.push_back(get_seconds() - start);
        prepare.push_back(result.statistics.prepare_s), render.push_back(result.statistics.render_s);
    }
    return {{"load_s", summarize(load)},
            {"prepare_s", summarize(prepare)},
            {"render_s", summarize(render)},
            {"picture_s", summarize(total)}};
}

uint64_t count_rays(const Statistics& s) { return s.camera_rays + s.shadow_rays + s.bounce_rays; }

Value measure_edits(const Scene& scene, const RenderSettings& settings, const std::vector<MapEdit>& edits) {
    Session session(scene, settings), reference(scene, settings);
    RenderResult result = session.render();
    const double all_rays = double(count_rays(result.statistics));
    std::vector<double> follow, picture, shares;
    for (const MapEdit& edit : edits) {
        const double start = get_seconds();
        follow.push_back(session.edit(edit).seconds);
        result = session.render();
        picture.push_back(get_seconds() - start);
        shares.push_back(double(count_rays(result.statistics)) / all_rays);
        reference.edit(edit);
    }
    require_same(result.image, reference.render().image);
    return {{"edit_s", summarize(follow)},
            {"picture_s", summarize(picture)},
            {"rays_share", summarize(shares)},
            {"picture_s_of_each", picture},
            {"rays_share_of_each", shares}};
}

Value measure_kind(const Kind& kind, const EditsOptions& options, const Scene& scene,
                   const std::vector<MapEdit>& edits) {
    RenderSettings settings = options.settings;
    settings.image.spp = kind.samples, settings.image.bounces = kind.bounces;
    Value entry = {{"name", kind.name}, {"samples", kind.samples}, {"bounces", kind.bounces}};
    entry["fresh"] = measure_fresh(options.folder / "pumpkin" / "scene.json", settings, options.runs);
    entry["edits"] = measure_edits(scene, settings, edits);
    const Value& fresh = entry["fresh"]["picture_s"];
    const Value& edit = entry["edits"]["picture_s"];
    entry["ratio"] = fresh["median"].get<double>() / edit["median"].get<double>();
    entry["ratio_of_slowest"] = fresh["median"].get<double>() / edit["highest"].get<double>();
    return entry;
}

void add_goal(Value& goals, const std::string& name, double reached) {
    goals.push_back({{"name", name},
                     {"goal", kEditGoal},
                     {"reached", reached},
                     {"unit", "times as fast as a fresh load"},
                     {"met", reached >= kEditGoal}});
}

} // namespace

EditsOptions make_quick_options(EditsOptions options) {
    options.runs = 1;
    options.settings.image.width = 64, options.settings.image.height = 36;
    options.enlargement = 1, options.edge = 64;
    return options;
}

Value run_edits(const EditsOptions& options, const Report& report) {
    Scene scene = make_sample_scene("pumpkin", Instancing::none);
    MapTile& tile = scene.displacements.at(0).tiles.at(0);
    tile.texture = enlarge(*tile.texture, uint32_t(options.enlargement));
    save_scene(scene, options.folder / "pumpkin");
    const std::vector<MapEdit> edits = make_edits(scene.displacements[0], options.edge);
    Value result = {{"suite", "edits"},
                    {"build", describe_build()},
                    {"machine", describe_machine()},
                    {"settings",
                     {{"runs", options.runs},
                      {"width", options.settings.image.width},
                      {"height", options.settings.image.height},
                      {"threads", options.settings.device.threads},
                      {"map", Value::list({tile.texture->width, tile.texture->height})},
                      {"edge", options.edge},
                      {"edits", edits.size()}}},
                    {"pictures", Value::list()},
                    {"goals", Value::list()}};
    for (const Kind& kind : kKinds) {
        report(kind.name);
        const Value entry = measure_kind(kind, options, scene, edits);
        add_goal(result["goals"], fmt::format("{}: median edit", kind.name), entry["ratio"].get<double>());
        add_goal(result["goals"], fmt::format("{}: slowest edit", kind.name),
                 entry["ratio_of_slowest"].get<double>());
        result["pictures"].push_back(entry);
    }
    return result;
}

} // namespace relief::bench
