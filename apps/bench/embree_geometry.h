// The probe's surface as Embree geometries.
#pragma once

#include <cstdint>

#include "bench/embree_scene.h"

// As in embree3/rtcore.h, so that this header compiles without Embree.
typedef struct RTCDeviceTy* RTCDevice;
typedef struct RTCGeometryTy* RTCGeometry;

namespace relief::bench {

/// Buffers of a triangle geometry, owned by Embree.
struct EmbreeTriangles {
    const Vec3f* vertices = nullptr;
    const uint32_t* indices = nullptr;
    uint32_t count = 0;
};

/// User data of Embree's displacement callback.
struct DisplacedPatches {
    const TracerProbe* probe = nullptr;
    uint64_t serial = 0; ///< unique per scene in this process
};

RTCGeometry make_triangle_geometry(RTCDevice device, const Mesh& mesh, EmbreeTriangles& triangles);
RTCGeometry make_plain_geometry(RTCDevice device, const TracerProbe& probe, EmbreeTriangles& triangles);
RTCGeometry make_micro_triangles(RTCDevice device, const TracerProbe& probe, int threads,
                                 EmbreeTriangles& triangles);
RTCGeometry make_grids(RTCDevice device, const TracerProbe& probe, int threads);
/// `patches` must outlive the geometry at a fixed address.
RTCGeometry make_subdivision(RTCDevice device, const DisplacedPatches& patches);

} // namespace relief::bench
