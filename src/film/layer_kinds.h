// The layers that a film can have: where each comes from, and its channels.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "film/film.h"
#include "image/cryptomatte.h"
#include "relief/denoise.h"

namespace relief {

enum class LayerSource {
    depth,
    shading_normal,
    camera_normal,
    geometric_normal,
    position,
    albedo,
    uv,
    id,
    samples,
    variance,
    cost,
    shadow,
    motion,
    guide,
    direct,
    light_kind,
    light_group,
    objects,
    materials
};

struct LayerKind {
    const char* name;
    LayerSource source;
    std::array<const char*, 3>
        suffixes;     ///< of its channels; empty strings beyond the last one, and of mattes
    size_t sum_count; ///< sums a pixel that it needs
};

constexpr LayerKind make_light_kind(size_t kind) {
    return {kLightKinds[kind], LayerSource::light_kind, {"R", "G", "B"}, 3};
}

// In the order in which the layers stand in a picture. docs/adding.md lists all that a layer takes.
inline constexpr std::array<LayerKind, 27> kLayerKinds{{
    {"depth", LayerSource::depth, {"Z", "", ""}, 0},
    {"N", LayerSource::shading_normal, {"X", "Y", "Z"}, 3},
    {"N_camera", LayerSource::camera_normal, {"X", "Y", "Z"}, 3},
    {"Ng", LayerSource::geometric_normal, {"X", "Y", "Z"}, 3},
    {"P", LayerSource::position, {"X", "Y", "Z"}, 3},
    {"albedo", LayerSource::albedo, {"R", "G", "B"}, 3},
    {"uv", LayerSource::uv, {"X", "Y", ""}, 2},
    {"id", LayerSource::id, {"I", "", ""}, 0},
    {"samples", LayerSource::samples, {"Y", "", ""}, 0},
    {"variance", LayerSource::variance, {"R", "G", "B"}, 3},
    {"cost", LayerSource::cost, {"Y", "", ""}, 1},
    {"shadow", LayerSource::shadow, {"C", "L", "U"}, 3},
    {kMotionLayer, LayerSource::motion, {"X", "Y", ""}, 0},
    {kDenoiserGuides[0], LayerSource::guide, {"R", "G", "B"}, 3},
    {kDenoiserGuides[1], LayerSource::guide, {"X", "Y", "Z"}, 3},
    {kDirectLayer, LayerSource::direct, {"R", "G", "B"}, 3},
    make_light_kind(0),
    make_light_kind(1),
    make_light_kind(2),
    make_light_kind(3),
    make_light_kind(4),
    make_light_kind(5),
    make_light_kind(6),
    make_light_kind(7),
    {"light_GROUP", LayerSource::light_group, {"R", "G", "B"}, 3}, // one for each group
    {kObjectMattes, LayerSource::objects, {"", "", ""}, 0},
    {kMaterialMattes, LayerSource::materials, {"", "", ""}, 0},
}};

static_assert(kLightKinds.size() == 8);

/// Of the samples that hit; other means are of all samples.
inline bool is_mean_of_hits(LayerSource source) {
    return source == LayerSource::position || source == LayerSource::uv;
}

/// Whether Film::add_lights brings it.
inline bool is_of_paths(LayerSource source) {
    return source == LayerSource::guide || source == LayerSource::direct ||
           source == LayerSource::light_kind || source == LayerSource::light_group;
}

inline bool is_matte(LayerSource source) {
    return source == LayerSource::objects || source == LayerSource::materials;
}

inline size_t channel_count(const LayerKind& kind) {
    if (is_matte(kind.source)) return 2 * kMatteRanks;
    return size_t(std::ranges::count_if(kind.suffixes, [](const char* s) { return *s != 0; }));
}

} // namespace relief
