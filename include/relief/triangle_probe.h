// The bare tracer of the CPU engine on one plain triangle mesh, on one thread: for measurements against other
// libraries. What a program uses is relief/intersect.h.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "relief/intersect.h"

namespace relief {

struct TriangleHit {
    float t = std::numeric_limits<float>::infinity(); ///< infinity: nothing hit
    uint32_t triangle = kNoIndex;                     ///< face of the mesh
};

/// Whether neighbours that go the same way may be traced as one packet.
enum class RayGrouping { single, packets };

struct TriangleRun {
    double seconds = 0; ///< of tracing alone
    std::vector<TriangleHit> hits;
};

class TriangleProbe {
  public:
    /// `mesh` consists of triangles. Throws Error: bad_input for anything else or a faulty mesh,
    /// device_missing for an instruction set that the machine lacks.
    TriangleProbe(const Mesh& mesh, Isa isa);
    ~TriangleProbe();

    /// Builds what rays are traced in once more and forgets it; seconds from triangles to the finished tree.
    double measure_build() const;
    TriangleRun trace(std::span<const Ray> rays, RayGrouping grouping) const;
    uint64_t structures_bytes() const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

} // namespace relief
