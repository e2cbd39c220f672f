// What a material is at one point.
#pragma once

#include <cstdint>
#include <span>

#include "cpu/shading/shading_kernels.h"
#include "math/vec.h"
#include "prepare/prepared_scene.h"

namespace relief::cpu {

/// A material at one point, textures looked up.
struct PointMaterial {
    Vec3f base_color, emission;
    float roughness, metallic, ior;
    uint32_t layers;        ///< record of PreparedScene::layers; kNoIndex: none
    uint32_t glass;         ///< record of PreparedScene::glass; kNoIndex: none
    uint32_t glass_numbers; ///< its place where vertices have numbers of their own (VertexInputs::glass)
};

enum class BaseColor { with_texture, factor_alone };

/// Finds the materials at many hits. The points hold the uvs. Numbers that VertexInputs adds are left out.
void make_point_materials(const PreparedScene& scene, const ShadingKernels& kernels,
                          std::span<const TraceHit> hits, std::span<const SurfacePoint> points,
                          std::span<PointMaterial> materials, BaseColor base_color);

} // namespace relief::cpu
