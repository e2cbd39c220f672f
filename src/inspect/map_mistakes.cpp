#include "inspect/map_mistakes.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "inspect/facts.h"
#include "math/box.h"
#include "relief/convert.h"
#include "scene/coordinate_limit.h"
#include "scene/displacement_conventions.h"
#include "scene/face_uvs.h"

namespace relief {

namespace {

double get_largest_scale(const Displacement& map) {
    return std::max({std::fabs(map.scale.x), std::fabs(map.scale.y), std::fabs(map.scale.z)});
}

bool is_height(const Displacement& map, MapMeaning meaning) {
    return meaning == MapMeaning::declared && map.type == DisplacementType::height;
}

void find_bad_texels(const Displacement& map, const MapStatistics& statistics,
                     std::vector<Finding>& findings) {
    if (!statistics.bad) return;
    add_error(findings, "E-NAN",
              "NaN or infinity in {} texel(s), the first at {}; paint over it or bake the map again: a "
              "render refuses it",
              statistics.bad_count, describe_place(*statistics.bad, map));
}

void find_far_texels(const Displacement& map, const MapStatistics& statistics,
                     std::vector<Finding>& findings) {
    const double longest = statistics.largest * get_largest_scale(map);
    if (!(longest > kLargestCoordinate)) return;
    add_error(
        findings, "E-FAR",
        "a displacement of {:.3g} at {}, and a render refuses more than {:g}; paint over it, bake the map "
        "again or set displacement.scale",
        longest, describe_place(statistics.largest_place, map), kLargestCoordinate);
}

double find_low(const MapStatistics& statistics) {
    double low = statistics.channels[0].low;
    for (size_t c = 1; c < statistics.used_channels(); ++c) low = std::min(low, statistics.channels[c].low);
    return low;
}

double find_high(const MapStatistics& statistics) {
    double high = statistics.channels[0].high;
    for (size_t c = 1; c < statistics.used_channels(); ++c)
        high = std::max(high, statistics.channels[c].high);
    return high;
}

/// Whoever says that 0 is meant may know better than the values.
void find_unsigned(const Displacement& map, MapMeaning meaning, const MapStatistics& statistics,
                   std::vector<Finding>& findings) {
    const bool is_known = knows_midlevel(map, meaning);
    if (!statistics.is_centred_at_half || is_height(map, meaning) || (is_known && map.midlevel != Vec3f{}))
        return;
    const std::string means = fmt::format("({:.3f}, {:.3f}, {:.3f})", statistics.channels[0].mean,
                                          statistics.channels[1].mean, statistics.channels[2].mean);
    if (is_known)
        add_note(findings, "I-NONEG",
                 "floats, none negative, around {}, which move the whole surface with the midlevel of 0 that "
                 "was said; if 0.5 stands for zero, say encoding signed, or midlevel 0.5",
                 means);
    else
        add_error(findings, "E-NONEG",
                  "floats, none negative, around {}: 0.5 probably stands for zero here, and read as they are "
                  "they would move the whole surface by that; say encoding signed, or midlevel 0.5 (midlevel "
                  "0 if they are meant as they are)",
                  means);
}

void find_type_mistakes(const Displacement& map, MapMeaning meaning, const MapStatistics& statistics,
                        std::vector<Finding>& findings) {
    if (statistics.type == SampleType::uint8 && !map.dequantize)
        add_warning(findings, "W-8BIT",
                    "8-bit map: one step is {:.3g} scene units at scale {:g}, which shows as stairs; export "
                    "16 or 32 bit float EXR, or smooth them by dequantize under filter cubic",
                    get_largest_scale(map) / 255, get_largest_scale(map));
    const bool is_wide = statistics.type == SampleType::uint16 || statistics.type == SampleType::uint32;
    if (is_wide && !knows_midlevel(map, meaning))
        add_warning(findings, "W-INT16",
                    "integer map without a midlevel, which cannot hold negative values: 0.5 is assumed, "
                    "values are in [{:.4g}, {:.4g}]; say midlevel and scale, or export float",
                    find_low(statistics), find_high(statistics));
    find_unsigned(map, meaning, statistics, findings);
    if (statistics.colour_tag == kRenderedTag)
        add_warning(findings, "W-PICTURE",
                    "a picture that Relief rendered, not a map: it is seen by oiiotool "
                    "or a viewer of EXR, and compared by relief compare");
    else if (!statistics.colour_tag.empty() && statistics.colour_tag != kLinearTag)
        add_warning(findings, "W-SRGB",
                    "the file calls its values colours ({}); they are read raw, but the program that wrote "
                    "it may have converted them: export as data (Non-Color, Raw, linear)",
                    statistics.colour_tag);
}

void find_channel_mistakes(const Displacement& map, MapMeaning meaning, const MapStatistics& statistics,
                           std::vector<Finding>& findings) {
    constexpr double kNormalShare = 0.9;
    const auto is_flat = [](const ChannelStatistics& channel) { return channel.low == channel.high; };
    const auto* first = statistics.channels.data();
    if (statistics.bad_count == 0 && std::all_of(first, first + statistics.used_channels(), is_flat)) {
        add_warning(
            findings, "W-EMPTY",
            "every texel holds the same value ({:g} in R): the map has no detail; bake or export it again",
            statistics.channels[0].mean);
        return;
    }
    if (is_height(map, meaning)) return;
    if (statistics.channel_count < 3)
        add_warning(findings, "W-1CH", "{}: a height map, not vectors; use type height",
                    statistics.channel_count == 1 ? "one channel" : "two channels");
    else if (statistics.is_gray && statistics.bad_count < statistics.texel_count)
        add_warning(findings, "W-GRAY",
                    "R = G = B everywhere: a height map saved as colours, not vectors; use type height (as "
                    "vectors it would move along (1, 1, 1))");
    else if (statistics.normal_share > kNormalShare && statistics.channels[2].mean > 0.5)
        add_warning(findings, "W-NORMALMAP",
                    "unit vectors with B up: a normal map, not displacement; bake vector displacement");
}

void find_outlier(const Displacement& map, const MapStatistics& statistics, std::vector<Finding>& findings) {
    constexpr double kFarOut = 4;
    if (!(statistics.usual_largest > 0) || statistics.largest <= kFarOut * statistics.usual_largest) return;
    add_warning(findings, "W-OUTLIER",
                "the texel at {} is {:.3g} long, {:.1f} x as long as all but a few others: probably a fault "
                "of the baker; paint over it",
                describe_place(statistics.largest_place, map), statistics.largest,
                statistics.largest / statistics.usual_largest);
}

void find_background(const Displacement& map, MapMeaning meaning, const MapStatistics& statistics,
                     std::vector<Finding>& findings) {
    constexpr double kTolerance = 0.01;
    if (!statistics.has_background || statistics.channel_count < 3 || statistics.is_gray ||
        is_height(map, meaning))
        return;
    if (statistics.is_centred_at_half && knows_midlevel(map, meaning) && map.midlevel == Vec3f{})
        return; // find_unsigned tells of that offset
    const double step = statistics.type == SampleType::uint8    ? 1.0 / 255
                        : statistics.type == SampleType::uint16 ? 1.0 / 65535
                                                                : 0;
    double offset = 0;
    std::array<double, 3> offsets{};
    for (size_t c = 0; c < 3; ++c) {
        offsets[c] = statistics.background[c] - statistics.midlevel[c];
        offset = std::max(offset, std::fabs(offsets[c]));
    }
    // A map that is nothing but its background has no other length to be compared with.
    if (offset <= std::max(kTolerance * statistics.largest, step)) return;
    const auto most = std::max_element(offsets.begin(), offsets.end(),
                                       [](double a, double b) { return std::fabs(a) < std::fabs(b); });
    add_warning(findings, "W-BORDER",
                "constant offset: the edges of the map hold ({:.4g}, {:.4g}, {:.4g}) in place of {:g}, most "
                "in {}; say this as midlevel, or clear the background in the sculpting tool",
                statistics.background[0], statistics.background[1], statistics.background[2],
                statistics.midlevel[0], kChannelNames[size_t(most - offsets.begin())]);
}

/// Median number of texels that a face has, of the first tile's size; 0 without uvs.
double measure_texels_a_face(const Displacement& map, const Mesh& mesh) {
    std::vector<double> areas;
    size_t first = 0;
    for (const uint32_t size : mesh.face_sizes) {
        if (mesh.uv_indices[first] != kNoIndex)
            areas.push_back(std::fabs(compute_uv_area(mesh, first, size)));
        first += size;
    }
    if (areas.empty()) return 0;
    const auto middle = areas.begin() + ptrdiff_t(areas.size() / 2);
    std::nth_element(areas.begin(), middle, areas.end());
    const Texture& texture = *map.tiles.front().texture;
    return *middle * double(texture.width) * double(texture.height);
}

} // namespace

bool has_all_textures(const Displacement& map) {
    return !map.tiles.empty() && std::all_of(map.tiles.begin(), map.tiles.end(), [](const MapTile& tile) {
        return tile.texture && tile.texture->width > 0 && tile.texture->height > 0;
    });
}

bool knows_midlevel(const Displacement& map, MapMeaning meaning) {
    return meaning == MapMeaning::declared && (map.has_midlevel || map.midlevel != Vec3f{});
}

std::optional<Vec3f> find_known_midlevel(const Displacement& map, MapMeaning meaning) {
    return knows_midlevel(map, meaning) ? std::optional(map.midlevel) : std::nullopt;
}

std::string describe_place(const TexelPlace& place, const Displacement& map) {
    return fmt::format("column {}, row {}{}", place.x, place.y,
                       map.is_udim ? fmt::format(", tile {}", place.udim) : std::string());
}

void find_map_mistakes(const Displacement& map, MapMeaning meaning, const MapStatistics& statistics,
                       std::vector<Finding>& findings) {
    find_bad_texels(map, statistics, findings);
    find_far_texels(map, statistics, findings);
    find_type_mistakes(map, meaning, statistics, findings);
    find_channel_mistakes(map, meaning, statistics, findings);
    find_outlier(map, statistics, findings);
    find_background(map, meaning, statistics, findings);
}

void find_misfits(const Displacement& map, const MapStatistics& statistics, const Mesh& mesh,
                  std::vector<Finding>& findings) {
    constexpr double kTooLong = 2, kTooShort = 1e-5, kFinestSide = 1 << kMaxLevel;
    Box box;
    for (const Vec3f& position : mesh.positions) box.extend(position);
    const double diagonal = mesh.positions.empty() ? 0 : double(length(box.extent()));
    const double longest = statistics.largest * get_largest_scale(map);
    const bool is_relative = map.lengths == FrameLengths::relative && map.type == DisplacementType::vector &&
                             map.space == DisplacementSpace::tangent;
    if (!is_relative && diagonal > 0 && longest > 0 &&
        (longest > kTooLong * diagonal || longest < kTooShort * diagonal))
        add_warning(
            findings, "W-SCALE",
            "the longest displacement is {:.3g} scene units, {:.3g} x the diagonal of the mesh ({:.3g}): "
            "probably another unit (cm, m) or a factor of the sculpting program; set displacement.scale",
            longest, longest / diagonal, diagonal);
    const double texels = measure_texels_a_face(map, mesh);
    if (texels > 0 && texels < 1)
        add_warning(findings, "W-LEVEL",
                    "a face of the mesh has {:.2g} texels: the mesh is finer than its map; use the level "
                    "that the map was baked against, or a larger map",
                    texels);
    if (texels > kFinestSide * kFinestSide)
        add_warning(findings, "W-LEVEL",
                    "a face of the mesh has {:.3g} texels, more than the finest level can show ({} a side); "
                    "subdivide the mesh or use a smaller map",
                    texels, kFinestSide);
}

std::string advise_axes(const MapConvention& convention, DisplacementSpace space) {
    const std::string axes = format_map_axes(convention.axes.value, space);
    if (convention.is_order_clear) return fmt::format("write displacement.axes = {}", axes);
    // No order to write: the values do not tell t from b.
    const AxisMap& value = convention.axes.value;
    const size_t third = size_t(std::find(value.axis.begin(), value.axis.end(), 2) - value.axis.begin());
    const std::string presets = list_presets(value);
    return fmt::format(
        "set displacement.axes to an order with {} along {}n: the values do not show which of the other "
        "two is along t{}",
        kChannelNames[third], value.sign[third] < 0 ? "-" : "",
        presets.empty() ? "" : fmt::format(" (presets {} write {})", presets, axes));
}

void note_convention(const Displacement& map, MapMeaning meaning, const MapConvention& convention,
                     std::vector<Finding>& findings) {
    if (meaning != MapMeaning::declared || is_height(map, meaning)) return;
    const bool is_other_space = convention.space.is_clear && convention.space.value != map.space &&
                                map.space != DisplacementSpace::world;
    if (is_other_space)
        add_note(findings, "I-SPACE", "{} as {} space, but looks like {} space: {}",
                 map.assumed.space ? "assumed" : "declared",
                 map.space == DisplacementSpace::tangent ? "tangent" : "object",
                 map.space == DisplacementSpace::tangent ? "object" : "tangent", convention.space.reason);
    if (is_other_space || !convention.axes.is_clear || map.space == DisplacementSpace::world) return;
    if (!agrees_on_axes(convention, map))
        add_note(findings, "I-AXES", "the {} axes are not what the values look like: {}; {}",
                 map.assumed.axes ? "assumed" : "declared", convention.axes.reason,
                 advise_axes(convention, map.space));
}

} // namespace relief
