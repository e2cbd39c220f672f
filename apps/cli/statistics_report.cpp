#include "statistics_report.h"

#include <cmath>

#include "relief/version.h"

namespace relief::cli {

namespace {

Value make_times(const Statistics& s) {
    return {{"load", s.load_s},     {"prepare", s.prepare_s}, {"first_image", s.first_image_s},
            {"render", s.render_s}, {"denoise", s.denoise_s}, {"write", s.write_s},
            {"total", s.total_s}};
}

Value make_stages(const Statistics& s) {
    return {
        {"top_traversal", s.top_traversal_s},       {"sort", s.sort_s},   {"bottom_build", s.bottom_build_s},
        {"bottom_traversal", s.bottom_traversal_s}, {"shade", s.shade_s}, {"film", s.film_s}};
}

Value make_rays(const Statistics& s) {
    const uint64_t total = s.camera_rays + s.shadow_rays + s.bounce_rays;
    return {{"camera", s.camera_rays},
            {"shadow", s.shadow_rays},
            {"bounce", s.bounce_rays},
            {"total", total},
            {"per_second", s.render_s > 0 ? double(total) / s.render_s : 0.0}};
}

Value make_memory(const Statistics& s) {
    const uint64_t total = s.geometry_bytes + s.structures_bytes + s.displacement_bytes +
                           s.bottom_cache_bytes + s.ray_buffers_bytes;
    return {{"geometry", s.geometry_bytes},          {"structures", s.structures_bytes},
            {"displacement", s.displacement_bytes},  {"bottom_cache", s.bottom_cache_bytes},
            {"ray_buffers", s.ray_buffers_bytes},    {"total", total},
            {"peak_resident", s.peak_resident_bytes}};
}

Value make_casts(const Statistics& s) {
    Value casts = Value::list();
    for (const CastStatistics& cast : s.casts)
        casts.push_back({{"depth", cast.depth},
                         {"kind", cast.is_shadow ? "shadow" : (cast.depth == 0 ? "camera" : "bounce")},
                         {"rays", cast.rays},
                         {"pairs", cast.pairs},
                         {"top_traversal_s", cast.top_traversal_s},
                         {"sort_s", cast.sort_s},
                         {"bottom_build_s", cast.bottom_build_s},
                         {"bottom_traversal_s", cast.bottom_traversal_s}});
    return casts;
}

/// Infinity has no number in JSON.
Value make_noise(const NoiseReport& noise) {
    const auto write = [](double value) { return std::isfinite(value) ? Value(value) : Value(); };
    return {{"asked", float(noise.asked)},
            {"pixels", noise.pixels},
            {"reached_pixels", noise.reached_pixels},
            {"median_of_others", write(noise.median)},
            {"most", write(noise.most)}};
}

} // namespace

bool has_all_samples(const RenderResult& result) { return result.is_complete && !result.is_out_of_time; }

Value describe_statistics(const RenderResult& result, const RenderSettings& settings) {
    const Statistics& s = result.statistics;
    Value root;
    root["relief"] = {{"version", RELIEF_VERSION_STRING}};
    root["device"] = {{"engine", s.engine}, {"name", s.device}, {"threads", s.threads}, {"isa", s.isa}};
    root["image"] = {{"width", settings.image.width},
                     {"height", settings.image.height},
                     {"spp", settings.image.spp},
                     {"bounces", settings.image.bounces},
                     {"clamp_indirect", settings.image.clamp_indirect},
                     {"whole_samples", result.whole_samples},
                     {"is_complete", has_all_samples(result)}};
    if (result.noise) root["noise"] = make_noise(*result.noise);
    root["scene"] = {{"meshes", s.meshes},
                     {"instances", s.instances},
                     {"patches", s.patches},
                     {"triangles", s.triangles},
                     {"displacement_texels", s.displacement_texels}};
    root["time_s"] = make_times(s);
    root["stage_s"] = make_stages(s);
    root["rays"] = make_rays(s);
    root["casts"] = make_casts(s);
    root["pairs"] = {{"emitted", s.pairs_emitted}, {"with_hit", s.pairs_with_hit}};
    root["visits"] = {{"upper_nodes", s.upper_nodes}, {"patch_nodes", s.patch_nodes}, {"blocks", s.blocks}};
    root["bottom"] = {{"built", s.bottom_built},
                      {"reused", s.bottom_reused},
                      {"rebuilt", s.bottom_rebuilt},
                      {"levels", s.bottom_levels}};
    root["memory_bytes"] = make_memory(s);
    root["warnings"] = s.warnings;
    return root;
}

} // namespace relief::cli
