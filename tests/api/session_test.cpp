// Pictures after edits of a map: those of a fresh scene with the edited map, bit for bit.
#include <atomic>
#include <initializer_list>

#include <gtest/gtest.h>

#include "math/box.h"
#include "relief/error.h"
#include "relief/samples.h"
#include "relief/session.h"
#include "support/bodies.h"
#include "support/session_scenes.h"
#include "surface/test_scenes.h"

namespace relief {

namespace {

using test::make_rough_torus, test::make_session_settings;

MapEdit make_edit(uint32_t x, uint32_t y, uint32_t width, uint32_t height, float value) {
    MapEdit edit;
    edit.displacement = "map";
    edit.x = x, edit.y = y;
    edit.texels.width = width, edit.texels.height = height, edit.texels.channel_count = 3;
    edit.texels.file = "edit.exr";
    for (uint32_t k = 0; k < width * height; ++k)
        edit.texels.floats.insert(edit.texels.floats.end(),
                                  {0.3f * value, 0.2f * value * float(k % 3), value, 1.0f});
    return edit;
}

/// The scene with the edit worked into its map before anything was prepared.
void bake(Scene& scene, const MapEdit& edit) {
    MapTile& tile = scene.displacements[0].tiles[0];
    auto map = std::make_shared<Texture>(*tile.texture);
    for (uint32_t y = 0; y < edit.texels.height; ++y)
        std::copy_n(edit.texels.floats.begin() + 4 * y * edit.texels.width, 4 * edit.texels.width,
                    map->floats.begin() + 4 * ((edit.y + y) * map->width + edit.x));
    tile.texture = map;
}

void expect_same(const Image& a, const Image& b) {
    ASSERT_EQ(a.pixels.size(), b.pixels.size());
    for (size_t k = 0; k < a.pixels.size(); ++k) ASSERT_EQ(a.pixels[k], b.pixels[k]) << "number " << k;
}

size_t count_differing(const Image& a, const Image& b) {
    size_t count = 0;
    for (size_t k = 0; k < a.pixels.size(); ++k) count += a.pixels[k] != b.pixels[k];
    return count;
}

/// Each edit of a session shows what a render of the scene with the edited map shows, and something new.
/// Returns the last picture; the edits are in `fresh`.
Image follow_edits(Scene& fresh, const RenderSettings& settings, std::initializer_list<MapEdit> edits) {
    Session session(fresh, settings);
    Image before = session.render().image;
    expect_same(before, render(fresh, settings).image);
    for (const MapEdit& edit : edits) {
        EXPECT_GT(session.edit(edit).patches, 0u);
        bake(fresh, edit);
        Image after = session.render().image;
        expect_same(after, render(fresh, settings).image);
        EXPECT_GT(count_differing(before, after), 100u);
        before = after;
    }
    return before;
}

} // namespace

TEST(Session, edits_give_the_pictures_of_a_fresh_scene) {
    for (const DisplacementSpace space : {DisplacementSpace::tangent, DisplacementSpace::object})
        for (const int level : {4, kAutoLevel}) {
            RenderSettings settings = make_session_settings();
            settings.surface.level = level;
            Scene fresh = make_rough_torus(space);
            follow_edits(fresh, settings,
                         {make_edit(30, 20, 20, 12, 0.12f), make_edit(90, 0, 6, 64, -0.07f),
                          make_edit(0, 63, 40, 1, 0.2f), make_edit(30, 20, 20, 12, 0.0f)});
        }
}

TEST(Session, follows_edits_of_what_lies_far_from_the_origin) {
    const Vec3f place{3e5f, -2e5f, 1e5f};
    Scene fresh = make_rough_torus(DisplacementSpace::tangent);
    fresh.objects[0].world_from_object.translation = place;
    fresh.camera.from = fresh.camera.from + place, fresh.camera.to = fresh.camera.to + place;
    follow_edits(fresh, make_session_settings(),
                 {make_edit(30, 20, 20, 12, 0.12f), make_edit(90, 0, 6, 64, -0.07f)});
}

TEST(Session, edits_reach_the_copies_of_a_filtered_map) {
    for (const bool has_autobump : {false, true}) {
        Scene fresh = make_rough_torus(DisplacementSpace::tangent);
        fresh.displacements[0].filter = MapFilter::mip, fresh.displacements[0].autobump = has_autobump;
        RenderSettings settings = make_session_settings();
        settings.surface.pixel_error = 4;
        const Image before =
            follow_edits(fresh, settings, {make_edit(30, 20, 20, 12, 0.12f), make_edit(90, 0, 6, 64, -0.3f)});
        fresh.displacements[0].filter = MapFilter::none, fresh.displacements[0].autobump = false;
        EXPECT_GT(count_differing(before, render(fresh, settings).image), 100u) << "nothing was filtered";
    }
}

TEST(Session, edits_reach_the_coefficients_of_a_smooth_map) {
    for (const bool is_dequantized : {false, true})
        for (const MapFilter filter : {MapFilter::cubic, MapFilter::bspline}) {
            Scene fresh =
                make_rough_torus(is_dequantized ? DisplacementSpace::object : DisplacementSpace::tangent);
            fresh.displacements[0].filter = filter;
            if (is_dequantized) {
                auto stairs = std::make_shared<Texture>(*fresh.displacements[0].tiles[0].texture);
                stairs->source_type = SampleType::uint16;
                fresh.displacements[0].tiles[0].texture = stairs;
                fresh.displacements[0].dequantize = true;
            }
            const RenderSettings settings = make_session_settings();
            // The last one has the spline go far beyond its texels.
            const Image before = follow_edits(fresh, settings,
                                              {make_edit(30, 20, 20, 12, 0.12f),
                                               make_edit(90, 0, 6, 64, -0.07f), make_edit(50, 30, 3, 3, 20)});
            fresh.displacements[0].filter = MapFilter::none, fresh.displacements[0].dequantize = false;
            EXPECT_GT(count_differing(before, render(fresh, settings).image), 100u) << "nothing was smooth";
        }
}

TEST(Session, follows_edits_with_any_cache_walk_and_rule) {
    const auto expect_follows = [](const RenderSettings& settings) {
        Scene fresh = make_rough_torus(DisplacementSpace::tangent);
        Session session(fresh, settings);
        session.render();
        const MapEdit edit = make_edit(10, 10, 50, 30, 0.1f);
        session.edit(edit);
        bake(fresh, edit);
        expect_same(session.render().image, render(fresh, settings).image);
    };
    RenderSettings settings = make_session_settings();
    settings.surface.cache_bytes = 0;
    expect_follows(settings);
    settings.surface.cache_bytes = 300000;
    expect_follows(settings);
    settings.experiment.traversal = TraversalKind::stack;
    expect_follows(settings);
    settings = make_session_settings();
    settings.surface.lod = LodRule::ray, settings.surface.leaf = LeafKind::box;
    expect_follows(settings);
    settings = make_session_settings();
    settings.surface.level = 7; // tiles and their directories
    expect_follows(settings);
}

TEST(Session, makes_only_the_patches_anew_that_read_the_rectangle) {
    Session session(make_rough_torus(DisplacementSpace::tangent), make_session_settings());
    // 8 x 16 patches of 6 x 8 texels: one texel in the middle of a patch, then the whole map.
    EXPECT_EQ(session.edit(make_edit(3, 4, 1, 1, 0.1f)).patches, 1u);
    EXPECT_EQ(session.edit(make_edit(0, 0, 96, 64, 0.1f)).patches, 128u);
}

TEST(Session, keeps_trees_that_an_edit_does_not_reach) {
    Session session(make_rough_torus(DisplacementSpace::tangent), make_session_settings());
    const uint64_t first = session.render().statistics.bottom_built;
    EXPECT_EQ(session.render().statistics.bottom_built, 0u);
    session.edit(make_edit(40, 30, 4, 4, 0.1f));
    EXPECT_LT(session.render().statistics.bottom_built, first / 2);
}

uint64_t count_rays(const RenderResult& result) {
    const Statistics& s = result.statistics;
    return s.camera_rays + s.shadow_rays + s.bounce_rays;
}

TEST(Session, traces_only_what_an_edit_may_have_reached) {
    RenderSettings settings = make_session_settings();
    settings.image.width = 320, settings.image.height = 240, settings.image.bounces = 0;
    Scene fresh = make_rough_torus(DisplacementSpace::tangent);
    Session session(fresh, settings);
    const uint64_t all = count_rays(session.render());
    EXPECT_EQ(count_rays(session.render()), 0u);
    size_t kept = 0;
    for (uint32_t x = 0; x < 96; x += 24) {
        session.edit(make_edit(x, 20, 6, 6, 0.06f));
        const RenderResult result = session.render();
        bake(fresh, make_edit(x, 20, 6, 6, 0.06f));
        const Image expected = render(fresh, settings).image;
        expect_same(result.image, expected);
        kept += count_rays(result) < all / 3;
    }
    EXPECT_GE(kept, 3u);
}

/// A plane of 8 x 8 patches seen from above.
Scene make_plane_scene(uint32_t map_size) {
    Mesh mesh = test::make_random_grid(8, 8, 0, 1);
    for (uint32_t k = 0; k < mesh.positions.size(); ++k)
        mesh.positions[k] = {float(k % 9) / 8, float(k / 9) / 8, 0};
    Scene scene = test::make_body_scene(
        std::move(mesh), test::make_displacement(test::make_constant(map_size, map_size, {0, 0, 0}),
                                                 DisplacementSpace::tangent));
    scene.displacements[0].name = "map";
    scene.camera.from = {0.5f, 0.5f, 1.6f}, scene.camera.to = {0.5f, 0.5f, 0};
    return scene;
}

TEST(Session, sees_shading_normals_that_read_beyond_their_patch) {
    for (const int level : {0, 1, 3}) {
        Scene fresh = make_plane_scene(256);
        RenderSettings settings;
        settings.image.width = settings.image.height = 640, settings.image.spp = 1,
        settings.image.bounces = 0;
        settings.surface.level = level;
        settings.image.layers = {"depth", "N"};
        Session session(fresh, settings);
        const uint64_t all = count_rays(session.render());
        // A few texels inside of a patch of 32 texels: its neighbours' differences reach there.
        for (const uint32_t at : {100u, 40u, 205u}) {
            const MapEdit edit = make_edit(at, at, 8, 8, 0.04f);
            session.edit(edit);
            bake(fresh, edit);
            const RenderResult result = session.render();
            expect_same(result.image, render(fresh, settings).image);
            EXPECT_LT(count_rays(result), all / 2);
        }
    }
}

TEST(Session, traces_what_an_edit_has_taken_away_from_far_off) {
    Scene fresh = make_plane_scene(256);
    MapEdit edit = make_edit(36, 100, 8, 8, 0);
    const MapEdit flat = edit;
    // A tongue from a patch on the left to over those on the right.
    for (size_t k = 0; k < edit.texels.floats.size(); k += 4)
        edit.texels.floats[k] = 0.5f, edit.texels.floats[k + 2] = 0.2f;
    bake(fresh, edit);
    RenderSettings settings;
    settings.image.width = settings.image.height = 320, settings.image.spp = 1, settings.image.bounces = 0;
    settings.surface.level = 3;
    settings.image.layers = {"depth", "N"};
    Session session(fresh, settings);
    const RenderResult before = session.render();
    session.edit(flat);
    bake(fresh, flat);
    const RenderResult after = session.render();
    expect_same(after.image, render(fresh, settings).image);
    EXPECT_GT(count_differing(before.image, after.image), 1000u);
    EXPECT_LT(count_rays(after), count_rays(before) / 2) << "nothing was kept";
}

TEST(Session, keeps_blocks_of_any_window_lens_and_rule) {
    Scene fresh = make_rough_torus(DisplacementSpace::tangent);
    fresh.camera.aperture_radius = 0.05f, fresh.camera.focus_distance = 2.5f;
    RenderSettings settings = make_session_settings();
    settings.image.width = 320, settings.image.height = 240, settings.image.bounces = 0;
    settings.image.crop = {37, 11, 301, 203};
    for (const LodRule rule : {LodRule::field, LodRule::ray}) {
        settings.surface.lod = rule;
        Session session(fresh, settings);
        const uint64_t all = count_rays(session.render());
        uint64_t least = all;
        for (uint32_t x = 0; x < 96; x += 24) {
            session.edit(make_edit(x, 20, 6, 6, 0.06f));
            const RenderResult result = session.render();
            bake(fresh, make_edit(x, 20, 6, 6, 0.06f));
            expect_same(result.image, render(fresh, settings).image);
            least = std::min(least, count_rays(result));
        }
        EXPECT_LT(least, all / 2) << "nothing was kept";
    }
}

TEST(Session, follows_a_map_that_is_two_tiles) {
    Scene fresh = make_rough_torus(DisplacementSpace::tangent);
    Displacement& map = fresh.displacements[0];
    for (Vec2f& uv : fresh.meshes[0].uvs) uv.x *= 2;
    map.is_udim = true, map.wrap = WrapMode::clamp;
    map.tiles.push_back({1002, map.tiles[0].texture});
    RenderSettings settings = make_session_settings();
    settings.image.width = 320, settings.image.height = 240, settings.image.bounces = 0;
    Session session(fresh, settings);
    session.render();
    for (const float height : {0.3f, 0.0f}) {
        const MapEdit edit = make_edit(86, 20, 10, 10, height);
        session.edit(edit);
        bake(fresh, edit);
        map.tiles[1].texture = map.tiles[0].texture;
        expect_same(session.render().image, render(fresh, settings).image);
    }
}

TEST(Session, follows_edits_at_the_border_of_a_tile_that_another_one_continues) {
    for (const MapFilter filter : {MapFilter::none, MapFilter::cubic}) {
        Scene fresh = make_rough_torus(DisplacementSpace::tangent);
        Displacement& map = fresh.displacements[0];
        for (Vec2f& uv : fresh.meshes[0].uvs) uv.x = 2 * uv.x + 0.03f; // some faces lie across both
        map.is_udim = true, map.wrap = WrapMode::clamp, map.filter = filter;
        map.tiles.push_back({1002, test::make_random_map(50, 64, 0.05f, 9)});
        map.tiles.push_back({1003, map.tiles[1].texture});
        RenderSettings settings = make_session_settings();
        Session session(fresh, settings);
        session.render();
        for (const float height : {0.3f, 0.0f}) {
            const MapEdit edit = make_edit(90, 20, 6, 10, height);
            session.edit(edit);
            bake(fresh, edit);
            expect_same(session.render().image, render(fresh, settings).image);
        }
    }
}

TEST(Session, follows_edits_that_no_picture_shows_and_edits_that_leave_the_scene) {
    Scene fresh = make_rough_torus(DisplacementSpace::tangent);
    Session session(fresh, make_session_settings());
    session.render();
    // The third reaches far beyond what the torus took up.
    for (const MapEdit& edit : {make_edit(10, 10, 6, 6, 0.06f), make_edit(40, 20, 6, 6, -0.06f),
                                make_edit(60, 30, 6, 6, 1.5f), make_edit(60, 30, 6, 6, 0.1f)}) {
        session.edit(edit);
        bake(fresh, edit);
    }
    expect_same(session.render().image, render(fresh, make_session_settings()).image);
    const MapEdit far = make_edit(60, 30, 6, 6, 1.5f);
    session.edit(far);
    bake(fresh, far);
    expect_same(session.render().image, render(fresh, make_session_settings()).image);
}

TEST(Session, goes_on_where_it_was_interrupted) {
    struct Interrupter final : RenderObserver {
        mutable std::atomic<int> looks{0};
        int limit = 0;
        void on_progress(const Progress&) override {}
        bool is_cancelled() const override { return ++looks > limit; }
    };
    Scene fresh = make_rough_torus(DisplacementSpace::tangent);
    RenderSettings settings = make_session_settings();
    settings.device.threads = 1;
    Session session(fresh, settings);
    for (const int limit : {1, 5, 20, 1000000}) {
        Interrupter observer;
        observer.limit = limit;
        const RenderResult result = session.render(&observer);
        EXPECT_EQ(result.is_complete, limit == 1000000);
        EXPECT_EQ(result.image.metadata.contains("relief:interrupted"), !result.is_complete);
    }
    const MapEdit edit = make_edit(30, 20, 20, 12, 0.12f);
    session.edit(edit);
    bake(fresh, edit);
    Interrupter observer;
    observer.limit = 3;
    EXPECT_FALSE(session.render(&observer).is_complete);
    expect_same(session.render().image, render(fresh, settings).image);
}

TEST(Session, edits_reach_the_gutter_between_islands) {
    Scene fresh = make_rough_torus(DisplacementSpace::tangent);
    Mesh& mesh = fresh.meshes[0];
    for (Vec2f& uv : mesh.uvs) uv = {0.1f + 0.8f * uv.x, 0.1f + 0.8f * uv.y};
    auto map = std::make_shared<Texture>(*fresh.displacements[0].tiles[0].texture);
    for (uint32_t y = 0; y < 64; ++y)
        for (uint32_t x = 0; x < 96; ++x)
            if (x < 9 || x >= 86 || y < 6 || y >= 58)
                for (uint32_t c = 0; c < 3; ++c) map->floats[4 * (y * 96 + x) + c] = 0;
    fresh.displacements[0].tiles[0].texture = map;
    const Image dilated = render(fresh, make_session_settings()).image;
    fresh.displacements[0].dilate = false;
    EXPECT_GT(count_differing(dilated, render(fresh, make_session_settings()).image), 20u);
    fresh.displacements[0].dilate = true;
    Session session(fresh, make_session_settings());
    expect_same(session.render().image, dilated);
    const MapEdit edit = make_edit(4, 4, 30, 20, 0.1f);
    session.edit(edit);
    bake(fresh, edit);
    expect_same(session.render().image, render(fresh, make_session_settings()).image);
}

TEST(Session, leaves_the_scene_of_its_maker_alone) {
    const Scene scene = make_rough_torus(DisplacementSpace::tangent);
    const std::vector<float> before = scene.displacements[0].tiles[0].texture->floats;
    Session session(scene, make_session_settings());
    session.edit(make_edit(0, 0, 96, 64, 0.1f));
    EXPECT_EQ(scene.displacements[0].tiles[0].texture->floats, before);
}

TEST(Session, follows_a_surface_that_glows) {
    Scene fresh = make_rough_torus(DisplacementSpace::tangent);
    fresh.environment.reset();
    Material glow;
    glow.emission = {3, 2, 1};
    fresh.materials.push_back(glow);
    fresh.objects[0].material = 0;
    fresh.meshes.push_back(test::make_cube_sphere(2));
    Object ball;
    ball.mesh = 1, ball.world_from_object.translation = {0, 1.5f, 0};
    fresh.objects.push_back(ball);
    Session session(fresh, make_session_settings());
    const MapEdit edit = make_edit(20, 10, 50, 40, 0.2f);
    session.edit(edit);
    bake(fresh, edit);
    expect_same(session.render().image, render(fresh, make_session_settings()).image);
}

TEST(Session, refuses_what_it_cannot_do_and_changes_nothing) {
    const Scene scene = make_rough_torus(DisplacementSpace::tangent);
    Session session(scene, make_session_settings());
    const auto expect_error = [](const auto& call, const std::string& reason) {
        try {
            call();
            ADD_FAILURE() << "accepted: " << reason;
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::bad_input);
            EXPECT_NE(std::string(error.what()).find(reason), std::string::npos) << error.what();
        }
    };
    const auto expect_refused = [&](const MapEdit& edit, const std::string& reason) {
        expect_error([&] { session.check(edit); }, reason);
        expect_error([&] { session.edit(edit); }, reason);
    };
    MapEdit edit = make_edit(90, 0, 7, 1, 0.1f);
    expect_refused(edit, "leave the map of 96 x 64");
    edit = make_edit(0, 0, 4, 4, 0.1f);
    edit.displacement = "mapp";
    expect_refused(edit, "there is no such displacement");
    edit.displacement = "map", edit.udim = 1002;
    expect_refused(edit, "there is no such tile");
    edit.udim = 1001, edit.texels.floats[17] = NAN;
    expect_refused(edit, "pixel (0, 1)");
    edit.texels.floats[17] = 3e38f;
    expect_refused(edit, "displaces by");
    edit.texels.floats.pop_back();
    expect_refused(edit, "holds no texels");
    EXPECT_NO_THROW(session.check(make_edit(0, 0, 4, 4, 0.1f)));
    expect_same(session.render().image, render(scene, make_session_settings()).image);

    RenderSettings tessellated = make_session_settings();
    tessellated.surface.mode = SurfaceMode::tessellated;
    EXPECT_THROW(Session(scene, tessellated), Error);
}

} // namespace relief
