// First hits of camera rays by drawing: every cell of every surface is a rectangle of pixels whose rays are
// tested against it. The hits are those that the tracer finds, bit for bit
// (docs/decisions/hybrid-by-exact-raster.md).
#pragma once

#include <cstdint>
#include <vector>

#include "vulkan/device/kernel.h"
#include "vulkan/layout/device_paths.h"
#include "vulkan/layout/device_raster.h"
#include "vulkan/tracer.h"

namespace relief::vulkan {

/// Memory that holds nothing while first hits are found: a wave of surface is as large as it has room for.
struct RasterBuffers {
    Buffer* vertices; ///< at least kLeastVertexBytes
    Buffer* items;    ///< at least kLeastItemBytes

    /// Two rows of the vertices of a patch of the finest level.
    static constexpr uint64_t kLeastVertexBytes = 2 * ((uint64_t(1) << kMaxLevel) + 1) * sizeof(Vec3f);
    static constexpr uint64_t kNearestBytes = sizeof(uint64_t); ///< a path, bound as kBindRasterNearest
    static constexpr uint64_t kLeastItemBytes = uint64_t(64) * sizeof(scalar::RasterItem);
};

/// One thread at a time. All of it is synchronous.
class Rasteriser {
  public:
    /// The buffers must be bound to the tracer's bindings as kBindRasterVertices and so on; all must outlive
    /// it. The tracer's device must have been made for RenderMethod::hybrid.
    Rasteriser(Tracer& tracer, const RasterBuffers& buffers);

    /// Hits of the rays that the camera kernel has made with these settings, into kBindHits: ray k has hit k.
    /// The window must be at most Device::max_draw_size() pixels a side, and the camera without an aperture.
    CastStatistics first_hits(const scalar::CameraPush& camera);

  private:
    /// Where in the order of (instance, patch, row) a wave begins.
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
