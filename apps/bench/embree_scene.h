// A triangle mesh in Embree 3, on one thread.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "relief/scene.h"
#include "relief/triangle_probe.h"

namespace relief::bench {

enum class EmbreeMode { fast, robust };

struct EmbreeRun {
    double seconds = 0;
    std::vector<TriangleHit> hits;
    std::vector<Vec3f> normals; ///< of the triangles hit, not of unit length
};

class EmbreeScene {
  public:
    /// Build quality medium; throws Error where Embree refuses.
    EmbreeScene(const Mesh& mesh, EmbreeMode mode);
    ~EmbreeScene();

    double build_s() const;
    /// rtcIntersect1 on each ray.
    EmbreeRun trace(std::span<const Ray> rays) const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

} // namespace relief::bench
