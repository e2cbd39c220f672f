// Surfaces in Embree 3: plain triangle meshes, and Relief's displaced surfaces in Embree's three
// representations.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "lab/tracer_probe.h"
#include "lab/trees.h"
#include "relief/scene.h"

namespace relief::bench {

/// triangles: the pre-tessellated micro-triangles; grid: RTC_GEOMETRY_TYPE_GRID over the same vertices;
/// subdivision: RTC_GEOMETRY_TYPE_SUBDIVISION whose displacement callback returns the same vertices.
enum class EmbreeWay { triangles, grid, subdivision };
enum class EmbreeMode { fast, robust };

/// Embree call used for a span of rays: rtcIntersect or rtcOccluded for 1, 8 or 16 rays.
struct EmbreeQuery {
    HitKind kind = HitKind::closest;
    int width = 1;            ///< 1, 8 or 16
    bool is_coherent = false; ///< Embree's coherence flag
    int threads = 0;          ///< 0: as for the scene
};

struct EmbreeRun {
    double seconds = 0; ///< from rays in memory to hits in memory
    uint64_t hit_count = 0;
    std::vector<TreeHit>
        hits; ///< of closest hits; primitives of displaced patches first, then plain triangles
    std::vector<uint8_t> occluded; ///< of any hits
};

/// Version of the library that runs.
std::string embree_version();

class EmbreeScene {
  public:
    /// A plain triangle mesh on one thread, build quality medium. Throws Error on Embree errors.
    EmbreeScene(const Mesh& mesh, EmbreeMode mode);
    /// The probe's surface with `threads` threads, world space, every displaced patch at its level. Where
    /// Embree determines the diagonal of a cell, patches are mirrored so that it matches Relief's. The probe
    /// must outlive the scene.
    EmbreeScene(const TracerProbe& probe, EmbreeWay way, int threads);
    ~EmbreeScene();
    EmbreeScene(EmbreeScene&&) noexcept;
    EmbreeScene& operator=(EmbreeScene&&) noexcept;

    /// Seconds to evaluate all vertices and fill Embree's buffers; 0 for subdivision, which evaluates during
    /// the build.
    double tessellate_s() const;
    double build_s() const;
    /// Bytes held by Embree, its buffers included, as it reports.
    uint64_t byte_count() const;

    /// `room`: result of an earlier run whose memory is reused.
    EmbreeRun trace(std::span<const Ray> rays, const EmbreeQuery& query, EmbreeRun room = {}) const;

    /// Corners of a micro-triangle; for scenes of triangles only.
    std::array<Vec3f, 3> find_corners(uint32_t primitive) const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

} // namespace relief::bench
