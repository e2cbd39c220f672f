// Strokes on maps: where they land, what they leave alone, and how they are taken back.
#include <cmath>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "common/texel_values.h"
#include "common/vectors.h"
#include "relief/session.h"
#include "viewer/fixture.h"
#include "viewer/painter.h"

namespace relief::viewer {

using namespace vectors;

namespace {

/// A document, and a picture of it.
struct Easel {
    explicit Easel(Scene scene)
        : document({"plane.obj", {}, {}}, std::move(scene)),
          painter(document),
          picture(make_picture(document.scene(), make_small_settings())) {}

    Vec3f texel(uint32_t x, uint32_t y) {
        return read_texel(*document.snapshot()->scene.displacements[0].tiles[0].texture, x, y);
    }
    Texture texels() { return *document.snapshot()->scene.displacements[0].tiles[0].texture; }

    Document document;
    Painter painter;
    ShownPicture picture;
};

Brush make_brush(BrushKind kind, float strength) {
    Brush brush;
    brush.kind = kind;
    brush.radius = 6;
    brush.strength = strength;
    return brush;
}

} // namespace

TEST(SurfacePoint, is_where_the_picture_shows_it) {
    const ShownPicture picture = make_picture(make_bumpy_scene(), make_small_settings(64));
    const auto point = find_surface_point(picture, 30.5f, 10.5f);
    ASSERT_TRUE(point);
    EXPECT_EQ(point->object, 0u);
    EXPECT_NEAR(point->uv.x, (point->position.x + 1) / 2, 2e-3f);
    EXPECT_NEAR(point->uv.y, (point->position.y + 1) / 2, 2e-3f);
    EXPECT_GT(point->position.x, 0.2f);
    EXPECT_GT(point->position.y, 0.2f);
    const float height = 2 * 4 * std::tan(35 * float(M_PI) / 360);
    EXPECT_NEAR(point->pixel_size, height / 32, 0.05f * height / 32);
    EXPECT_NEAR(point->distance, 4 - point->position.z, 0.2f);
    EXPECT_FALSE(find_surface_point(picture, 0.5f, 0.5f));
    EXPECT_FALSE(find_surface_point(picture, -3, 200));
}

TEST(SurfacePoint, has_the_tile_of_the_face_that_is_nearest) {
    Scene scene = make_bumpy_scene();
    for (Vec2f& uv : scene.meshes[0].uvs) uv.x *= 2; // two columns of faces, one a tile
    // Each face has uvs of its own, so that the middle belongs to both tiles.
    scene.displacements[0].is_udim = true;
    scene.displacements[0].tiles.push_back({1002, make_bumps(false)});
    SurfacePoint point;
    point.uv = {0.5f, 0.25f};
    point.position = {-0.5f, -0.5f, 0};
    EXPECT_EQ(find_udim(scene, point), 1001);
    point.position = {0.5f, -0.5f, 0};
    EXPECT_EQ(find_udim(scene, point), 1002);
    scene.displacements[0].is_udim = false;
    EXPECT_EQ(find_udim(scene, point), 1001);
}

TEST(Painter, a_push_raises_the_surface_under_it_alone) {
    for (const auto space :
         {DisplacementSpace::tangent, DisplacementSpace::object, DisplacementSpace::world}) {
        Easel easel(make_bumpy_scene(space));
        const Texture before = easel.texels();
        const std::vector<MapEdit> edits =
            easel.painter.begin(make_brush(BrushKind::push, 0.5f), easel.picture, 24, 16);
        easel.painter.end();
        ASSERT_EQ(edits.size(), 1u);
        EXPECT_EQ(edits[0].displacement, "bumps");
        const Vec3f raised = easel.texel(32, 32), old = read_texel(before, 32, 32);
        const float pixel = 2 * 4 * std::tan(35 * float(M_PI) / 360) / 32;
        EXPECT_NEAR(raised.z - old.z, 0.5f * 0.25f * 6 * pixel, 0.3f * 0.5f * 0.25f * 6 * pixel);
        EXPECT_EQ(easel.texel(2, 2), read_texel(before, 2, 2));
        EXPECT_TRUE(easel.document.has_painted());
    }
}

TEST(Painter, edits_bring_a_session_to_the_document) {
    for (const bool has_halves : {false, true}) {
        Easel easel(make_bumpy_scene(DisplacementSpace::tangent, has_halves));
        const RenderSettings settings = make_small_settings();
        Session session(make_whole(*easel.document.snapshot()), settings);
        session.render();
        for (const MapEdit& edit :
             easel.painter.begin(make_brush(BrushKind::push, 0.7f), easel.picture, 20, 12))
            session.edit(edit);
        for (const MapEdit& edit : easel.painter.move(easel.picture, 34, 20)) session.edit(edit);
        easel.painter.end();
        EXPECT_EQ(session.render().image.pixels,
                  render(make_whole(*easel.document.snapshot()), settings).image.pixels);
    }
}

TEST(Painter, strokes_are_taken_back_and_made_again_bit_for_bit) {
    Easel easel(make_bumpy_scene());
    const Texture before = easel.texels();
    EXPECT_FALSE(easel.painter.can_undo());
    for (const auto kind : {BrushKind::push, BrushKind::smooth}) {
        easel.painter.begin(make_brush(kind, 1), easel.picture, 18, 14);
        easel.painter.move(easel.picture, 30, 18);
        easel.painter.end();
    }
    const Texture after = easel.texels();
    EXPECT_NE(after.floats, before.floats);
    EXPECT_FALSE(easel.painter.undo().empty());
    EXPECT_FALSE(easel.painter.undo().empty());
    EXPECT_EQ(easel.texels().floats, before.floats);
    EXPECT_FALSE(easel.painter.can_undo());
    EXPECT_TRUE(easel.painter.undo().empty());
    easel.painter.redo(), easel.painter.redo();
    EXPECT_EQ(easel.texels().floats, after.floats);
    easel.painter.undo();
    easel.painter.begin(make_brush(BrushKind::push, 1), easel.picture, 18, 14);
    easel.painter.end();
    EXPECT_FALSE(easel.painter.can_redo());
}

TEST(Painter, a_grab_moves_the_surface_with_the_mouse) {
    for (const auto space : {DisplacementSpace::tangent, DisplacementSpace::object}) {
        Easel easel(make_bumpy_scene(space));
        const Vec3f before = easel.texel(32, 32);
        EXPECT_TRUE(easel.painter.begin(make_brush(BrushKind::grab, 1), easel.picture, 24, 16).empty());
        ASSERT_TRUE(easel.painter.is_active());
        easel.painter.move(easel.picture, 24, 12);
        easel.painter.move(easel.picture, 26, 16); // from where it was grabbed, whatever the way
        easel.painter.end();
        const float pixel = 2 * 4 * std::tan(35 * float(M_PI) / 360) / 32;
        const Vec3f after = easel.texel(32, 32); // t and b of the plane are x and y
        EXPECT_NEAR(after.x - before.x, 2 * pixel, 0.3f * pixel);
        EXPECT_NEAR(after.y - before.y, 0, 0.1f * pixel);
        EXPECT_NEAR(after.z - before.z, 0, 0.1f * pixel);
    }
}

TEST(Painter, a_map_that_two_meshes_share_moves_along_the_frames_of_each) {
    Scene scene = make_bumpy_scene();
    scene.meshes.push_back(scene.meshes[0]);
    scene.meshes[1].name = "turned";
    for (Vec3f& position : scene.meshes[1].positions) position = {-position.y, position.x, position.z};
    scene.objects.push_back(scene.objects[0]);
    scene.objects[1].name = "turned";
    scene.objects[1].mesh = 1;
    scene.objects[0].world_from_object.translation = {-1, 0, 0};
    scene.objects[1].world_from_object.translation = {1, 0, 0};
    Easel easel(scene);
    const float pixel = 2 * 4 * std::tan(35 * float(M_PI) / 360) / 32;
    const auto grab = [&](float x) {
        const Vec3f before = easel.texel(32, 32);
        easel.painter.begin(make_brush(BrushKind::grab, 1), easel.picture, x, 16);
        easel.painter.move(easel.picture, x + 2, 16);
        easel.painter.end();
        return easel.texel(32, 32) - before;
    };
    const Vec3f first = grab(12), second = grab(36);
    EXPECT_NEAR(first.x, 2 * pixel, 0.3f * pixel);
    EXPECT_NEAR(first.y, 0, 0.1f * pixel);
    EXPECT_NEAR(second.x, 0, 0.1f * pixel);
    EXPECT_NEAR(second.y, -2 * pixel, 0.3f * pixel);
}

TEST(Painter, erasing_leads_to_the_midlevel_and_smoothing_to_the_mean) {
    Scene scene = make_bumpy_scene();
    scene.displacements[0].midlevel = {0.25f, 0, 0.5f};
    Easel easel(scene);
    const auto point = find_surface_point(easel.picture, 24, 16);
    easel.painter.begin(make_brush(BrushKind::erase, 1), easel.picture, 24, 16);
    easel.painter.end();
    const Vec3f erased = easel.texel(uint32_t(point->uv.x * 64), uint32_t((1 - point->uv.y) * 64));
    EXPECT_NEAR(erased.x, 0.25f, 0.03f);
    EXPECT_NEAR(erased.z, 0.5f, 0.05f);

    Easel other(make_bumpy_scene());
    const auto measure = [&] { // steps between neighbours
        double sum = 0;
        for (uint32_t x = 28; x < 36; ++x)
            sum += std::fabs(other.texel(x + 1, 32).z - 2 * other.texel(x, 32).z + other.texel(x - 1, 32).z);
        return sum;
    };
    const double rough = measure();
    for (int k = 0; k < 8; ++k) {
        other.painter.begin(make_brush(BrushKind::smooth, 1), other.picture, 24, 16);
        other.painter.end();
    }
    EXPECT_LT(measure(), 0.8 * rough);
}

TEST(Painter, a_map_that_repeats_is_painted_across_its_border) {
    Scene scene = make_bumpy_scene();
    scene.displacements[0].wrap = WrapMode::repeat;
    for (Vec2f& uv : scene.meshes[0].uvs) uv.x += 0.5f; // the border is in the middle
    Easel easel(scene);
    const Texture before = easel.texels();
    EXPECT_EQ(easel.painter.begin(make_brush(BrushKind::push, 1), easel.picture, 24, 16).size(), 2u);
    EXPECT_GT(easel.texel(0, 32).z, read_texel(before, 0, 32).z);
    EXPECT_GT(easel.texel(63, 32).z, read_texel(before, 63, 32).z);
}

TEST(Painter, nothing_happens_beside_the_surface) {
    Easel easel(make_bumpy_scene());
    EXPECT_TRUE(easel.painter.begin(Brush(), easel.picture, 1, 1).empty());
    EXPECT_FALSE(easel.painter.is_active());
    EXPECT_TRUE(easel.painter.move(easel.picture, 24, 16).empty());
    easel.painter.end();
    EXPECT_FALSE(easel.painter.can_undo());
    EXPECT_FALSE(easel.document.has_painted());
}

TEST(Painter, heights_move_along_the_normal_alone) {
    Scene scene = make_bumpy_scene();
    scene.displacements[0].type = DisplacementType::height;
    Easel easel(scene);
    const Vec3f before = easel.texel(32, 32);
    easel.painter.begin(make_brush(BrushKind::push, 1), easel.picture, 24, 16);
    easel.painter.end();
    const Vec3f after = easel.texel(32, 32);
    EXPECT_GT(after.x, before.x + 0.05f);
    EXPECT_EQ(after.y, before.y);
    EXPECT_EQ(after.z, before.z);
}

} // namespace relief::viewer
