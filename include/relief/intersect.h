// Relief as an intersector for other programs: rays in, hits on displaced geometry out.
#pragma once

#include <limits>
#include <memory>
#include <span>

#include "relief/render.h"
#include "relief/scene.h"

namespace relief {

struct Ray {
    Vec3f origin{};
    float t_min = 0;
    Vec3f direction{}; ///< need not have unit length; t counts in its lengths
    float t_max = std::numeric_limits<float>::infinity();
};

struct RayHit {
    float t = std::numeric_limits<float>::infinity(); ///< infinity: nothing hit
    uint32_t object = kNoIndex;                       ///< index into Scene::objects
    uint32_t patch = kNoIndex;                        ///< face of the object's mesh after refinement to quads
    Vec2f uv{};                                       ///< position on the patch, [0, 1]^2
    Vec3f normal{}; ///< geometric, world space, unit length, on the side of the winding
};

/// A scene made ready for rays. Levels come from `settings` (level, pixel_error, the scene's camera and
/// height).
class Intersector {
  public:
    /// Throws Error: usage for settings out of range, bad_input, device_missing, out_of_memory.
    Intersector(Scene scene, const RenderSettings& settings);
    ~Intersector();
    Intersector(Intersector&&) noexcept;
    Intersector& operator=(Intersector&&) noexcept;

    /// Nearest hits with t in (t_min, t_max]; spans of equal length. A ray of which something but t_max is
    /// infinite, or no number, hits nothing. Thread safe, uses all of `settings.threads`.
    void closest_hits(std::span<const Ray> rays, std::span<RayHit> hits) const;

    /// hits[i] = 1 where anything lies in (t_min, t_max], else 0. The rest as above.
    void any_hits(std::span<const Ray> rays, std::span<uint8_t> hits) const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

} // namespace relief
