#include "analysis/map_convention.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <string_view>

#include <fmt/format.h>

#include "analysis/map_on_mesh.h"
#include "analysis/map_on_plane.h"
#include "relief/error.h"
#include "scene/face_uvs.h"

namespace relief {

namespace {

constexpr std::array<const char*, 3> kChannelNames = {"R", "G", "B"};
constexpr double kClearRatio = 1.5; ///< by how much the best must be ahead of the next
constexpr double kMostLead = 1e9;
constexpr double kOneSided = 0.5; ///< least one-sidedness of a channel along the normal
constexpr double kMostNext =
    0.75; ///< most one-sidedness of the next channel, of that of the channel along the normal

/// The channel along the normal: sculpts rise more than they slide, so its mean is the most one-sided.
struct NormalChannel {
    size_t channel = 2;
    int sign = 1;
    double ratio = 0; ///< of its mean to the next largest one
    bool is_clear = false;
};

NormalChannel find_normal_channel(const MapStatistics& statistics, const Vec3f& scale) {
    std::array<double, 3> strength{scale.x, scale.y, scale.z};
    for (size_t c = 0; c < 3; ++c)
        strength[c] = std::fabs(strength[c] * (statistics.channels[c].mean - statistics.midlevel[c]));
    NormalChannel best;
    best.channel = size_t(std::max_element(strength.begin(), strength.end()) - strength.begin());
    const size_t a = (best.channel + 1) % 3, b = (best.channel + 2) % 3;
    const size_t next_channel = strength[a] > strength[b] ? a : b;
    const double next = strength[next_channel];
    const double one_sided = statistics.channels[best.channel].one_sided;
    // A hook leans to one side as it rises, and may lean further than it rises.
    const bool is_alone =
        std::fabs(statistics.channels[next_channel].one_sided) < kMostNext * std::fabs(one_sided);
    best.sign = one_sided < 0 ? -1 : 1;
    best.ratio = next > 0 ? strength[best.channel] / next : kMostLead;
    best.is_clear = strength[best.channel] > 0 && best.ratio >= kClearRatio &&
                    std::fabs(one_sided) >= kOneSided && is_alone;
    return best;
}

AxisMap make_axes(const NormalChannel& normal, int choice) {
    const size_t first = normal.channel == 0 ? 1 : 0, second = normal.channel == 2 ? 1 : 2;
    AxisMap axes;
    axes.axis[normal.channel] = 2, axes.sign[normal.channel] = int8_t(normal.sign);
    axes.axis[first] = uint8_t(choice & 1), axes.axis[second] = uint8_t(1 - (choice & 1));
    axes.sign[first] = (choice & 2) != 0 ? -1 : 1, axes.sign[second] = (choice & 4) != 0 ? -1 : 1;
    return axes;
}

Vec3f round_midlevel(const MapStatistics& statistics) {
    return {float(statistics.midlevel[0]), float(statistics.midlevel[1]), float(statistics.midlevel[2])};
}

/// Whether the channels beside the normal go along t and b as in a map of the plane onto itself, or as in a
/// mirror.
bool is_mirrored_on_plane(const AxisMap& axes) {
    const size_t third = size_t(std::find(axes.axis.begin(), axes.axis.end(), 2) - axes.axis.begin());
    const size_t first = third == 0 ? 1 : 0, second = third == 2 ? 1 : 2;
    return (axes.axis[first] == 1) != (axes.sign[first] * axes.sign[second] < 0);
}

/// Folds of the surface on a plane, in the four orders of axes that are turns of one another.
struct HandFolds {
    double share = 0, least_share = 1, area = 0; ///< most of the four, least of the four, most of the four
};

/// True if this hand is the right one of two: its surface overhangs clearly more and has clearly more area,
/// and the other hand folds in each of its orders. A sculpt that twists does not fold in the order that it
/// was made in, but does in others. These limits decide 3000 generated maps without a mistake; tests repeat
/// 100 of them.
bool is_clearly_right(const HandFolds& hand, const HandFolds& other) {
    constexpr double kLeastShare = 0.03, kShareAhead = 1.3, kAreaAhead = 1.04, kEven = 0.5;
    return hand.share > kLeastShare && hand.share > kShareAhead * other.share &&
           hand.area > kAreaAhead * other.area && other.least_share > kEven * other.share;
}

/// Along the plane a sculpt overhangs in the hand that it was made in. Turns of t and b by quarters cannot be
/// told: what spreads in one of them twists in the next, and sculpts do either.
void guess_hand_on_plane(const Displacement& map, const NormalChannel& normal, MapConvention& result) {
    std::array<HandFolds, 2> hands;
    for (int choice = 0; choice < 8; ++choice) {
        const AxisMap axes = make_axes(normal, choice);
        const PlaneFolds folds = measure_folds(map, axes);
        HandFolds& hand = hands[is_mirrored_on_plane(axes) ? 1 : 0];
        hand.share = std::max(hand.share, folds.share), hand.area = std::max(hand.area, folds.area);
        hand.least_share = std::min(hand.least_share, folds.share);
    }
    const size_t usual = is_mirrored_on_plane(result.axes.value) ? 1 : 0, other = 1 - usual;
    const bool is_usual = is_clearly_right(hands[usual], hands[other]);
    result.is_hand_clear = is_usual || is_clearly_right(hands[other], hands[usual]);
    if (!result.is_hand_clear) return;
    constexpr int kExchanged = 1;
    if (!is_usual) result.axes.value = make_axes(normal, kExchanged);
    const double share = hands[is_usual ? usual : other].share,
                 mirrored = hands[is_usual ? other : usual].share;
    const char *a = kChannelNames[normal.channel == 0 ? 1 : 0],
               *b = kChannelNames[normal.channel == 2 ? 1 : 2];
    result.axes.reason +=
        is_usual
            ? fmt::format(
                  "; {} and {} have the hand of t and b: the surface overhangs in {:.1f} % of the texels, "
                  "mirrored in {:.1f} %",
                  a, b, 100 * share, 100 * mirrored)
            : fmt::format("; {} and {} look exchanged, or one of them negated: so the surface overhangs in "
                          "{:.1f} % of the texels, else in {:.1f} %",
                          a, b, 100 * share, 100 * mirrored);
}

/// The channel along the normal, or along z.
ptrdiff_t find_third_axis(const AxisMap& axes) {
    return std::find(axes.axis.begin(), axes.axis.end(), 2) - axes.axis.begin();
}

/// The order that programs write for a channel along the normal.
AxisMap make_usual_axes(const NormalChannel& normal) { return make_axes(normal, 0); }

void guess_tangent_axes(const Displacement& map, const MapStatistics& statistics, MapConvention& result) {
    const NormalChannel normal = find_normal_channel(statistics, map.scale);
    result.axes.is_clear = normal.is_clear, result.axes_lead = normal.ratio;
    if (!normal.is_clear) {
        result.axes.reason = "no channel has a mean far more one-sided than the others";
        return;
    }
    result.axes.value = make_usual_axes(normal);
    result.axes.reason = fmt::format(
        "{} is along the normal{}: its mean is {:.1f} x as far from the midlevel as that of the next channel",
        kChannelNames[normal.channel], normal.sign < 0 ? ", backwards" : "", std::min(normal.ratio, 99.0));
    if (!map.is_udim && statistics.bad_count == 0) guess_hand_on_plane(map, normal, result);
}

/// The seams of a mesh close in tangent space for the right order only. They tell which channel is along the
/// normal, not its sign: that is taken from a mean which is far to one side.
void refine_by_seams(const std::vector<SeamSample>& seams, const MapStatistics& statistics,
                     MapConvention& result) {
    std::array<double, 3> gaps{1e9, 1e9, 1e9};
    std::array<AxisMap, 3> best;
    for (size_t channel = 0; channel < 3; ++channel)
        for (int choice = 0; choice < 8; ++choice) {
            NormalChannel normal;
            normal.channel = channel,
            normal.sign = statistics.channels[channel].one_sided < -kOneSided ? -1 : 1;
            const AxisMap axes = make_axes(normal, choice);
            const double gap = measure_tangent_gap(seams, axes);
            // Turned by quarters, t and b close as well: the usual order stays unless another clearly wins.
            if (gap * (choice == 0 ? 1 : kClearRatio) < gaps[channel])
                gaps[channel] = gap, best[channel] = axes;
        }
    const auto channel = size_t(std::min_element(gaps.begin(), gaps.end()) - gaps.begin());
    const double next = std::min(gaps[(channel + 1) % 3], gaps[(channel + 2) % 3]);
    if (!(kClearRatio * gaps[channel] < next)) return;
    if (result.axes.is_clear && result.axes.value.axis[channel] == 2) return; // told already, with its order
    result.axes = {best[channel], true,
                   fmt::format("{} is along the normal: so the uv seams close to {:.0f} % of the movement, "
                               "with another channel to {:.0f} %",
                               kChannelNames[channel], 100 * gaps[channel], 100 * next)};
    result.axes_lead = gaps[channel] > 0 ? next / gaps[channel] : kMostLead;
    result.is_hand_clear = false;
}

/// Object space: the order under which the surface moves most along its normals.
void guess_object_axes(const MapSamples& samples, MapConvention& result) {
    constexpr double kLeastRise = 0.3;
    double best = 0, next = 0;
    for (const AxisMap& axes : get_all_axis_maps()) {
        // The opposite of an order moves in where it moves out: whether a sculpt digs or heaps is not known.
        if (std::count(axes.sign.begin(), axes.sign.end(), int8_t(-1)) > 1) continue;
        const double rise = std::fabs(measure_object_rise(samples.places, axes));
        if (rise > best) {
            next = best, best = rise;
            result.axes.value = axes;
        } else {
            next = std::max(next, rise);
        }
    }
    result.axes.is_clear = result.is_order_clear = best >= kLeastRise && best > kClearRatio * next;
    if (result.axes.is_clear) {
        result.axes.reason = fmt::format(
            "so the surface moves along its normals ({:.2f} of all movement, {:.2f} in the next best order)",
            best, next);
        return;
    }
    result.axes.value = AxisMap{};
    result.axes.reason = "the usual order; the mesh's normals speak for no other";
}

double measure_best_tangent_gap(const std::vector<SeamSample>& seams) {
    double best = 1e9;
    for (const AxisMap& axes : get_all_axis_maps()) best = std::min(best, measure_tangent_gap(seams, axes));
    return best;
}

void guess_space_by_normals(const MapSamples& samples, const MapStatistics& statistics,
                            MapConvention& result) {
    constexpr double kLeast = 0.3;
    double object = 0, tangent = 0;
    for (const AxisMap& axes : get_all_axis_maps())
        object = std::max(object, measure_object_rise(samples.places, axes));
    for (const ChannelStatistics& channel : statistics.channels)
        tangent = std::max(tangent, std::fabs(channel.one_sided));
    if (object >= kLeast && object > kClearRatio * tangent)
        result.space = {DisplacementSpace::object, true,
                        fmt::format("values follow the mesh's normals in object space ({:.2f}), and no "
                                    "channel rises by itself ({:.2f})",
                                    object, tangent)};
    else if (tangent >= kLeast && tangent > kClearRatio * object)
        result.space = {DisplacementSpace::tangent, true,
                        fmt::format("one channel rises by itself ({:.2f}), and values do not follow the "
                                    "mesh's normals in object space ({:.2f})",
                                    tangent, object)};
}

/// Returns the displaced surface, which a subdivided mesh has with one patch per quad: finer ones take many
/// times longer and show no other convention. Returns null if the mesh and the map do not go together; the
/// inspection of the mesh reports why.
std::optional<Surface> try_surface(const Mesh& mesh, const Displacement& map) {
    const bool is_automatic =
        mesh.subdivision.scheme != SubdivisionScheme::none && mesh.subdivision.level == kAutoSubdivisionLevel;
    try {
        if (!is_automatic) return make_surface(mesh, &map, {});
        Mesh coarse = mesh;
        coarse.subdivision.level = 0;
        return make_surface(coarse, &map, {});
    } catch (const Error&) {
        return std::nullopt;
    }
}

/// The UDIM number in the name of an image's file, "head.1002.exr"; 0: none.
int find_tile_number(const Texture& texture) {
    const size_t slash = texture.file.find_last_of('/');
    const std::string_view name =
        std::string_view(texture.file).substr(slash == std::string::npos ? 0 : slash + 1);
    int found = 0;
    for (size_t begin = 0; begin < name.size();) {
        size_t end = begin;
        int number = 0;
        while (end < name.size() && name[end] >= '0' && name[end] <= '9' && end - begin < 5)
            number = 10 * number + (name[end++] - '0');
        if (end - begin == 4 && number >= 1001 && number <= 1999) found = number; // a tile stands last
        begin = std::max(end, begin + 1);
    }
    return found;
}

/// A map of a body whose texels nearly all move to one side along two channels: the whole body moves, in
/// object space. Tangent axes turn from island to island, so only the channel along the normal has a side.
std::optional<Guess<DisplacementSpace>> guess_space_of_tiles(const Displacement& map,
                                                             const MapStatistics& statistics) {
    constexpr double kAllOneSided = 0.9;
    if (!map.is_udim && find_tile_number(*map.tiles.front().texture) == 0) return std::nullopt;
    std::array<size_t, 3> order{0, 1, 2};
    const auto measure = [&](size_t c) {
        return std::fabs(statistics.channels[c].mean - statistics.midlevel[c]);
    };
    std::sort(order.begin(), order.end(), [&](size_t a, size_t b) { return measure(a) > measure(b); });
    const auto is_one_sided = [&](size_t c) {
        return std::fabs(statistics.channels[c].one_sided) >= kAllOneSided;
    };
    if (!is_one_sided(order[0]) || !is_one_sided(order[1]) ||
        measure(order[0]) >= kClearRatio * measure(order[1]))
        return std::nullopt;
    return Guess<DisplacementSpace>{
        DisplacementSpace::object, true,
        fmt::format("{} and {} lie to one side in nearly all texels of this tile, as where a whole body "
                    "moves; in tangent space only the channel along the normal does",
                    kChannelNames[std::min(order[0], order[1])],
                    kChannelNames[std::max(order[0], order[1])])};
}

/// One image on a mesh with several tiles, and not repeated, is the image of one of them.
std::set<int> list_possible_tiles(const Displacement& map, const Mesh& mesh) {
    if (map.is_udim || map.wrap == WrapMode::repeat || map.wrap == WrapMode::mirror) return {};
    std::set<int> tiles = list_tiles(mesh);
    if (const int number = find_tile_number(*map.tiles.front().texture);
        tiles.size() > 1 && tiles.contains(number))
        return {number};
    if (tiles.size() < 2 || tiles.size() > size_t(kMaxMapTiles)) tiles.clear();
    return tiles;
}

/// With the image in each of these tiles: the one whose seams close best, in any space, counts from here on.
std::optional<Guess<DisplacementSpace>> guess_tile_by_seams(const std::set<int>& tiles, MapSamples& samples) {
    std::optional<Guess<DisplacementSpace>> best;
    MapSamples best_samples;
    double smallest = 1e9;
    size_t k = 0;
    for (const int tile : tiles) {
        MapSamples kept = keep_tile(samples, TileIndex(k++));
        std::optional<Guess<DisplacementSpace>> guess = guess_space_by_seams(kept.seams);
        if (!guess) continue;
        const double gap = std::min(measure_object_gap(kept.seams), measure_best_tangent_gap(kept.seams));
        if (gap >= smallest) continue;
        smallest = gap, best_samples = std::move(kept);
        guess->reason = fmt::format("as tile {} of the mesh, {}", tile, guess->reason);
        best = std::move(guess);
    }
    if (best) samples = std::move(best_samples);
    return best;
}

void guess_on_mesh(const Displacement& map, const MapStatistics& statistics, const Mesh& mesh,
                   MapConvention& result) {
    Displacement raw = map;
    raw.type = DisplacementType::vector, raw.space = DisplacementSpace::tangent;
    raw.axes = AxisMap{}, raw.midlevel = round_midlevel(statistics), raw.scale = {1, 1, 1};
    const std::set<int> tiles = list_possible_tiles(map, mesh);
    if (!tiles.empty()) {
        raw.is_udim = true, raw.tiles.clear();
        for (const int tile : tiles) raw.tiles.push_back({tile, map.tiles.front().texture});
    }
    const std::optional<Surface> surface = try_surface(mesh, raw);
    if (!surface) {
        guess_tangent_axes(map, statistics, result);
        return;
    }
    MapSamples samples = sample_map(*surface);
    const std::optional<Guess<DisplacementSpace>> by_seams =
        tiles.empty() ? guess_space_by_seams(samples.seams) : guess_tile_by_seams(tiles, samples);
    result.is_space_by_seams = by_seams.has_value();
    if (by_seams)
        result.space = *by_seams;
    else if (const auto by_tiles = guess_space_of_tiles(map, statistics))
        result.space = *by_tiles;
    else
        guess_space_by_normals(samples, statistics, result);
    if (result.space.value == DisplacementSpace::object) {
        guess_object_axes(samples, result);
        return;
    }
    guess_tangent_axes(map, statistics, result);
    if (by_seams) refine_by_seams(samples.seams, statistics, result);
}

} // namespace

MapConvention guess_convention(const Displacement& map, const MapStatistics& statistics, const Mesh* mesh) {
    if (mesh && find_faces_without_uvs(*mesh).count > 0) {
        const Mesh kept = drop_faces_without_uvs(*mesh);
        return guess_convention(map, statistics, &kept);
    }
    MapConvention result;
    result.space.reason = "not to be seen without a mesh that has seams or bends: give the mesh as well";
    if (statistics.channel_count < 3 || statistics.is_gray || statistics.texel_count == statistics.bad_count)
        return result;
    if (mesh && statistics.bad_count == 0) {
        result.space.reason = "seams and normals of the mesh do not tell";
        guess_on_mesh(map, statistics, *mesh, result);
        return result;
    }
    if (const auto by_tiles = guess_space_of_tiles(map, statistics)) {
        result.space = *by_tiles;
        result.axes.reason = "the usual order; only a mesh could speak for another";
        return result;
    }
    guess_tangent_axes(map, statistics, result);
    return result;
}

bool agrees_on_axes(const MapConvention& convention, const Displacement& map) {
    const AxisMap& axes = convention.axes.value;
    if (convention.is_order_clear) return axes == map.axes;
    const ptrdiff_t third = find_third_axis(axes);
    if (third != find_third_axis(map.axes)) return false;
    if (!convention.is_hand_clear) return true;
    return axes.sign[size_t(third)] == map.axes.sign[size_t(third)] &&
           is_mirrored_on_plane(axes) == is_mirrored_on_plane(map.axes);
}

bool contradicts_axes(const MapConvention& convention, const Displacement& map) {
    constexpr double kCertainLead = 2;
    return convention.axes.is_clear && convention.axes_lead >= kCertainLead &&
           find_third_axis(convention.axes.value) != find_third_axis(map.axes);
}

std::optional<Guess<DisplacementSpace>> guess_space_by_seams(const std::vector<SeamSample>& seams) {
    constexpr size_t kFewest = 32;
    constexpr double kFits = 0.5;
    if (seams.size() < kFewest) return std::nullopt;
    const double object = measure_object_gap(seams), tangent = measure_best_tangent_gap(seams);
    const bool is_object = object < kFits && kClearRatio * object < tangent;
    const bool is_tangent = tangent < kFits && kClearRatio * tangent < object;
    if (!is_object && !is_tangent) return std::nullopt;
    return Guess<DisplacementSpace>{
        is_object ? DisplacementSpace::object : DisplacementSpace::tangent, true,
        fmt::format("both sides of the uv seams differ by {:.0f} % as {} space, by {:.0f} % as {}",
                    100 * std::min(object, tangent), is_object ? "object" : "tangent",
                    100 * std::max(object, tangent), is_object ? "tangent" : "object")};
}

std::optional<double> measure_fold_share(const Displacement& map, const Mesh* mesh) {
    if (mesh) {
        const std::optional<Surface> surface = try_surface(*mesh, map);
        return surface ? std::optional<double>(measure_folded_share(*surface)) : std::nullopt;
    }
    const bool is_flat = map.type == DisplacementType::vector && map.space == DisplacementSpace::tangent;
    return is_flat && !map.is_udim ? std::optional<double>(measure_folds(map, map.axes).share) : std::nullopt;
}

std::string list_presets(const AxisMap& axes) {
    if (axes == AxisMap{}) return "blender-brush, genvdm, 3dcoat";
    if (axes == AxisMap{{0, 2, 1}, {1, 1, 1}}) return "mudbox, maya, cycles, arnold, moonray";
    return {};
}

} // namespace relief
