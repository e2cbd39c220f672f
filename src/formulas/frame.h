// Unit vectors and frames packed as octahedral coordinates.
#ifndef RELIEF_FRAME_H
#define RELIEF_FRAME_H
#include "formulas/exact.h"
#include "formulas/octahedron.h"

#include "formulas/begin.h"

// 0 and +-1 are exact in both precisions, so axis-aligned frames are restored exactly.
const float kFineUnit = 32767.0f;
const float kCoarseUnit = 16383.0f;

/// Signed integer in the lowest `width` bits, divided by `scale`.
FN float dequantize_unit(const uint bits, const uint width, const float scale) {
    EXACT float value = float(int(bits << (32u - width)) >> int(32u - width)) / scale;
    return clamp(value, -1.0f, 1.0f);
}

FN Vec2 unpack_octahedron(const uint packed_normal) {
    Vec2 folded = {dequantize_unit(packed_normal & 0xffffu, 16u, kFineUnit),
                   dequantize_unit(packed_normal >> 16u, 16u, kFineUnit)};
    return folded;
}

FN Vec3 unpack_unit_normal(const uint packed_normal) {
    Vec2 folded = unpack_octahedron(packed_normal);
    return unfold_octahedron(folded.x, folded.y);
}

/// Orthonormal; the bitangent is -cross(n, t) where the lowest bit of `packed_tangent` is set.
struct TangentFrame {
    Vec3 t, b, n;
};

/// The tangent alone, not quite at right angles to the normal.
FN Vec3 unpack_tangent(const uint packed_tangent) {
    return unfold_octahedron(dequantize_unit((packed_tangent >> 1u) & 0x7fffu, 15u, kCoarseUnit),
                             dequantize_unit(packed_tangent >> 16u, 16u, kFineUnit));
}

FN TangentFrame unpack_tangent_frame(const uint packed_normal, const uint packed_tangent) {
    TangentFrame frame;
    frame.n = unpack_unit_normal(packed_normal);
    Vec3 t = unpack_tangent(packed_tangent);
    frame.t = make_unit(subtract_exact(t, scale_exact(frame.n, dot_exact(frame.n, t))));
    Vec3 b = cross_exact(frame.n, frame.t);
    Vec3 turned = {-b.x, -b.y, -b.z};
    frame.b = select((packed_tangent & 1u) != 0u, turned, b);
    return frame;
}

#include "formulas/end.h"
#endif
