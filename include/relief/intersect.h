// Relief as an intersector for other programs: rays in, hits on displaced geometry out.
#pragma once

#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "relief/render.h"
#include "relief/scene.h"

namespace relief {

struct Ray {
    Vec3f origin{};
    float t_min = 0;
    Vec3f direction{}; ///< need not have unit length; t counts in its lengths
    float t_max = std::numeric_limits<float>::infinity();
};

/// 32 bytes without padding.
struct RayHit {
    float t = std::numeric_limits<float>::infinity(); ///< infinity: nothing hit
    uint32_t object = kNoIndex;                       ///< index into Scene::objects
    uint32_t patch = kNoIndex;                        ///< face of the object's mesh after refinement to quads
    Vec2f uv{};                                       ///< position on the patch, [0, 1]^2
    Vec3f normal{}; ///< geometric, world space, unit length, on the side of the winding
};
static_assert(sizeof(RayHit) == 32);

/// What can be computed of a hit beside its RayHit; bits of RayQuery::attributes.
enum HitAttribute : uint32_t { kShadingNormal = 1, kTextureUv = 2, kDerivatives = 4 };

/// World space; zero where nothing is hit, and what the query does not name.
struct HitAttributes {
    Vec3f shading_normal{}; ///< unit length, on the side of RayHit::normal
    Vec3f dp_du{}, dp_dv{}; ///< of the micro-triangle at the hit, by RayHit::uv
    Vec2f texture_uv{};     ///< of the mesh, within its tile of a UDIM map; (0, 0) without
};

/// What a call asks of all of its rays.
struct RayQuery {
    uint32_t visibility_mask = kVisibleToAll; ///< meets objects whose Object::visibility_mask shares a bit
    uint32_t attributes = 0;                  ///< of HitAttribute, joined by |
};

/// The parts of RenderSettings that decide what rays meet and who finds it.
struct IntersectorSettings {
    SurfaceSettings surface;
    DeviceSettings device;
    ExperimentSettings experiment;
    int picture_height = 720; ///< pixels that the scene's camera sees; decides automatic levels
};

/// A scene made ready for rays. All calls are thread safe and use up to `device.threads` threads; they may
/// throw Error (out_of_memory, device_missing). A ray of which something but t_max is infinite or NaN hits
/// nothing.
class Intersector {
  public:
    /// Throws Error: usage for settings out of range, bad_input, device_missing, out_of_memory.
    Intersector(Scene scene, const IntersectorSettings& settings);
    ~Intersector();
    Intersector(Intersector&&) noexcept;
    Intersector& operator=(Intersector&&) noexcept;

    /// Nearest hits with t in (t_min, t_max]. `rays` and `hits` have equal length, `attributes` as well if
    /// the query names any, else none; Error{usage} otherwise. Attributes are those at the levels of the
    /// scene's objects, also with LodRule::ray.
    void closest_hits(std::span<const Ray> rays, std::span<RayHit> hits, const RayQuery& query = {},
                      std::span<HitAttributes> attributes = {}) const;

    /// hits[i] = 1 where anything lies in (t_min, t_max], else 0. Spans of equal length, else Error{usage}.
    void any_hits(std::span<const Ray> rays, std::span<uint8_t> hits,
                  uint32_t visibility_mask = kVisibleToAll) const;

    /// The same of one ray, on the calling thread where the CPU engine answers. Spans are faster.
    RayHit closest_hit(const Ray& ray, uint32_t visibility_mask = kVisibleToAll) const;
    bool any_hit(const Ray& ray, uint32_t visibility_mask = kVisibleToAll) const;

    /// What the scene was warned of when it was read and prepared.
    const std::vector<std::string>& warnings() const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

} // namespace relief
