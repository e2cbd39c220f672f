#include "bench/embree_geometry.h"

#include <algorithm>
#include <cstring>
#include <span>
#include <vector>

#include <embree3/rtcore.h>

#include "bench/thread_loop.h"
#include "relief/error.h"

namespace relief::bench {

namespace {

constexpr size_t kPatchesAtOnce = 16;

template <class T>
T* make_buffer(RTCGeometry geometry, RTCBufferType type, RTCFormat format, size_t stride, size_t count) {
    void* buffer = rtcSetNewGeometryBuffer(geometry, type, 0, format, stride, count);
    if (!buffer) throw Error(ErrorKind::out_of_memory, {"Embree has no room for a geometry", "", ""});
    return static_cast<T*>(buffer);
}

/// First vertex and first cell of every patch; one entry more than patches.
struct Offsets {
    std::vector<uint64_t> vertex{0}, cell{0};
};

Offsets compute_offsets(const TracerProbe& probe) {
    Offsets offsets;
    for (uint32_t patch = 0; patch < probe.patch_count(); ++patch) {
        const uint64_t side = uint64_t(1) << probe.patch_level(patch);
        offsets.vertex.push_back(offsets.vertex.back() + (side + 1) * (side + 1));
        offsets.cell.push_back(offsets.cell.back() + side * side);
    }
    if (2 * offsets.cell.back() >= kNoIndex || offsets.vertex.back() >= kNoIndex)
        throw Error(ErrorKind::out_of_memory,
                    {"Embree cannot number that many micro-triangles", "", "lower --levels"});
    return offsets;
}

std::span<Vec3f> get_patch_vertices(Vec3f* vertices, const Offsets& offsets, size_t patch) {
    return {vertices + offsets.vertex[patch], vertices + offsets.vertex[patch + 1]};
}

/// The diagonal from 00 to 11, as in Relief.
void write_cells(uint32_t first_vertex, uint32_t side, uint32_t* index) {
    for (uint32_t j = 0; j < side; ++j)
        for (uint32_t i = 0; i < side; ++i) {
            const uint32_t a = first_vertex + j * (side + 1) + i, b = a + 1, d = a + side + 1, c = d + 1;
            for (const uint32_t corner : {a, b, c, a, c, d}) *index++ = corner;
        }
}

/// Vertices of the most recent patch; Embree requests those of a patch in several calls.
struct PatchMemo {
    uint64_t serial = 0;
    uint32_t patch = kNoIndex;
    uint32_t side = 0;
    std::vector<Vec3f> vertices;
};

const PatchMemo& evaluate_patch(const DisplacedPatches& patches, uint32_t patch) {
    thread_local PatchMemo memo;
    if (memo.serial == patches.serial && memo.patch == patch) return memo;
    memo.serial = patches.serial, memo.patch = patch;
    memo.side = 1u << patches.probe->patch_level(patch);
    memo.vertices.resize(size_t(memo.side + 1) * (memo.side + 1));
    patches.probe->evaluate_patch(patch, memo.vertices);
    return memo;
}

void displace(const RTCDisplacementFunctionNArguments* call) {
    const PatchMemo& memo =
        evaluate_patch(*static_cast<const DisplacedPatches*>(call->geometryUserPtr), call->primID);
    const float side = float(memo.side);
    for (unsigned k = 0; k < call->N; ++k) {
        // Mirrored: Embree's u runs from the patch's corner 1 to its corner 0.
        const auto i = size_t((1 - call->u[k]) * side + 0.5f), j = size_t(call->v[k] * side + 0.5f);
        const Vec3f& vertex = memo.vertices[j * (memo.side + 1) + i];
        call->P_x[k] = vertex.x, call->P_y[k] = vertex.y, call->P_z[k] = vertex.z;
    }
}

} // namespace

RTCGeometry make_triangle_geometry(RTCDevice device, const Mesh& mesh, EmbreeTriangles& triangles) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    triangles.count = uint32_t(mesh.face_sizes.size());
    Vec3f* vertices = make_buffer<Vec3f>(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, sizeof(Vec3f),
                                         mesh.positions.size());
    uint32_t* indices = make_buffer<uint32_t>(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3,
                                              3 * sizeof(uint32_t), triangles.count);
    std::memcpy(vertices, mesh.positions.data(), mesh.positions.size() * sizeof(Vec3f));
    std::memcpy(indices, mesh.position_indices.data(), mesh.position_indices.size() * sizeof(uint32_t));
    triangles.vertices = vertices, triangles.indices = indices;
    return geometry;
}

