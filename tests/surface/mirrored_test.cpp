// Half of a body whose uvs are the other half's, mirrored: one map serves both, and the shells are mirror
// images, not turned inside out.
#include <gtest/gtest.h>

#include "surface/patch/patch_samples.h"
#include "test_scenes.h"

namespace relief {
namespace {

constexpr uint32_t kSide = 4;

/// A bent sheet over x in [0, 1]; `sign` -1: its mirror image at x = 0, same uvs, faces wound the other way.
void add_shell(Mesh& mesh, float sign) {
    const uint32_t first = uint32_t(mesh.positions.size());
    for (uint32_t j = 0; j <= kSide; ++j)
        for (uint32_t i = 0; i <= kSide; ++i) {
            const float u = float(i) / kSide, v = float(j) / kSide;
            mesh.positions.push_back({sign * u, v + 0.1f * u * u, 0.4f * u * (1.3f - u) + 0.2f * v * v});
        }
    for (uint32_t j = 0; j < kSide; ++j)
        for (uint32_t i = 0; i < kSide; ++i) {
            const uint32_t columns[4] = {i, i + 1, i + 1, i}, rows[4] = {j, j, j + 1, j + 1};
            std::vector<uint32_t> points;
            std::vector<Vec2f> uvs;
            for (int k = 0; k < 4; ++k) {
                const int corner = sign > 0 ? k : 3 - k;
                points.push_back(first + rows[corner] * (kSide + 1) + columns[corner]);
                uvs.push_back({float(columns[corner]) / kSide, float(rows[corner]) / kSide});
            }
            test::add_face(mesh, points, uvs);
        }
}

/// The sample of a surface at a uv of one shell.
Vec3f find_sample(const Surface& surface, uint32_t first_patch, const Vec2f& uv) {
    for (uint32_t patch = first_patch; patch < first_patch + kSide * kSide; ++patch) {
        const PatchSamples samples(surface, patch);
        for (uint32_t j = 0; j <= 8; ++j)
            for (uint32_t i = 0; i <= 8; ++i) {
                const Vec2f at = blend_corners(samples.corners(), float(i) / 8, float(j) / 8).uv;
                if (std::fabs(at.x - uv.x) + std::fabs(at.y - uv.y) < 1e-6f)
                    return evaluate_vertex(surface, patch, {3, {3, 3, 3, 3}}, i, j);
            }
    }
    ADD_FAILURE() << "no sample at " << uv.x << ", " << uv.y;
    return {};
}

} // namespace

TEST(MirroredShells, of_a_tangent_map_are_mirror_images) {
    Mesh mesh;
    mesh.name = "shells";
    add_shell(mesh, 1);
    const uint32_t second = uint32_t(mesh.face_sizes.size());
    add_shell(mesh, -1);
    Displacement displacement = test::make_displacement(test::make_noise(33, 29, 0.2f, 8));
    for (const FrameKind kind : {FrameKind::mikk, FrameKind::dpdu})
        for (const FrameLengths lengths : {FrameLengths::absolute, FrameLengths::relative}) {
            displacement.frame = kind, displacement.lengths = lengths;
            const Surface surface = make_surface(mesh, &displacement, {});
            double moved_up = 0;
            for (uint32_t j = 0; j <= 32; j += 3)
                for (uint32_t i = 1; i <= 32; i += 3) { // x = 0 belongs to both
                    const Vec2f uv{float(i) / 32, float(j) / 32};
                    const Vec3f right = find_sample(surface, 0, uv), left = find_sample(surface, second, uv);
                    EXPECT_NEAR(left.x, -right.x, 2e-4f) << uv.x << ", " << uv.y;
                    EXPECT_NEAR(left.y, right.y, 2e-4f);
                    EXPECT_NEAR(left.z, right.z, 2e-4f);
                    moved_up += double(std::fabs(right.z));
                }
            EXPECT_GT(moved_up, 1);
        }
}

} // namespace relief
