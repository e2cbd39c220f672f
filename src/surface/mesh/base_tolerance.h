// How far the base of a subdivided mesh may be from its limit surface.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace relief {

/// The largest distance allowed, in units of the mesh: a power of the square root of two, so that views which
/// differ little need the same base.
struct BaseTolerance {
    int exponent = 0;             ///< of that power, for all faces
    std::vector<int8_t> of_faces; ///< instead, one exponent per face of the mesh; or empty

    /// The tolerance of a face of the mesh.
    double of_face(uint32_t source_face) const {
        return std::exp2(0.5 * (of_faces.empty() ? exponent : of_faces[source_face]));
    }
    friend bool operator==(const BaseTolerance&, const BaseTolerance&) = default;
};

/// For which other tolerances a base would come out the same.
struct BaseReserve {
    int spare_steps = 0; ///< by how much the exponents of its tolerance can be lowered
    bool is_cut = true;  ///< faces were cut: where and how depends on the tolerance
};

/// Whether a base made with tolerance `then` is the one that `now` asks for.
bool is_same_base(const BaseTolerance& then, const BaseTolerance& now, const BaseReserve& reserve);

/// Exponent of the largest such power that is at most `distance`, within what BaseTolerance can hold.
inline int find_tolerance_exponent(double distance) {
    constexpr int kMost = 120;
    if (!(distance > std::exp2(-0.5 * kMost))) return -kMost;
    if (distance > std::exp2(0.5 * kMost)) return kMost;
    return int(std::floor(2 * std::log2(distance)));
}

} // namespace relief
