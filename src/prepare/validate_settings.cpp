#include "prepare/validate_settings.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "relief/error.h"

namespace relief {

namespace {

constexpr const char* kWhere = "render settings";

void require(bool condition, const char* message, const std::string& hint) {
    if (!condition) throw Error(ErrorKind::usage, {message, kWhere, hint});
}

void require_traversal(const RenderSettings& s) {
    const std::vector<TraversalKind> valid = available_traversals(s.device.engine, s.experiment.structure);
    if (s.experiment.traversal == TraversalKind::automatic ||
        std::find(valid.begin(), valid.end(), s.experiment.traversal) != valid.end())
        return;
    std::vector<std::string> names;
    for (const TraversalKind traversal : valid) names.emplace_back(traversal_name(traversal));
    throw Error(ErrorKind::usage,
                {fmt::format("the traversal {} does not go with the structure {} on the {} engine",
                             traversal_name(s.experiment.traversal), structure_name(s.experiment.structure),
                             s.device.engine == EngineKind::cpu ? "cpu" : "vulkan"),
                 kWhere, fmt::format("valid there: {}", fmt::join(names, ", "))});
}

void require_costs(const RenderSettings& s) {
    if (!s.experiment.sah_costs) return;
    const auto is_cost = [](float cost) { return std::isfinite(cost) && cost > 0; };
    require(is_cost(s.experiment.sah_costs->traversal) && is_cost(s.experiment.sah_costs->intersection),
            "the costs of the surface-area heuristic are out of range", "above 0, finite");
    const bool is_default_bvh =
        s.experiment.structure == StructureKind::bvh &&
        (s.experiment.traversal == TraversalKind::automatic ||
         s.experiment.traversal == available_traversals(s.device.engine, StructureKind::bvh).front());
    require(
        s.experiment.structure != StructureKind::lbvh && !is_default_bvh,
        "costs of the surface-area heuristic do not go with the linear BVH and the engine's default trees",
        "experiment.structure = kdtree, or bvh with another traversal than the default");
}

} // namespace

void validate_settings(const RenderSettings& s) {
    require(s.image.width >= 1 && s.image.width <= kMaxPictureSize && s.image.height >= 1 &&
                s.image.height <= kMaxPictureSize,
            "the picture size is out of range", fmt::format("1 to {} pixels a side", kMaxPictureSize));
    require(s.image.spp >= 1 && s.image.spp <= kMaxSamples, "the number of samples is out of range",
            fmt::format("1 to {} a pixel", kMaxSamples));
    require(s.image.noise >= 0 && s.image.noise <= 1, "the noise is out of range",
            "0: not regarded, or up to 1, as a share of brightness");
    require(s.image.time_reserved_s >= 0 && std::isfinite(s.image.time_reserved_s),
            "the reserved part of the time limit is out of range", "seconds, at least 0 (none)");
    require(s.image.time_limit_s >= 0 && std::isfinite(s.image.time_limit_s),
            "the time limit is out of range", "seconds, at least 0 (none)");
    const auto is_color = [](const Vec3f& c) {
        return std::isfinite(c.x + c.y + c.z) && std::min({c.x, c.y, c.z}) >= 0;
    };
    require(!s.image.background || is_color(*s.image.background), "the background is no colour",
            "linear Rec.709, each at least 0, finite");
    require(s.image.first_sample >= 0 && s.image.first_sample <= (1 << 30),
            "the first sample is out of range", "0 to 1073741824");
    require(s.image.bounces >= 0 && s.image.bounces <= kMaxBounces, "the number of bounces is out of range",
            fmt::format("0 to {}", kMaxBounces));
    require(s.image.clamp_indirect >= 0 && std::isfinite(s.image.clamp_indirect),
            "the limit of indirect light is out of range", "radiance, at least 0 (no limit)");
    require(s.image.detail_height >= 0 && s.image.detail_height <= kMaxPictureSize,
            "the height that detail is chosen for is out of range",
            fmt::format("0 (that of the picture) to {}", kMaxPictureSize));
    require(s.device.threads >= 0 && s.device.threads <= kMaxThreads, "the number of threads is out of range",
            "0 (all cores) to 4096");
    require(s.device.index >= -1, "the device is out of range",
            "-1 (the best) or an index of vulkan_devices()");
    require(s.device.engine == EngineKind::vulkan ||
                (s.device.index == -1 && s.experiment.bottom == BottomForm::automatic),
            "a device and a form of the bottom kernel go with the Vulkan engine", "device.engine = vulkan");
    require(s.device.engine == EngineKind::vulkan || s.experiment.method == RenderMethod::compute,
            "a render method goes with the Vulkan engine",
            "experiment.method = compute, or device.engine = vulkan with compute, fragment or hybrid");
    require(s.experiment.method != RenderMethod::fragment || s.experiment.bottom != BottomForm::fused,
            "the fused form of the bottom kernel needs work groups, which fragments have not",
            "experiment.bottom = auto or split, or experiment.method = compute or hybrid");
    require(s.experiment.method != RenderMethod::hybrid || s.surface.lod == LodRule::field,
            "the hybrid method draws each patch at one level, so it has none for each ray",
            "surface.lod = field, or experiment.method = compute or fragment");
    require(s.experiment.method != RenderMethod::hybrid || s.surface.leaf == LeafKind::exact,
            "the hybrid method draws triangles, not their boxes",
            "surface.leaf = exact, or experiment.method = compute or fragment");
    require(s.experiment.method != RenderMethod::hybrid || s.image.noise == 0,
            "the hybrid method draws whole windows, not the pixels that are noisy",
            "image.noise = 0, or experiment.method = compute or fragment");
    require(s.device.engine == EngineKind::cpu || s.device.isa == Isa::best,
            "an instruction set goes with the CPU engine", "device.engine = cpu");
    require_traversal(s);
    require_costs(s);
    require(s.surface.level == kAutoLevel || (s.surface.level >= 0 && s.surface.level <= kMaxLevel),
            "the level is out of range", fmt::format("auto, or 0 to {}", kMaxLevel));
    require(s.surface.pixel_error > 0 && s.surface.pixel_error <= 1e6f, "the pixel error is out of range",
            "above 0, at most 1e6 pixels");
    require(
        s.image.crop == Window{} || (s.image.crop.x0 >= 0 && s.image.crop.y0 >= 0 &&
                                     s.image.crop.x0 < s.image.crop.x1 && s.image.crop.y0 < s.image.crop.y1 &&
                                     s.image.crop.x1 <= s.image.width && s.image.crop.y1 <= s.image.height),
        "the crop is empty or leaves the picture", "x0,y0,x1,y1 in pixels, half open, inside the picture");
}

void validate_method(const RenderSettings& s, const Camera& camera) {
    require(s.experiment.method != RenderMethod::hybrid || camera.aperture_radius == 0,
            "the hybrid method draws what one point sees, and the camera has a lens",
            "aperture_radius 0, or experiment.method = compute or fragment");
}

bool has_shadow_catchers(const Scene& scene) {
    return std::ranges::any_of(scene.objects, &Object::is_shadow_catcher);
}

RenderSettings complete_settings(RenderSettings s, bool has_catchers) {
    if (!has_catchers) return s;
    require(s.image.background == Vec3f{},
            "a shadow catcher shows the shadow before a background that shines through, and there is none",
            "image.background = transparent, or a colour for a .png");
    require(s.image.noise == 0, "the noise of a shadow that a shadow catcher shows is not measured",
            "image.noise = 0, or no shadow_catcher");
    if (std::ranges::find(s.image.layers, "shadow") == s.image.layers.end())
        s.image.layers.emplace_back("shadow");
    return s;
}

} // namespace relief
