#include "api/picture_report.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "base/parallel.h"
#include "engine/block_noise.h"
#include "engine/sample_plan.h"
#include "prepare/camera_frame.h"
#include "relief/version.h"

namespace relief {

/// Of the time of all stages, lost to trees that are built again: a warning above it.
constexpr double kLeastLoss = 0.25;

void count_scene(const PreparedScene& scene, Statistics& statistics) {
    statistics.meshes = scene.mesh_count;
    statistics.instances = scene.instances.size();
    std::vector<const void*> seen;
    const auto is_new = [&](const void* part) {
        if (!part || std::find(seen.begin(), seen.end(), part) != seen.end()) return false;
        seen.push_back(part);
        return true;
    };
    for (const Surface& surface : scene.surfaces) {
        for (const Quad quad : surface.quads) {
            if (surface.has_displacement)
                ++statistics.patches;
            else
                statistics.triangles += quad.is_triangle() ? 1 : 2;
        }
        for (const DisplacementMap::Tile& tile : surface.map.tiles) {
            if (is_new(tile.mips.get())) statistics.displacement_bytes += tile.mips->byte_count();
            if (!is_new(tile.texture.get())) continue;
            statistics.displacement_texels += uint64_t(tile.texture->width) * tile.texture->height;
            statistics.displacement_bytes += tile.texture->byte_count() + tile.pyramid->byte_count();
        }
    }
    // Texels that a session keeps beside the coefficients made of them.
    for (const PreparedMap& map : scene.maps)
        if (map.coefficients && is_new(map.texture.get()))
            statistics.displacement_bytes += map.texture->byte_count();
}

namespace {

/// Trees that are built again and again are time lost.
void add_cache_warning(Statistics& statistics) {
    const double stages = statistics.top_traversal_s + statistics.sort_s + statistics.bottom_build_s +
                          statistics.bottom_traversal_s + statistics.shade_s + statistics.film_s;
    const double lost =
        statistics.bottom_built == 0
            ? 0
            : statistics.bottom_build_s * double(statistics.bottom_rebuilt) / double(statistics.bottom_built);
    if (lost <= kLeastLoss * stages) return;
    statistics.warnings.push_back(fmt::format(
        "{:.0f} per cent of the time went into building {} patch trees again: their cache of {} MiB is too "
        "small for this picture; surface.cache_bytes sets it, and without it the cache grows into memory "
        "that "
        "is available",
        100 * lost / stages, statistics.bottom_rebuilt, statistics.bottom_cache_bytes >> 20));
}

/// One for each kind of rays and depth.
void join_casts(std::vector<CastStatistics>& casts) {
    std::vector<CastStatistics> joined;
    for (const CastStatistics& cast : casts) {
        const auto found = std::ranges::find_if(joined, [&](const CastStatistics& other) {
            return other.depth == cast.depth && other.is_shadow == cast.is_shadow;
        });
        if (found == joined.end()) {
            joined.push_back(cast);
            continue;
        }
        found->rays += cast.rays, found->pairs += cast.pairs;
        found->top_traversal_s += cast.top_traversal_s, found->sort_s += cast.sort_s;
        found->bottom_build_s += cast.bottom_build_s, found->bottom_traversal_s += cast.bottom_traversal_s;
    }
    casts = std::move(joined);
}

/// Takes the counts and times of earlier pictures off those of an engine.
void subtract_counted(const Statistics& counted, Statistics& statistics) {
    for (double Statistics::*const time :
         {&Statistics::prepare_s, &Statistics::render_s, &Statistics::top_traversal_s, &Statistics::sort_s,
          &Statistics::bottom_build_s, &Statistics::bottom_traversal_s, &Statistics::shade_s,
          &Statistics::film_s})
        statistics.*time -= counted.*time;
    for (uint64_t Statistics::*const count :
         {&Statistics::camera_rays, &Statistics::shadow_rays, &Statistics::bounce_rays,
          &Statistics::pairs_emitted, &Statistics::pairs_with_hit, &Statistics::upper_nodes,
          &Statistics::patch_nodes, &Statistics::blocks, &Statistics::bottom_built,
          &Statistics::bottom_reused, &Statistics::bottom_rebuilt})
        statistics.*count -= counted.*count;
    for (size_t level = 0; level < counted.bottom_levels.size(); ++level)
        statistics.bottom_levels[level] -= counted.bottom_levels[level];
    for (CastStatistics& cast : statistics.casts)
        for (const CastStatistics& before : counted.casts) {
            if (before.depth != cast.depth || before.is_shadow != cast.is_shadow) continue;
            cast.rays -= before.rays, cast.pairs -= before.pairs;
            cast.top_traversal_s -= before.top_traversal_s, cast.sort_s -= before.sort_s;
            cast.bottom_build_s -= before.bottom_build_s;
            cast.bottom_traversal_s -= before.bottom_traversal_s;
        }
}

} // namespace

std::string describe_settings(const RenderSettings& settings) {
    const ImageSettings& image = settings.image;
    const SurfaceSettings& surface = settings.surface;
    const std::string background = image.background ? fmt::format("{} {} {}", image.background->x,
                                                                  image.background->y, image.background->z)
                                                    : "environment";
    return fmt::format("bounces {}, clamp {}, background {}, surface {}, level {}, pixel error {}, lod {}, "
                       "bounce levels {}, "
                       "leaf {}",
                       image.bounces, image.clamp_indirect, background,
                       surface.mode == SurfaceMode::direct ? "direct" : "tessellated",
                       surface.level == kAutoLevel ? "auto" : std::to_string(surface.level),
                       surface.pixel_error, surface.lod == LodRule::field ? "field" : "ray",
                       surface.bounce_levels == BounceLevels::automatic ? "auto" : "camera",
                       surface.leaf == LeafKind::exact ? "exact" : "box");
}

void keep_counts(const Engine& engine, SessionCounts& counts) {
    Statistics& sum = counts.replaced;
    engine.add_statistics(sum);
    join_casts(sum.casts);
    for (uint64_t Statistics::*const bytes :
         {&Statistics::geometry_bytes, &Statistics::structures_bytes, &Statistics::displacement_bytes,
          &Statistics::bottom_cache_bytes, &Statistics::ray_buffers_bytes})
        sum.*bytes = 0; // another engine takes their place
}

void collect_statistics(const Engine& engine, const Film& film, const PreparedScene& scene,
                        Statistics& statistics, SessionCounts& counts) {
    Statistics all = counts.replaced;
    engine.add_statistics(all);
    join_casts(all.casts);
    const double prepare_s = statistics.prepare_s, render_s = statistics.render_s;
    statistics = all;
    subtract_counted(std::exchange(counts.before, std::move(all)), statistics);
    statistics.prepare_s += prepare_s, statistics.render_s += render_s;
    statistics.threads = thread_count();
    statistics.first_image_s += statistics.prepare_s;
    statistics.ray_buffers_bytes += film.byte_count();
    statistics.warnings = scene.warnings;
    add_cache_warning(statistics);
    count_scene(scene, statistics);
}

Film make_film(const ImageSettings& image, std::shared_ptr<const InstanceMattes> mattes) {
    Film film(image.width, image.height, image.crop, image.layers,
              image.noise > 0 ? ErrorEstimate::on : ErrorEstimate::off);
    film.name_instances(std::move(mattes));
    return film;
}

PictureSpace make_picture_space(const PreparedScene& scene) {
    const scalar::CameraFrame camera = make_camera_frame(scene);
    return {scene.origin, camera.right, camera.up, -camera.forward};
}

void show_pictures(const Film& film, const PictureSpace& space, RenderControl& control) {
    RenderObserver* const observer = control.observer;
    const double interval_s =
        observer ? observer->picture_interval_s() : std::numeric_limits<double>::infinity();
    if (std::isinf(interval_s)) return;
    control.show = {interval_s, [&film, space, observer] { observer->on_picture(film.resolve(space)); }};
}

std::string describe_samples(const RenderSettings& settings, uint64_t scene_hash) {
    const ImageSettings& image = settings.image;
    // Layers of which no sums are kept, and their order, do not matter.
    std::vector<std::string> layers = image.layers;
    std::erase(layers, "samples");
    std::ranges::sort(layers);
    return fmt::format("Relief {}, scene {:016x}, {}x{}, crop {},{},{},{}, seed {}, first sample {}, {}, "
                       "layers {}, noise {}, "
                       "engine {}",
                       RELIEF_VERSION_STRING, scene_hash, image.width, image.height, image.crop.x0,
                       image.crop.y0, image.crop.x1, image.crop.y1, image.seed, image.first_sample,
                       describe_settings(settings), fmt::join(layers, ","), image.noise,
                       settings.device.engine == EngineKind::cpu ? "cpu" : "vulkan");
}

void note_ends(const ImageSettings& image, Film& film, RenderResult& result) {
    result.whole_samples = int(film.least_samples());
    if (image.noise > 0 && result.whole_samples > 0) result.noise = measure_noise(film, image.noise);
    result.is_out_of_time = result.is_complete && image.time_limit_s > 0 && lacks_samples(film, image);
}

void add_metadata(const RenderSettings& settings, uint64_t scene_hash, bool is_complete, const Film& film,
                  Image& image) {
    // Where noise was low enough no sample is missing; what time ended has the samples that it has.
    const bool may_lack_some = !is_complete || settings.image.noise > 0;
    const int samples = std::max(int(film.most_samples()), may_lack_some ? settings.image.spp : 0);
    image.metadata["Software"] = "Relief " RELIEF_VERSION_STRING;
    image.metadata["relief:version"] = RELIEF_VERSION_STRING;
    image.metadata["relief:seed"] = std::to_string(settings.image.seed);
    image.metadata["relief:samples"] =
        fmt::format("{}:{}", settings.image.first_sample, settings.image.first_sample + samples);
    image.metadata["relief:scene_hash"] = fmt::format("{:016x}", scene_hash);
    image.metadata["relief:settings"] = describe_settings(settings);
    if (const Window& whole = settings.image.whole_window; whole != Window{})
        image.metadata["relief:whole_window"] =
            fmt::format("{},{},{},{}", whole.x0, whole.y0, whole.x1, whole.y1);
    if (settings.image.whole_samples > 0)
        image.metadata["relief:whole_samples"] = std::to_string(settings.image.whole_samples);
    if (settings.image.noise > 0) image.metadata["relief:noise"] = fmt::format("{}", settings.image.noise);
    if (settings.image.time_limit_s > 0)
        image.metadata["relief:time_limit"] = fmt::format("{} s", settings.image.time_limit_s);
    if (!is_complete) image.metadata["relief:interrupted"] = "yes";
}

} // namespace relief
