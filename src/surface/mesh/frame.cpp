// Packs frames; formulas/frame.h unpacks them.
#include <algorithm>
#include <cmath>

#include "formulas/frame.h"
#include "surface/patch/surface.h"

namespace relief {

namespace {

uint32_t quantize(float value, float scale, uint32_t mask) {
    return uint32_t(int32_t(std::lround(std::clamp(value, -1.0f, 1.0f) * scale))) & mask;
}

Vec2f fold(const Vec3f& unit) {
    const float sum = std::fabs(unit.x) + std::fabs(unit.y) + std::fabs(unit.z);
    if (!(sum > 0)) return {};
    const float x = unit.x / sum, y = unit.y / sum;
    if (unit.z >= 0) return {x, y};
    return {std::copysign(1 - std::fabs(y), x), std::copysign(1 - std::fabs(x), y)};
}

} // namespace

PackedFrame pack_frame(const Vec3f& normal, const Vec3f& tangent, float handedness) {
    const Vec2f n = fold(normal), t = fold(tangent);
    PackedFrame packed;
    packed.normal = quantize(n.x, scalar::kFineUnit, 0xffffu) | quantize(n.y, scalar::kFineUnit, 0xffffu)
                                                                    << 16;
    packed.tangent =
        quantize(t.x, scalar::kCoarseUnit, 0x7fffu) << 1 | quantize(t.y, scalar::kFineUnit, 0xffffu) << 16;
    if (handedness < 0) packed.tangent |= 1u;
    return packed;
}

Vec3f unpack_normal(const PackedFrame& packed) { return scalar::unpack_unit_normal(packed.normal); }

Frame unpack_frame(const PackedFrame& packed) {
    const scalar::TangentFrame frame = scalar::unpack_tangent_frame(packed.normal, packed.tangent);
    return {frame.t, frame.b, frame.n};
}

} // namespace relief
