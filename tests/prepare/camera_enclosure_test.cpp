// Cameras in displaced bodies, whose rays must not change surfaces on their way out.
#include "prepare/camera_enclosure.h"

#include <utility>

#include <gtest/gtest.h>

#include "math/affine.h"
#include "prepare/scene_edit.h"
#include "support/bodies.h"

namespace relief {
namespace {

constexpr float kAmplitude = 0.05f;

Scene make_ball_scene(DisplacementSpace space = DisplacementSpace::tangent) {
    Scene scene =
        test::make_body_scene(test::make_cube_sphere(8),
                              test::make_displacement(test::make_random_map(96, 64, kAmplitude, 21), space));
    scene.camera.to = {0.1f, 5, 0.2f};
    return scene;
}

bool is_enclosed(const Scene& scene) { return prepare_scene(scene, {})->may_enclose_camera; }

TEST(CameraEnclosure, is_told_by_the_side_of_the_surface) {
    for (const DisplacementSpace space : {DisplacementSpace::tangent, DisplacementSpace::object}) {
        Scene scene = make_ball_scene(space);
        for (const float x : {0.0f, 0.3f, 0.7f}) {
            scene.camera.from = {x, 0.1f, 0};
            EXPECT_TRUE(is_enclosed(scene)) << x;
        }
        for (const float x : {1.4f, 2.0f, 100.0f}) {
            scene.camera.from = {x, 0.1f, 0};
            EXPECT_FALSE(is_enclosed(scene)) << x;
        }
    }
}

TEST(CameraEnclosure, is_possible_wherever_the_surface_may_be) {
    Scene scene = make_ball_scene();
    for (const float x : {0.97f, 1.0f, 1.03f}) {
        scene.camera.from = {x, 0, 0};
        EXPECT_TRUE(is_enclosed(scene)) << x;
    }
}

TEST(CameraEnclosure, follows_the_transform_of_the_object) {
    Scene scene = make_ball_scene();
    scene.objects[0].world_from_object = compose(make_translation({5, 0, 0}), make_scale({-2, 2, 2}));
    scene.camera.from = {0.1f, 0, 0};
    EXPECT_FALSE(is_enclosed(scene));
    scene.camera.from = {6.2f, 0, 0};
    EXPECT_TRUE(is_enclosed(scene));
}

TEST(CameraEnclosure, counts_the_whole_aperture) {
    Scene scene = make_ball_scene();
    scene.camera.from = {1.6f, 0, 0};
    scene.camera.aperture_radius = 0.2f;
    EXPECT_FALSE(is_enclosed(scene));
    scene.camera.aperture_radius = 0.7f;
    EXPECT_TRUE(is_enclosed(scene));
}

TEST(CameraEnclosure, is_not_of_bodies_that_are_open_or_not_displaced) {
    Scene plain = make_ball_scene();
    plain.camera.from = {0, 0.1f, 0};
    plain.objects[0].displacement = kNoIndex;
    EXPECT_FALSE(is_enclosed(plain));
    Scene open = make_ball_scene();
    open.camera.from = {0, 0.1f, 0};
    Mesh& mesh = open.meshes[0];
    mesh.face_sizes.resize(mesh.face_sizes.size() / 2);
    mesh.position_indices.resize(mesh.position_indices.size() / 2);
    mesh.uv_indices.resize(mesh.uv_indices.size() / 2);
    EXPECT_FALSE(is_enclosed(open));
}

/// A hollow body: the inner wall is turned round.
TEST(CameraEnclosure, is_of_both_walls_of_one_body) {
    Scene scene = make_ball_scene();
    Mesh& mesh = scene.meshes[0];
    const auto count = uint32_t(mesh.positions.size());
    for (uint32_t k = 0; k < count; ++k) mesh.positions.push_back(mesh.positions[k] * 1.5f);
    const size_t corners = mesh.position_indices.size();
    mesh.face_sizes.insert(mesh.face_sizes.end(), mesh.face_sizes.begin(), mesh.face_sizes.end());
    for (size_t k = 0; k < corners; ++k) {
        const size_t turned = k / 4 * 4 + 3 - k % 4;
        mesh.position_indices.push_back(mesh.position_indices[k] + count);
        mesh.uv_indices.push_back(mesh.uv_indices[k]);
        if (turned < k) {
            std::swap(mesh.position_indices[k], mesh.position_indices[turned]);
            std::swap(mesh.uv_indices[k], mesh.uv_indices[turned]);
        }
    }
    scene.camera.from = {0.3f, 0.1f, 0};
    EXPECT_TRUE(is_enclosed(scene)) << "in the hollow";
    scene.camera.from = {1.25f, 0, 0};
    EXPECT_TRUE(is_enclosed(scene)) << "between the walls";
    scene.camera.from = {2, 0, 0};
    EXPECT_FALSE(is_enclosed(scene));
}

TEST(CameraEnclosure, comes_with_an_edit) {
    Scene scene = make_ball_scene();
    scene.displacements[0].name = "bumps", scene.displacements[0].dilate = false;
    scene.camera.from = {1.6f, 0.1f, 0.1f};
    SceneEditor editor(scene, {});
    EXPECT_FALSE(editor.scene()->may_enclose_camera);
    MapEdit edit;
    edit.displacement = "bumps";
    edit.texels.width = 96, edit.texels.height = 64;
    edit.texels.floats.assign(4 * 96 * 64, 1.0f);
    editor.apply(editor.check(edit));
    EXPECT_TRUE(editor.scene()->may_enclose_camera);
}

} // namespace
} // namespace relief
