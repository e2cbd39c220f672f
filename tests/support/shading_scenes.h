// Small scenes and one-number renders for tests of light transport.
#pragma once

#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

#include "math/vec.h"
#include "relief/render.h"
#include "relief/scene.h"

namespace relief {

/// Quad with the given corners, counter-clockwise.
inline Mesh make_quad_mesh(const std::array<Vec3f, 4>& corners) {
    Mesh mesh;
    mesh.name = "quad";
    mesh.positions.assign(corners.begin(), corners.end());
    mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    mesh.face_sizes = {4};
    mesh.position_indices = mesh.uv_indices = {0, 1, 2, 3};
    return mesh;
}

/// Floor y = 0 of the given half width, facing up.
inline Mesh make_floor(float h) {
    return make_quad_mesh({Vec3f{-h, 0, h}, {h, 0, h}, {h, 0, -h}, {-h, 0, -h}});
}

enum class SphereNormals { facets, smooth };

/// Unit sphere of 6 n n quads, winding outwards.
inline Mesh make_sphere(int n, SphereNormals normals) {
    Mesh mesh;
    mesh.name = "sphere";
    for (int side = 0; side < 6; ++side)
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i) {
                const int corners[4][2] = {{i, j}, {i + 1, j}, {i + 1, j + 1}, {i, j + 1}};
                mesh.face_sizes.push_back(4);
                for (const auto& corner : corners) {
                    const float a =
                        std::tan((2.0f * float(corner[0]) / float(n) - 1) * std::numbers::pi_v<float> / 4);
                    const float b =
                        std::tan((2.0f * float(corner[1]) / float(n) - 1) * std::numbers::pi_v<float> / 4);
                    const float s = side < 3 ? 1.0f : -1.0f;
                    // (a s, b, s) runs counter-clockwise seen from outside on both sides of each axis.
                    const Vec3f p = normalize(Vec3f{a * s, b, s});
                    const int axis = side % 3;
                    const Vec3f turned = axis == 0   ? p
                                         : axis == 1 ? Vec3f{p.y, p.z, p.x}
                                                     : Vec3f{p.z, p.x, p.y};
                    mesh.position_indices.push_back(uint32_t(mesh.positions.size()));
                    mesh.positions.push_back(turned);
                }
            }
    if (normals == SphereNormals::smooth) {
        mesh.normals = mesh.positions;
        mesh.normal_indices = mesh.position_indices;
    }
    return mesh;
}

/// Adds a mesh with a material of its own.
inline void add_object(Scene& scene, Mesh mesh, const Material& material) {
    Object object;
    object.name = mesh.name;
    object.mesh = uint32_t(scene.meshes.size());
    object.material = uint32_t(scene.materials.size());
    scene.meshes.push_back(std::move(mesh));
    scene.materials.push_back(material);
    scene.objects.push_back(object);
}

/// One texel whose first channel is a number; the others must not matter.
inline std::shared_ptr<const Texture> make_number_texture(float value) {
    auto texture = std::make_shared<Texture>();
    texture->width = texture->height = 1, texture->channel_count = 3;
    texture->floats = {value, 0.9f, 0.1f, 1};
    return texture;
}

/// A Lambertian surface: no coat.
inline Material make_matte(float albedo) {
    Material material;
    material.base_color = {albedo, albedo, albedo};
    material.ior = 1;
    material.roughness = 1;
    return material;
}

inline RenderSettings make_small_settings(int size, int spp, int bounces) {
    RenderSettings settings;
    settings.image.width = settings.image.height = size;
    settings.image.spp = spp;
    settings.image.bounces = bounces;
    settings.device.threads = 2;
    settings.image.seed = 12;
    settings.image.layers = {"depth", "variance"};
    return settings;
}

struct Mean {
    double value = 0;
    double standard_error = 0;
    size_t pixels = 0;
};

/// Mean of the green channel over the pixels that the object covers wholly.
inline Mean compute_covered_mean(const Image& image) {
    const size_t green = image.find_channel("G").value(), alpha = image.find_channel("A").value();
    const size_t variance = image.find_channel("variance.G").value();
    Mean mean;
    double sum_of_variances = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            if (image.at(x, y, alpha) < 1) continue;
            mean.value += image.at(x, y, green);
            sum_of_variances += image.at(x, y, variance);
            ++mean.pixels;
        }
    mean.value /= double(mean.pixels);
    mean.standard_error = std::sqrt(sum_of_variances) / double(mean.pixels);
    return mean;
}

inline Mean render_mean(Scene scene, const RenderSettings& settings) {
    return compute_covered_mean(render(std::move(scene), settings).image);
}

} // namespace relief
