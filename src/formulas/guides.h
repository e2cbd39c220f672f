// Guides of a denoiser: albedo and normal of the first vertex of a path that is neither a mirror nor clear
// glass, so that what is seen in these or through them keeps its edges.
#ifndef RELIEF_GUIDES_H
#define RELIEF_GUIDES_H
#include "formulas/path.h"

#include "formulas/begin.h"

/// Surfaces that are rougher blur what is behind them, and each sample sees another place: their own guides
/// say more.
const float kMirrorRoughness = 0.1f;
/// Of others, less than this is metal: most of what they send on is diffuse.
const float kMirrorMetallic = 0.75f;

/// A vertex, once it is drawn whether it is glass.
struct GuideVertex {
    Vec3 base_color, emission;
    float roughness; ///< under a coat, as that blurs it
    float metallic;
    bool is_glass;
};

/// The path goes on for its guides.
FN bool is_mirror(const GuideVertex v) {
    return v.roughness < kMirrorRoughness && (v.is_glass || v.metallic > kMirrorMetallic);
}

/// `throughput` of the path up to what has the colour; in [0, 1].
FN Vec3 find_guide_albedo(const Vec3 throughput, const Vec3 color) {
    Vec3 seen = limit_color(color);
    Vec3 albedo = {throughput.x * seen.x, throughput.y * seen.y, throughput.z * seen.z};
    return limit_color(albedo);
}

/// Glass is white: its colours are in the throughput of what goes through.
FN Vec3 find_guide_color(const GuideVertex v) {
    Vec3 white = {1.0f, 1.0f, 1.0f};
    if (v.is_glass) return white;
    return v.base_color + v.emission;
}

#include "formulas/end.h"
#endif
