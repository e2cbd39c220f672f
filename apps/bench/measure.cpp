#include "bench/measure.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "relief/error.h"

namespace relief::bench {

namespace {

/// summarize of one value per run.
template <class Get> Value summarize_runs(const std::vector<Statistics>& runs, Get get) {
    std::vector<double> values;
    for (const Statistics& run : runs) values.push_back(get(run));
    return summarize(std::move(values));
}

constexpr std::pair<const char*, double Statistics::*> kStages[] = {
    {"top_traversal", &Statistics::top_traversal_s},
    {"sort", &Statistics::sort_s},
    {"bottom_build", &Statistics::bottom_build_s},
    {"bottom_traversal", &Statistics::bottom_traversal_s},
    {"shade", &Statistics::shade_s},
    {"film", &Statistics::film_s}};

constexpr std::pair<const char*, double CastStatistics::*> kCastStages[] = {
    {"top_traversal", &CastStatistics::top_traversal_s},
    {"sort", &CastStatistics::sort_s},
    {"bottom_build", &CastStatistics::bottom_build_s},
    {"bottom_traversal", &CastStatistics::bottom_traversal_s}};

double sum_stages(const CastStatistics& cast) {
    return cast.top_traversal_s + cast.sort_s + cast.bottom_build_s + cast.bottom_traversal_s;
}

double sum_frame_stages(const Statistics& statistics) {
    double sum = 0;
    for (const auto& [name, stage] : kStages) sum += statistics.*stage;
    return sum;
}

double get_median(std::vector<double> values) {
    const size_t middle = values.size() / 2;
    std::sort(values.begin(), values.end());
    return values.size() % 2 == 1 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
}

/// `share` of the way through the sorted values, between neighbours linearly.
double get_quantile(const std::vector<double>& sorted, double share) {
    const double place = share * double(sorted.size() - 1);
    const size_t below = size_t(place);
    const size_t above = std::min(below + 1, sorted.size() - 1);
    return sorted[below] + (place - double(below)) * (sorted[above] - sorted[below]);
}

void render_variant(const Scene& scene, Variant& variant, const Report& report, int run) {
    if (!variant.refusal.empty()) return;
    report(
        fmt::format("{}, {}", variant.name, run == 0 ? std::string("warm-up") : fmt::format("run {}", run)));
    try {
        Statistics statistics = render(scene, variant.settings).statistics;
        if (run > 0) variant.runs.push_back(std::move(statistics));
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::out_of_memory) throw;
        variant.refusal = error.what();
        variant.runs.clear();
    }
}

const char* get_kind(const CastStatistics& cast) {
    if (cast.is_shadow) return "shadow";
    return cast.depth == 0 ? "camera" : "bounce";
}

} // namespace

Value summarize(std::vector<double> values) {
    const auto [lowest, highest] = std::minmax_element(values.begin(), values.end());
    return {
        {"median", get_median(values)}, {"lowest", *lowest}, {"highest", *highest}, {"runs", values.size()}};
}

Value summarize_quartiles(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return {{"median", get_quantile(values, 0.5)},
            {"lower_quartile", get_quantile(values, 0.25)},
            {"upper_quartile", get_quantile(values, 0.75)},
            {"lowest", values.front()},
            {"highest", values.back()},
            {"runs", values.size()}};
}

std::vector<std::vector<double>> time_in_turn(const std::vector<Measure>& measures, int runs) {
    std::vector<std::vector<double>> seconds(measures.size());
    for (int run = 0; run <= runs; ++run)
        for (size_t k = 0; k < measures.size(); ++k) {
            const double measured = measures[k]();
            if (run > 0) seconds[k].push_back(measured);
        }
    return seconds;
}

Scene make_white(Scene scene) {
    for (Material& material : scene.materials) {
        material.base_color = {1, 1, 1};
        set_input_texture(material, MaterialInput::base_color, nullptr);
    }
    return scene;
}

void measure_in_turn(const Scene& scene, int runs, std::vector<Variant>& variants, const Report& report) {
    for (int run = 0; run <= runs; ++run)
        for (Variant& variant : variants) render_variant(scene, variant, report, run);
}

Value describe_frames(const std::vector<Statistics>& runs) {
    Value stages;
    for (const auto& [name, stage] : kStages)
        stages[name] = summarize_runs(runs, [s = stage](const Statistics& run) { return run.*s; });
    const Statistics& last = runs.back();
    return {{"frame_s", summarize_runs(runs, [](const Statistics& s) { return s.render_s; })},
            {"prepare_s", summarize_runs(runs, [](const Statistics& s) { return s.prepare_s; })},
            {"stage_s", stages},
            {"stages_total_s", summarize_runs(runs, sum_frame_stages)},
            {"bottom_built", last.bottom_built},
            {"bottom_reused", last.bottom_reused},
            {"geometry_bytes", last.geometry_bytes},
            {"structures_bytes", last.structures_bytes},
            {"bottom_cache_bytes", last.bottom_cache_bytes},
            {"ray_buffers_bytes", last.ray_buffers_bytes}};
}

Value describe_casts(const std::vector<Statistics>& runs) {
    Value casts = Value::list();
    // Every run traces the same rays, hence has the same casts.
    for (size_t k = 0; k < runs.front().casts.size(); ++k) {
        const CastStatistics& first = runs.front().casts[k];
        Value cast = {
            {"depth", first.depth}, {"kind", get_kind(first)}, {"rays", first.rays}, {"pairs", first.pairs}};
        for (const auto& [name, stage] : kCastStages)
            cast["stage_s"][name] =
                summarize_runs(runs, [k, s = stage](const Statistics& run) { return run.casts[k].*s; });
        cast["total_s"] =
            summarize_runs(runs, [k](const Statistics& run) { return sum_stages(run.casts[k]); });
        casts.push_back(std::move(cast));
    }
    return casts;
}

} // namespace relief::bench
