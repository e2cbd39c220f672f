#include "bench/frame_runs.h"

#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "bench/error_curve.h"
#include "bench/measure.h"
#include "bench/picture_channels.h"

namespace relief::bench {

namespace {

using Path = std::initializer_list<std::string_view>;

/// Null where a name of the path is missing.
Value find_value(const Value& statistics, Path path) {
    const Value* value = &statistics;
    for (const std::string_view name : path) {
        if (value->kind() != Value::Kind::record || !value->contains(name)) return {};
        value = &(*value)[name];
    }
    return *value;
}

std::optional<double> find_number(const Value& statistics, Path path) {
    const Value value = find_value(statistics, path);
    const bool is_number = value.kind() == Value::Kind::integer || value.kind() == Value::Kind::real;
    return is_number ? std::optional(value.get<double>()) : std::nullopt;
}

/// Of one number a run; null where a run lacks it.
template <class Get> Value summarize_found(size_t count, Get get) {
    std::vector<double> values;
    for (size_t k = 0; k < count; ++k)
        if (const std::optional<double> value = get(k)) values.push_back(*value);
    return values.size() == count && count > 0 ? summarize_quartiles(std::move(values)) : Value();
}

Value summarize_path(const std::vector<FrameRun>& runs, Path path) {
    return summarize_found(runs.size(), [&](size_t k) { return find_number(runs[k].statistics, path); });
}

Value describe_stages(const std::vector<FrameRun>& runs) {
    Value stages = Value::record();
    const Value named = find_value(runs.front().statistics, {"stage_s"});
    if (named.kind() != Value::Kind::record) return stages;
    double sum = 0;
    for (const Member& stage : named.members()) {
        const Value seconds = summarize_path(runs, {"stage_s", stage.name});
        if (seconds.kind() == Value::Kind::nothing) continue;
        stages[stage.name] = {{"seconds", seconds}};
        sum += seconds["median"].get<double>();
    }
    for (const Member& stage : named.members())
        if (stages.contains(stage.name) && sum > 0)
            stages[stage.name]["share"] = stages[stage.name]["seconds"]["median"].get<double>() / sum;
    return stages;
}

std::optional<double> find_time(const FrameRun& run) {
    return find_number(run.statistics, {"time_s", "render"});
}

std::optional<double> find_time_with_preparation(const FrameRun& run) {
    const auto prepare = find_number(run.statistics, {"time_s", "prepare"});
    const auto render = find_time(run);
    return prepare && render ? std::optional(*prepare + *render) : std::nullopt;
}

std::optional<double> divide(std::optional<double> above, std::optional<double> below) {
    return above && below && *below > 0 ? std::optional(*above / *below) : std::nullopt;
}

double compute_brightness(const Image& picture) {
    double sum = 0;
    for (const char* name : {"R", "G", "B"}) {
        const size_t channel = find_channel(picture, name);
        for (int y = 0; y < picture.height; ++y)
            for (int x = 0; x < picture.width; ++x) sum += double(picture.at(x, y, channel));
    }
    return sum / (3.0 * double(picture.width) * double(picture.height));
}

} // namespace

Value describe_frame_runs(const std::vector<FrameRun>& runs, double samples) {
    const Value& last = runs.back().statistics;
    return {{"version", find_value(last, {"relief", "version"})},
            {"device", find_value(last, {"device"})},
            {"samples_per_s",
             summarize_found(runs.size(), [&](size_t k) { return divide(samples, find_time(runs[k])); })},
            {"rays_per_sample",
             summarize_found(runs.size(),
                             [&](size_t k) {
                                 return divide(find_number(runs[k].statistics, {"rays", "total"}), samples);
                             })},
            {"render_s", summarize_path(runs, {"time_s", "render"})},
            {"prepare_s", summarize_path(runs, {"time_s", "prepare"})},
            {"first_image_s", summarize_path(runs, {"time_s", "first_image"})},
            {"processor_s",
             summarize_found(runs.size(), [&](size_t k) { return std::optional(runs[k].processor_s); })},
            {"peak_resident_bytes", summarize_path(runs, {"memory_bytes", "peak_resident"})},
            {"stages", describe_stages(runs)}};
}

Value compare_frame_runs(const std::vector<FrameRun>& own, const std::vector<FrameRun>& baseline) {
    const auto compare = [&](auto get_seconds) {
        return summarize_found(
            own.size(), [&](size_t k) { return divide(get_seconds(baseline[k]), get_seconds(own[k])); });
    };
    const auto get_processor_time = [](const FrameRun& run) { return std::optional(run.processor_s); };
    return {{"ratio", compare(find_time)},
            {"ratio_with_preparation", compare(find_time_with_preparation)},
            {"ratio_by_processor", compare(get_processor_time)}};
}

Value compare_frame_pictures(const Image& picture, const Image& reference) {
    const double error = compute_relative_error(picture, reference); // refuses pictures of other sizes
    const double brightness = compute_brightness(reference);
    return {{"brightness_difference",
             brightness > 0 ? Value((compute_brightness(picture) - brightness) / brightness) : Value()},
            {"relative_squared_error", error}};
}

} // namespace relief::bench
