// Octahedral unit vectors (Cigolle et al. 2014, A Survey of Efficient Representations for Independent Unit
// Vectors).
#include <algorithm>
#include <cmath>

#include "surface/surface.h"

namespace relief {

namespace {

// 0 and +-1 are exact in both precisions, so that frames along the axes come back exactly.
constexpr float kFine = 32767, kCoarse = 16383;

uint32_t quantize(float value, float scale, uint32_t mask) {
    return uint32_t(int32_t(std::lround(std::clamp(value, -1.0f, 1.0f) * scale))) & mask;
}

float dequantize(uint32_t bits, int width, float scale) {
    const int32_t value = int32_t(bits << (32 - width)) >> (32 - width);
    return std::clamp(float(value) / scale, -1.0f, 1.0f);
}

Vec2f fold(const Vec3f& unit) {
    const float sum = std::fabs(unit.x) + std::fabs(unit.y) + std::fabs(unit.z);
    if (!(sum > 0)) return {};
    const float x = unit.x / sum, y = unit.y / sum;
    if (unit.z >= 0) return {x, y};
    return {std::copysign(1 - std::fabs(y), x), std::copysign(1 - std::fabs(x), y)};
}

Vec3f unfold(float x, float y) {
    const float z = 1 - std::fabs(x) - std::fabs(y);
    const float overlap = std::max(-z, 0.0f);
    return normalize(Vec3f{x - std::copysign(overlap, x), y - std::copysign(overlap, y), z});
}

} // namespace

PackedFrame pack_frame(const Vec3f& normal, const Vec3f& tangent, float handedness) {
    const Vec2f n = fold(normal), t = fold(tangent);
    PackedFrame packed;
    packed.normal = quantize(n.x, kFine, 0xffffu) | quantize(n.y, kFine, 0xffffu) << 16;
    packed.tangent = quantize(t.x, kCoarse, 0x7fffu) << 1 | quantize(t.y, kFine, 0xffffu) << 16;
    if (handedness < 0) packed.tangent |= 1u;
    return packed;
}

Vec3f unpack_normal(const PackedFrame& packed) {
    return unfold(dequantize(packed.normal & 0xffffu, 16, kFine), dequantize(packed.normal >> 16, 16, kFine));
}

Frame unpack_frame(const PackedFrame& packed) {
    Frame frame;
    frame.n = unpack_normal(packed);
    const Vec3f t = unfold(dequantize(packed.tangent >> 1 & 0x7fffu, 15, kCoarse),
                           dequantize(packed.tangent >> 16, 16, kFine));
    frame.t = normalize(t - frame.n * dot(frame.n, t));
    const Vec3f b = cross(frame.n, frame.t);
    frame.b = (packed.tangent & 1u) != 0 ? -b : b;
    return frame;
}

} // namespace relief
