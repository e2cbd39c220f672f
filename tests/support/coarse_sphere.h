// Spheres of few triangles with smooth normals, and what is seen where light ends on them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "math/vec.h"
#include "support/bodies.h"
#include "support/shading_scenes.h"

namespace relief::test {

/// Unit sphere of 20 * 4^splits triangles from an icosahedron, winding outwards, with its normals.
inline Mesh make_icosphere(int splits) {
    const float g = std::numbers::phi_v<float>;
    std::vector<std::array<Vec3f, 3>> triangles;
    const Vec3f p[12] = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                         {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
    constexpr int kFaces[20][3] = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                   {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                   {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                   {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
    for (const auto& f : kFaces)
        triangles.push_back({normalize(p[f[0]]), normalize(p[f[1]]), normalize(p[f[2]])});
    for (int k = 0; k < splits; ++k) {
        std::vector<std::array<Vec3f, 3>> parts;
        for (const auto& [a, b, c] : triangles) {
            const Vec3f ab = normalize(a + b), bc = normalize(b + c), ca = normalize(c + a);
            for (const std::array<Vec3f, 3>& part :
                 {std::array{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}})
                parts.push_back(part);
        }
        triangles = std::move(parts);
    }
    Mesh mesh;
    mesh.name = "sphere";
    for (const auto& corners : triangles) {
        mesh.face_sizes.push_back(3);
        for (const Vec3f& corner : corners) {
            mesh.position_indices.push_back(uint32_t(mesh.positions.size()));
            mesh.positions.push_back(corner);
        }
    }
    mesh.normals = mesh.positions, mesh.normal_indices = mesh.position_indices;
    return mesh;
}

/// A matte body with a map of 4 x 4 texels that displaces nothing.
inline Scene displace_by_nothing(Mesh mesh) {
    auto map = std::make_shared<Texture>();
    map->width = map->height = 4, map->channel_count = 3, map->source_type = SampleType::float32;
    map->floats.assign(4 * 16, 0.0f);
    Scene scene = make_body_scene(std::move(mesh), make_displacement(map, DisplacementSpace::object));
    scene.materials.push_back(make_matte(0.8f));
    scene.objects[0].material = 0;
    return scene;
}

/// About a sphere, of a cube with rounded normals, smooth through its patches; a map that displaces nothing.
inline Scene make_displaced_sphere() {
    Mesh mesh = make_cube_sphere(1);
    mesh.subdivision.scheme = SubdivisionScheme::catmark, mesh.subdivision.level = 1;
    return displace_by_nothing(std::move(mesh));
}

/// A coarse sphere whose faces stay flat, and a map that displaces nothing.
inline Scene make_flat_displaced(Mesh mesh, SubdivisionScheme scheme) {
    mesh.subdivision.scheme = scheme, mesh.subdivision.level = 2;
    mesh.uvs.assign(1, {0.5f, 0.5f});
    mesh.uv_indices.assign(mesh.position_indices.size(), 0);
    return displace_by_nothing(std::move(mesh));
}

/// Unit sphere of quads, 6 * 4^splits of them.
inline Mesh make_quad_sphere(int splits) {
    Mesh mesh = make_cube_sphere(splits);
    for (Vec3f& p : mesh.positions) p = normalize(p);
    return mesh;
}

inline Scene make_sphere_scene(Mesh mesh) {
    Scene scene;
    add_object(scene, std::move(mesh), make_matte(0.8f));
    return scene;
}

inline Light make_sun_at_right() {
    Light sun;
    sun.direction = {-1, -0.2f, -0.15f}, sun.angle_degrees = 0, sun.strength = 3;
    return sun;
}

/// So far away that it does not matter how coarse a surface comes closer.
inline Light make_rectangle_at_right() {
    Light light;
    light.type = LightType::rectangle;
    light.position = {30, 6, 5}, light.direction = {-30, -6, -5};
    light.width = 8, light.height = 5, light.strength = 2000;
    return light;
}

/// The terminator runs down the middle of the picture.
inline void aim_at_sphere(Scene& scene, const Light& light) {
    scene.lights = {light};
    scene.camera.from = {0, 0.5f, 6}, scene.camera.to = {0, 0, 0};
    scene.camera.fov_degrees = 21;
}

/// What is wrong where light ends: with less than a quarter of what falls straight down.
struct TerminatorError {
    size_t pixels = 0, black = 0; ///< of `pixels` that are lit by more than a fiftieth
    double relative = 0;          ///< sum of differences by the sum that is right
};

/// `right`: the picture of a fine sphere. Both have the layer N, and only green counts.
inline TerminatorError measure_terminator(const Image& image, const Image& right) {
    const size_t green = image.find_channel("G").value(), alpha = image.find_channel("A").value();
    float brightest = 0;
    for (int k = 0; k < right.width * right.height; ++k)
        brightest = std::max(brightest, right.at(k % right.width, k / right.width, green));
    TerminatorError error;
    double difference = 0, sum = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const float seen = image.at(x, y, green), expected = right.at(x, y, green);
            const bool is_covered = image.at(x, y, alpha) == 1 && right.at(x, y, alpha) == 1;
            if (!is_covered || expected > 0.25f * brightest || expected < 0.02f * brightest) continue;
            ++error.pixels;
            error.black += seen == 0;
            difference += std::fabs(seen - expected), sum += expected;
        }
    error.relative = difference / sum;
    return error;
}

} // namespace relief::test
