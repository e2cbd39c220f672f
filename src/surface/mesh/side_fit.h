// The fitted curve of an edge between two quads: one per edge, so that patches on both sides have the same.
#pragma once

#include <array>
#include <cstdint>

#include "math/vec.h"
#include "math/vec_double.h"
#include "relief/scene.h"

namespace relief {

/// Samples of a side that is fitted to uvs.
inline constexpr size_t kSideSamples = 3;
inline double place_of_side_sample(size_t k) { return double(k + 1) / (kSideSamples + 1); }

struct SideFit {
    uint32_t first_point = kNoIndex;           ///< the end of the edge that the curve begins at
    std::array<Vec2f, 2> uvs{};                ///< at both ends, of the quad that it was fitted for
    std::array<Vec3d, 2> inner{};              ///< control points between the ends
    double off = 0;                            ///< largest distance of the limit surface from the curve
    Vec2<double> uv_error{};                   ///< how far uvs are off at most, per coordinate
    std::array<double, kSideSamples> places{}; ///< where the samples are on the edge of the cage, in [0, 1]
    bool follows_uvs = false;                  ///< not the curve with the parameters of the face
};

} // namespace relief
