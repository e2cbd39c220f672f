// Surfaces in Embree 3: bare triangles, and what Relief traces in Embree's three ways.
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

/// triangles: the micro-triangles, made beforehand; grid: RTC_GEOMETRY_TYPE_GRID over the same vertices;
/// subdivision: RTC_GEOMETRY_TYPE_SUBDIVISION whose displacement callback gives the same vertices.
enum class EmbreeWay { triangles, grid, subdivision };
enum class EmbreeMode { fast, robust };

/// Which of Embree's calls answers a span of rays: rtcIntersect or rtcOccluded, for 1, 8 or 16 rays.
struct EmbreeQuery {
    HitKind kind = HitKind::closest;
    int width = 1;            ///< 1, 8 or 16
    bool is_coherent = false; ///< told to Embree: neighbours start together and go the same way
    int threads = 0;          ///< 0: those of the scene
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
    /// Bare triangles on one thread. Build quality medium; throws Error where Embree refuses.
    EmbreeScene(const Mesh& mesh, EmbreeMode mode);
    /// The probe's surface with `threads` threads, world space, every displaced patch at its level. Where the
    /// diagonal of a cell is Embree's choice, patches are handed over mirrored, so that it is the one that
    /// Relief has. The probe must outlive the scene.
    EmbreeScene(const TracerProbe& probe, EmbreeWay way, int threads);
    ~EmbreeScene();
    EmbreeScene(EmbreeScene&&) noexcept;
    EmbreeScene& operator=(EmbreeScene&&) noexcept;

    /// Evaluating all vertices and writing them and the indices into Embree's buffers; 0 for subdivision,
    /// which evaluates while it builds.
    double tessellate_s() const;
    double build_s() const;
    /// What Embree and the buffers in its hands hold, by its own count.
    uint64_t byte_count() const;

    /// `room`: of an earlier run, its memory is used again.
    EmbreeRun trace(std::span<const Ray> rays, const EmbreeQuery& query, EmbreeRun room = {}) const;

    /// Corners of a micro-triangle; of scenes of triangles alone.
    std::array<Vec3f, 3> find_corners(uint32_t primitive) const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

} // namespace relief::bench
