// First camera hits by rasterisation: every cell is drawn as a conservative rectangle of pixels whose rays
// are tested, bit-identical to the tracer's (docs/decisions/hybrid-by-exact-raster.md).
#pragma once

#include <cstdint>
#include <vector>

#include "vulkan/device/kernel.h"
#include "vulkan/layout/device_paths.h"
#include "vulkan/layout/device_raster.h"
#include "vulkan/tracer.h"

namespace relief::vulkan {

/// Buffers that are unused while first hits are found; their size limits a wave of surface.
struct RasterBuffers {
    Buffer* vertices; ///< at least kLeastVertexBytes
    Buffer* items;    ///< at least kLeastItemBytes

    /// Two vertex rows of a patch of the finest level.
    static constexpr uint64_t kLeastVertexBytes = 2 * ((uint64_t(1) << kMaxLevel) + 1) * sizeof(Vec3f);
    static constexpr uint64_t kNearestBytes = sizeof(uint64_t); ///< per path, bound as kBindRasterNearest
    static constexpr uint64_t kLeastItemBytes = uint64_t(64) * sizeof(scalar::RasterItem);
};

/// Not thread safe; all calls are synchronous.
class Rasteriser {
  public:
    /// Its buffers must be bound as kBindRasterVertices etc. and outlive it; RenderMethod::hybrid only.
    Rasteriser(Tracer& tracer, const RasterBuffers& buffers);

    /// Finds the hits of the camera kernel's rays, into kBindHits. A pinhole; at most max_draw_size() a side.
    CastStatistics first_hits(const scalar::CameraPush& camera);

  private:
    /// Start of a wave in the order of (instance, patch, row).
    struct Cursor {
        uint32_t instance = 0, patch = 0, row = 0;
    };
    struct Wave {
        std::vector<scalar::RasterItem> items;
        uint32_t vertex_count = 0, cell_count = 0;
    };
    Wave take_wave(Cursor& cursor) const;
    bool append_item(Cursor& cursor, Wave& wave) const;
    void draw_wave(const Wave& wave, scalar::RasterPush push);

    Tracer& tracer_;
    RasterBuffers buffers_;
    Kernel start_, vertices_, cells_, resolve_;
};

} // namespace relief::vulkan
