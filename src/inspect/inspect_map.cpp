// What a displacement map is, how it is probably meant, and what is wrong with it.
#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "analysis/map_convention.h"
#include "analysis/map_statistics.h"
#include "analysis/mesh_statistics.h"
#include "base/progress.h"
#include "inspect/facts.h"
#include "inspect/map_mistakes.h"
#include "relief/convert.h"
#include "relief/inspect.h"
#include "scene/words.h"

namespace relief {

namespace {

struct SampleTypeName {
    const char* name;
    double bits;
};

SampleTypeName describe_type(SampleType type) {
    constexpr SampleTypeName kTypes[] = {{"8-bit integer", 8},
                                         {"16-bit integer", 16},
                                         {"32-bit integer", 32},
                                         {"16-bit float", 16},
                                         {"32-bit float", 32}};
    return kTypes[size_t(type)];
}

/// What a smooth filter takes beside the file's own texels.
Fact describe_filter(const Displacement& map) {
    const char* name = map.filter == MapFilter::cubic ? "cubic" : "bspline";
    if (map.filter == MapFilter::bspline && !map.dequantize)
        return {"filter", "bspline: the texels are the coefficients", {{"", 0, "bytes"}}};
    double bytes = 0;
    for (const MapTile& tile : map.tiles) bytes += double(tile.texture->value_count()) * sizeof(float);
    return {"filter",
            fmt::format("{}{}: coefficients of 32-bit floats in place of the texels, {:.0f} bytes", name,
                        map.dequantize ? ", dequantised" : "", bytes),
            {{"", bytes, "bytes"}}};
}

void describe_files(const Displacement& map, const MapStatistics& statistics, std::vector<Fact>& facts) {
    const Texture& first = *map.tiles.front().texture;
    size_t bytes = 0;
    bool is_one_size = true;
    for (const MapTile& tile : map.tiles) {
        bytes += tile.texture->byte_count();
        is_one_size &= tile.texture->width == first.width && tile.texture->height == first.height;
    }
    facts.push_back({"size",
                     fmt::format("{} x {} texels{}", first.width, first.height,
                                 is_one_size ? "" : "; other tiles have other sizes"),
                     {{"width", double(first.width), "texels"}, {"height", double(first.height), "texels"}}});
    if (map.is_udim) {
        std::string tiles;
        for (const MapTile& tile : map.tiles)
            tiles += fmt::format("{}{}", tiles.empty() ? "" : " ", tile.udim);
        facts.push_back({"tiles", tiles, {{"", double(map.tiles.size()), "count"}}});
    }
    facts.push_back(make_count("channels", statistics.channel_count));
    const SampleTypeName type = describe_type(statistics.type);
    facts.push_back({"type", type.name, {{"", type.bits, "bits"}}});
    facts.push_back({"memory", fmt::format("{} bytes", bytes), {{"", double(bytes), "bytes"}}});
    if (is_smooth(map.filter)) facts.push_back(describe_filter(map));
    for (size_t c = 0; c < std::min<size_t>(3, statistics.channel_count); ++c) {
        const ChannelStatistics& channel = statistics.channels[c];
        facts.push_back(
            {kChannelNames[c],
             fmt::format("{:.6g} to {:.6g}, mean {:.6g}", channel.low, channel.high, channel.mean),
             {{"low", double(channel.low), "texel value"},
              {"high", double(channel.high), "texel value"},
              {"mean", double(channel.mean), "texel value"}}});
    }
}

std::string describe_zero(const Displacement& map, MapMeaning meaning, const MapStatistics& statistics) {
    if (const auto known = find_known_midlevel(map, meaning))
        return known->x == known->y && known->y == known->z
                   ? fmt::format("{:g}, as declared", known->x)
                   : fmt::format("({:g}, {:g}, {:g}), as declared", known->x, known->y, known->z);
    if (is_integer_type(statistics.type)) return "0.5: integers hold no negative values";
    if (statistics.is_centred_at_half) return "0.5: no value is negative, and the means are near 0.5";
    const bool has_negative = std::any_of(statistics.channels.begin(), statistics.channels.end(),
                                          [](const ChannelStatistics& channel) { return channel.low < 0; });
    return has_negative ? "0: floats with negative values" : "0: floats";
}

/// In one line, and as options that a render takes.
std::string describe_looks(const MapStatistics& statistics, const MapConvention& convention) {
    const DisplacementSpace space = convention.space.value;
    std::string text;
    if (!convention.axes.is_clear && space == DisplacementSpace::tangent) {
        text =
            convention.space.is_clear ? "tangent space, axes not clear" : "not clear from the values alone";
    } else {
        text = fmt::format("{} space, axes {}, midlevel {:g}", get_word(space),
                           format_map_axes(convention.axes.value, space), statistics.midlevel[0]);
        if (space == DisplacementSpace::tangent) {
            const std::string presets = list_presets(convention.axes.value);
            if (!presets.empty()) text += " (presets " + presets + ")";
            text += convention.is_hand_clear ? "; t and b may be turned by quarters"
                                             : "; t and b may be exchanged or turned";
        }
    }
    return text;
}

void describe_convention(const Displacement& map, MapMeaning meaning, const MapStatistics& statistics,
                         const MapConvention& convention, std::vector<Fact>& facts) {
    const bool is_vector = statistics.channel_count >= 3 && !statistics.is_gray;
    facts.push_back({"midlevel",
                     describe_zero(map, meaning, statistics),
                     {{"R", statistics.midlevel[0], "texel value"},
                      {"G", statistics.midlevel[1], "texel value"},
                      {"B", statistics.midlevel[2], "texel value"}}});
    facts.push_back({"largest",
                     fmt::format("{:.6g} from the midlevel, times scale", statistics.largest),
                     {{"", statistics.largest, "texel value"}}});
    if (statistics.is_periodic)
        facts.push_back({"wrap", "opposite edges continue each other: probably repeat", {}});
    if (!is_vector) {
        facts.push_back({"looks_like", "a height map", {}});
        return;
    }
    facts.push_back({"space",
                     fmt::format("{}: {}",
                                 convention.space.is_clear ? get_word(convention.space.value)
                                                           : std::string("tangent, unless told otherwise"),
                                 convention.space.reason),
                     {}});
    facts.push_back(
        {"axes",
         fmt::format("{}: {}",
                     convention.axes.is_clear ? format_map_axes(convention.axes.value, convention.space.value)
                                              : "not clear",
                     convention.axes.reason),
         {}});
    facts.push_back({"looks_like", describe_looks(statistics, convention), {}});
}

/// What the texels say, and the mesh if the map can be laid onto it.
struct Reading {
    MapStatistics statistics;
    const Mesh* mesh = nullptr;
    bool is_misfit = false; ///< there is a mesh, and the map cannot
    MapConvention convention;
};

Reading read_map(const Displacement& map, MapMeaning meaning, const Mesh* mesh) {
    Reading reading;
    reading.statistics = measure_map(map.tiles, find_known_midlevel(map, meaning));
    const bool has_uvs = mesh && !mesh->uv_indices.empty();
    if (has_uvs && find_mesh_faults(*mesh).is_sound()) reading.mesh = mesh;
    reading.is_misfit = mesh && !reading.mesh;
    reading.convention = guess_convention(map, reading.statistics, reading.mesh);
    if (reading.is_misfit && !reading.convention.space.is_clear)
        reading.convention.space.reason = fmt::format("the mesh {}, and the map cannot be laid onto it",
                                                      has_uvs ? "has faults" : "has no uvs");
    return reading;
}

Displacement apply_guess(const Displacement& map, const Reading& reading) {
    Displacement guess = map;
    const MapStatistics& statistics = reading.statistics;
    if (statistics.channel_count < 3 || statistics.is_gray) guess.type = DisplacementType::height;
    guess.midlevel = {float(statistics.midlevel[0]), float(statistics.midlevel[1]),
                      float(statistics.midlevel[2])};
    if (reading.convention.space.is_clear) guess.space = reading.convention.space.value;
    if (reading.convention.axes.is_clear) guess.axes = reading.convention.axes.value;
    return guess;
}

/// Of a map whose axes are known or can be guessed.
void note_folds(const Displacement& map, MapMeaning meaning, const Reading& reading,
                std::vector<Finding>& findings) {
    if (reading.statistics.bad_count > 0 || reading.is_misfit) return;
    if (meaning == MapMeaning::unknown && !reading.convention.axes.is_clear && !reading.mesh) return;
    const Displacement meant = meaning == MapMeaning::declared ? map : apply_guess(map, reading);
    const std::optional<double> share = measure_fold_share(meant, reading.mesh);
    if (share && *share > 0)
        add_note(findings, "I-FOLD", "the surface folds over in {:.2f} % of the places looked at: overhangs",
                 100 * *share);
}

} // namespace

Inspection inspect_map(const Displacement& map, MapMeaning meaning, const Mesh* mesh,
                       const ProgressFunction& on_progress) {
    Inspection result;
    ProgressCounter steps(on_progress, 2);
    const Reading reading = read_map(map, meaning, mesh);
    steps.add(1);
    describe_files(map, reading.statistics, result.facts);
    describe_convention(map, meaning, reading.statistics, reading.convention, result.facts);
    for (const MapTile& tile : map.tiles) {
        for (const std::string& text : tile.texture->warnings)
            add_warning(result.findings, "W-READ", "{}", text);
        for (const std::string& text : tile.texture->notes) add_note(result.findings, "I-READ", "{}", text);
    }
    find_map_mistakes(map, meaning, reading.statistics, result.findings);
    if (reading.mesh) find_misfits(map, reading.statistics, *reading.mesh, result.findings);
    note_convention(map, meaning, reading.convention, result.findings);
    note_folds(map, meaning, reading, result.findings);
    steps.add(1);
    return result;
}

Displacement guess_map_meaning(const Displacement& map, const Mesh* mesh) {
    return apply_guess(map, read_map(map, MapMeaning::unknown, mesh));
}

} // namespace relief