RTCGeometry make_plain_geometry(RTCDevice device, const TracerProbe& probe, EmbreeTriangles& triangles) {
    Mesh mesh;
    for (const std::array<Vec3f, 3>& corners : probe.list_plain_triangles()) {
        mesh.face_sizes.push_back(3);
        for (const Vec3f& corner : corners) {
            mesh.position_indices.push_back(uint32_t(mesh.positions.size()));
            mesh.positions.push_back(corner);
        }
    }
    return mesh.face_sizes.empty() ? nullptr : make_triangle_geometry(device, mesh, triangles);
}

RTCGeometry make_micro_triangles(RTCDevice device, const TracerProbe& probe, int threads,
                                 EmbreeTriangles& triangles) {
    const Offsets offsets = compute_offsets(probe);
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    triangles.count = uint32_t(2 * offsets.cell.back());
    Vec3f* vertices = make_buffer<Vec3f>(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, sizeof(Vec3f),
                                         offsets.vertex.back());
    uint32_t* indices = make_buffer<uint32_t>(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3,
                                              3 * sizeof(uint32_t), triangles.count);
    run_in_ranges(threads, probe.patch_count(), kPatchesAtOnce, [&](size_t begin, size_t end) {
        for (size_t patch = begin; patch < end; ++patch) {
            probe.evaluate_patch(uint32_t(patch), get_patch_vertices(vertices, offsets, patch));
            write_cells(uint32_t(offsets.vertex[patch]), 1u << probe.patch_level(uint32_t(patch)),
                        indices + 6 * offsets.cell[patch]);
        }
    });
    triangles.vertices = vertices, triangles.indices = indices;
    return geometry;
}

RTCGeometry make_grids(RTCDevice device, const TracerProbe& probe, int threads) {
    const Offsets offsets = compute_offsets(probe);
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_GRID);
    Vec3f* vertices = make_buffer<Vec3f>(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, sizeof(Vec3f),
                                         offsets.vertex.back());
    RTCGrid* grids = make_buffer<RTCGrid>(geometry, RTC_BUFFER_TYPE_GRID, RTC_FORMAT_GRID, sizeof(RTCGrid),
                                          probe.patch_count());
    run_in_ranges(threads, probe.patch_count(), kPatchesAtOnce, [&](size_t begin, size_t end) {
        for (size_t patch = begin; patch < end; ++patch) {
            const std::span<Vec3f> room = get_patch_vertices(vertices, offsets, patch);
            const uint32_t edge = (1u << probe.patch_level(uint32_t(patch))) + 1;
            probe.evaluate_patch(uint32_t(patch), room);
            // Embree splits cells from 10 to 01; mirrored rows turn that into Relief's diagonal.
            for (uint32_t j = 0; j < edge; ++j)
                std::reverse(room.begin() + j * edge, room.begin() + (j + 1) * edge);
            grids[patch] = {uint32_t(offsets.vertex[patch]), edge, uint16_t(edge), uint16_t(edge)};
        }
    });
    return geometry;
}

RTCGeometry make_subdivision(RTCDevice device, const DisplacedPatches& patches) {
    const TracerProbe& probe = *patches.probe;
    const size_t count = probe.patch_count();
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_SUBDIVISION);
    Vec3f* vertices =
        make_buffer<Vec3f>(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, sizeof(Vec3f), 4 * count);
    uint32_t* indices =
        make_buffer<uint32_t>(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT, sizeof(uint32_t), 4 * count);
    uint32_t* faces =
        make_buffer<uint32_t>(geometry, RTC_BUFFER_TYPE_FACE, RTC_FORMAT_UINT, sizeof(uint32_t), count);
    float* levels =
        make_buffer<float>(geometry, RTC_BUFFER_TYPE_LEVEL, RTC_FORMAT_FLOAT, sizeof(float), 4 * count);
    for (uint32_t patch = 0; patch < count; ++patch) {
        const float side = float(1u << probe.patch_level(patch));
        faces[patch] = 4;
        // Placeholder quad: the callback sets the positions.
        const Vec3f corners[4] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
        for (uint32_t k = 0; k < 4; ++k) {
            vertices[4 * patch + k] = corners[k];
            indices[4 * patch + k] = 4 * patch + k;
            levels[4 * patch + k] = side;
        }
    }
    rtcSetGeometrySubdivisionMode(geometry, 0, RTC_SUBDIVISION_MODE_PIN_ALL);
    rtcSetGeometryUserData(geometry, const_cast<DisplacedPatches*>(&patches));
    rtcSetGeometryDisplacementFunction(geometry, displace);
    return geometry;
}

} // namespace relief::bench
