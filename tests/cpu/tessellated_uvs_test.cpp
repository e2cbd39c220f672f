// The uvs that a tessellated surface shows are those of the patches that it was made from.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "relief/render.h"
#include "support/bodies.h"
#include "support/isas.h"

namespace relief {
namespace {

/// A closed body of quads and triangles, whose uvs are no parallelograms.
Scene make_scene() {
    const Mesh quads = test::make_cube_sphere(3);
    Mesh mesh = quads;
    mesh.face_sizes.clear(), mesh.position_indices.clear();
    for (size_t face = 0; face < quads.face_sizes.size(); ++face) {
        const uint32_t* p = quads.position_indices.data() + 4 * face;
        const std::vector<uint32_t> corners = face % 3 == 0
                                                  ? std::vector<uint32_t>{p[0], p[1], p[2], p[0], p[2], p[3]}
                                                  : std::vector<uint32_t>{p[0], p[1], p[2], p[3]};
        mesh.face_sizes.insert(mesh.face_sizes.end(), face % 3 == 0 ? 2 : 1, face % 3 == 0 ? 3 : 4);
        mesh.position_indices.insert(mesh.position_indices.end(), corners.begin(), corners.end());
    }
    mesh.uv_indices = mesh.position_indices;
    std::mt19937 random(5);
    std::uniform_real_distribution<float> offset(-0.02f, 0.02f);
    for (Vec2f& uv : mesh.uvs) uv = {uv.x + offset(random), uv.y + offset(random)};
    Scene scene = test::make_body_scene(
        std::move(mesh),
        test::make_displacement(test::make_random_map(32, 24, 0.05f, 8), DisplacementSpace::object));
    scene.camera.from = {3, 1, 2};
    return scene;
}

float find_largest_difference(Isa isa) {
    RenderSettings settings;
    settings.image.width = 96, settings.image.height = 64, settings.image.spp = 1;
    settings.image.layers = {"uv", "depth"};
    settings.surface.pixel_error = 20; // cells of some pixels
    settings.device.isa = isa;
    const Image direct = render(make_scene(), settings).image;
    settings.surface.mode = SurfaceMode::tessellated;
    const Image tessellated = render(make_scene(), settings).image;
    float largest = 0;
    int hits = 0;
    for (size_t channel = 0; channel < direct.channels.size(); ++channel) {
        if (direct.channels[channel] != "uv.X" && direct.channels[channel] != "uv.Y") continue;
        for (int y = 0; y < direct.height; ++y)
            for (int x = 0; x < direct.width; ++x) {
                const float a = direct.at(x, y, channel), b = tessellated.at(x, y, channel);
                largest = std::fmax(largest, std::fabs(a - b)), hits += a > 0;
            }
    }
    EXPECT_GT(hits, 2000);
    return largest;
}

TEST(TessellatedUvs, are_those_of_the_patches) {
    for (const Isa isa : test::machine_isas()) EXPECT_LT(find_largest_difference(isa), 1e-6f) << int(isa);
}

} // namespace
} // namespace relief
