// What the paths of a tile bring to the layers that share out the light of a picture, and to the guides of a
// denoiser. Nothing is kept for a picture without them.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "cpu/shading/lights.h"
#include "formulas/light_kinds.h"
#include "image/light_layers.h"
#include "math/vec.h"
#include "prepare/light_groups.h"

namespace relief::cpu {

class PathLights {
  public:
    /// `layers`: those of the film; `groups`, which outlive this: those of the scene that they are made of.
    PathLights(const LightLayers& layers, const LightGroups& groups, const ImageSettings& image)
        : groups_(groups),
          clamp_indirect_(image.clamp_indirect),
          has_kinds_(layers.has_kinds),
          has_guides_(layers.has_guides),
          first_group_(layers.kind_count()),
          first_guide_(layers.first_guide()),
          count_(layers.count()) {}

    bool is_on() const { return count_ > 0; }
    bool has_kinds() const { return has_kinds_; }
    bool has_groups() const { return first_guide_ > first_group_; }
    bool has_guides() const { return has_guides_; }

    /// A sample begins: all paths are dark.
    void start(size_t path_count);
    /// As Film::add_lights takes it.
    std::span<const Vec3f> at(uint32_t path) const { return {sums_.data() + path * count_, count_}; }

    /// Lights that a camera ray meets before `distance`, of which `share` comes to the camera.
    void add_seen_lights(uint32_t path, const LightSet& lights, const TraceRay& ray, float distance,
                         const Vec3f& share);
    /// What the camera sees behind all surfaces: the plain background, or else the environment.
    void add_background(uint32_t path, bool is_plain, const Vec3f& light);
    /// A surface that a ray meets emits, after so many bounces. The kinds have it from add_scattered(),
    /// unless the camera sees it.
    void add_emission(uint32_t path, uint32_t material, const Vec3f& light, int depth);
    /// Light that the first surface scatters, in the shares of set_shares(); not yet of a group.
    /// `bounces`: those between it and the light.
    void add_scattered(uint32_t path, const Vec3f& light, uint32_t bounces) {
        if (has_kinds_) add_split(path, light, shares_[path], bounces);
    }
    /// A bounce ray that may meet lights; `light` is what they bring together, before it is clamped.
    struct Meeting {
        const LightSet& lights;
        const LightSet::BounceRay& ray;
        const EnvironmentLookup& behind;
        const Vec3f& throughput;
        const Vec3f& light;
    };
    /// To their groups, each light that the ray meets, which comes to the vertex after `depth` bounces.
    void add_met_lights(uint32_t path, const Meeting& meeting, int depth);

    /// Guides are of the first vertex that has some: the path looks for it until they are set.
    bool looks_for_guides(uint32_t path) const { return has_guides_ && !is_guided_[path]; }
    void set_guides(uint32_t path, const Vec3f& albedo, const Vec3f& normal) {
        is_guided_[path] = 1;
        Vec3f* guides = &sums_[path * count_ + first_guide_];
        guides[0] = albedo, guides[1] = normal;
    }

    /// The path leaves its first vertex: how what comes along it is scattered.
    void set_shares(uint32_t path, const scalar::LightShares& shares) {
        if (has_kinds_) shares_[path] = shares;
    }

    /// The next shadow ray of a wave, in order; its shares are those of light that the first vertex scatters.
    struct ShadowRay {
        scalar::LightShares shares;
        uint32_t group;
    };
    void clear_shadow_rays() { shadow_rays_.clear(); }
    void add_shadow_ray(const ShadowRay& ray) { shadow_rays_.push_back(ray); }
    /// What shadow ray `index` brings, of a vertex after so many bounces.
    void add_shadow_light(size_t index, uint32_t path, const Vec3f& light, uint32_t bounces);

  private:
    /// kNoIndex: of a group without a layer.
    void add_to_group(uint32_t path, uint32_t group, const Vec3f& light) {
        if (group != kNoIndex) sums_[path * count_ + first_group_ + group] += light;
    }
    void add_seen(uint32_t path, uint32_t kind, uint32_t group, const Vec3f& light);
    void add_split(uint32_t path, const Vec3f& light, const scalar::LightShares& shares, uint32_t bounces);

    const LightGroups& groups_;
    float clamp_indirect_;
    bool has_kinds_, has_guides_;
    size_t first_group_, first_guide_, count_; ///< of the colours of a path
    std::vector<Vec3f> sums_;                  ///< path by path: the kinds, the groups, the guides
    std::vector<uint8_t> is_guided_;
    std::vector<scalar::LightShares> shares_; ///< of set_shares()
    std::vector<ShadowRay> shadow_rays_;
};

} // namespace relief::cpu
