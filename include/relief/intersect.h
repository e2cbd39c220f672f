// Ray queries for other programs: rays in, hits on displaced geometry out.
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
    Vec3f direction{}; ///< need not be normalised; t is in units of its length
    float t_max = std::numeric_limits<float>::infinity();
};

/// 32 bytes without padding.
struct RayHit {
    float t = std::numeric_limits<float>::infinity(); ///< infinity: a miss
    uint32_t object = kNoIndex;                       ///< index into Scene::objects
    uint32_t patch = kNoIndex;                        ///< face of the object's mesh after refinement to quads
    Vec2f uv{};                                       ///< position on the patch, [0, 1]^2
    Vec3f normal{}; ///< geometric, world space, unit length, oriented by the winding
};
static_assert(sizeof(RayHit) == 32);

/// Optional attributes of a hit; bits of RayQuery::attributes.
enum HitAttribute : uint32_t { kShadingNormal = 1, kTextureUv = 2, kDerivatives = 4 };

/// World space. Zero for misses and for attributes that were not requested.
struct HitAttributes {
    Vec3f shading_normal{}; ///< unit length, on the side of RayHit::normal
    Vec3f dp_du{}, dp_dv{}; ///< derivatives of the micro-triangle's position by RayHit::uv
    Vec2f texture_uv{};     ///< of the mesh, within its tile of a UDIM map; (0, 0) for a mesh without uvs
};

/// Options shared by all rays of a call.
struct RayQuery {
    uint32_t visibility_mask = kVisibleToAll; ///< hits objects whose Object::visibility_mask shares a bit
    uint32_t attributes = 0;                  ///< HitAttribute bits, combined by |
};

/// The parts of RenderSettings that apply to ray queries.
struct IntersectorSettings {
    SurfaceSettings surface;
    DeviceSettings device;
    ExperimentSettings experiment;
    int picture_height = 720; ///< pixels of the scene camera's view; determines automatic levels
};

/// A scene prepared for ray queries. All const members are thread safe and use up to `device.threads`
/// threads; they may throw Error (out_of_memory, device_missing). A ray with a NaN, or with an infinite
/// component other than t_max, hits nothing.
class Intersector {
  public:
    /// Prepares the scene and builds its trees. Throws Error: usage for settings out of range, bad_input for
    /// an invalid scene, device_missing, out_of_memory.
    Intersector(Scene scene, const IntersectorSettings& settings);
    ~Intersector();
    Intersector(Intersector&&) noexcept;
    Intersector& operator=(Intersector&&) noexcept;

    /// Nearest hits with t in (t_min, t_max]. `hits` has the length of `rays`; so has `attributes` if the
    /// query requests any, else it is empty; Error{usage} otherwise. Attributes are evaluated at the levels
    /// of the level field, also with LodRule::ray.
    void closest_hits(std::span<const Ray> rays, std::span<RayHit> hits, const RayQuery& query = {},
                      std::span<HitAttributes> attributes = {}) const;

    /// hits[i] = 1 if anything is hit in (t_min, t_max], else 0. Spans of equal length, else Error{usage}.
    void any_hits(std::span<const Ray> rays, std::span<uint8_t> hits,
                  uint32_t visibility_mask = kVisibleToAll) const;

    /// The same for one ray, on the calling thread with the CPU engine. Batches are faster.
    RayHit closest_hit(const Ray& ray, uint32_t visibility_mask = kVisibleToAll) const;
    bool any_hit(const Ray& ray, uint32_t visibility_mask = kVisibleToAll) const;

    /// Warnings from reading and preparing the scene.
    const std::vector<std::string>& warnings() const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

} // namespace relief
