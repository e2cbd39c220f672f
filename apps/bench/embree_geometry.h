// The probe's surface as Embree's geometries.
#pragma once

#include <cstdint>

#include "bench/embree_scene.h"

// As in embree3/rtcore.h, so that this header stands alone where Embree is not installed.
typedef struct RTCDeviceTy* RTCDevice;
typedef struct RTCGeometryTy* RTCGeometry;

namespace relief::bench {

/// Buffers of a triangle geometry, in Embree's hands.
struct EmbreeTriangles {
    const Vec3f* vertices = nullptr;
    const uint32_t* indices = nullptr;
    uint32_t count = 0;
};

/// What Embree's displacement callback is given.
struct DisplacedPatches {
    const TracerProbe* probe = nullptr;
    uint64_t serial = 0; ///< no other scene of this process has it
};

RTCGeometry make_triangle_geometry(RTCDevice device, const Mesh& mesh, EmbreeTriangles& triangles);
RTCGeometry make_plain_geometry(RTCDevice device, const TracerProbe& probe, EmbreeTriangles& triangles);
RTCGeometry make_micro_triangles(RTCDevice device, const TracerProbe& probe, int threads,
                                 EmbreeTriangles& triangles);
RTCGeometry make_grids(RTCDevice device, const TracerProbe& probe, int threads);
/// `patches` must stay where it is as long as the geometry lives.
RTCGeometry make_subdivision(RTCDevice device, const DisplacedPatches& patches);

} // namespace relief::bench
