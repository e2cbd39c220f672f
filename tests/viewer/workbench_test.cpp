// The viewer as a user drives it, without a window.
#include <filesystem>
#include <fstream>
#include <ios>
#include <iterator>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/texel_values.h"
#include "common/vectors.h"
#include "relief/error.h"
#include "relief/io.h"
#include "viewer/event_script.h"
#include "viewer/script_runner.h"
#include "viewer/workbench_fixture.h"

namespace relief::viewer {

using namespace vectors;

TEST_F(WorkbenchTest, turned_changed_and_saved_it_renders_to_what_was_seen) {
    open_scene();
    const Vec3f from = bench_->camera().get().from;
    drag(10, 10, 30, 14, MouseButton::middle);
    EXPECT_NE(bench_->camera().get().from, from);
    ViewSettings view;
    apply_values(read_json(R"({"scale": 2.5, "axes": "t,-b,n", "wrap": "repeat"})"), *bench_, view);
    ASSERT_TRUE(reach_done());
    press_key('S');
    ASSERT_TRUE(std::filesystem::exists(folder_ / "scene-view.json")) << bench_->message();
    EXPECT_EQ(render_file("scene-view.json"), bench_->picture()->image.pixels);
}

TEST_F(WorkbenchTest, a_script_sets_values_before_the_first_picture) {
    std::istringstream text("{\"set\": {\"spp\": 3, \"scale\": 2.5, \"strength\": 0.5, \"radius\": 9}}\n"
                            "{\"wait\": \"done\"}\n{\"quit\": true}\n");
    ViewSettings view;
    ScriptRunner script(
        read_script(text, "early.jsonl"), "early.jsonl", *bench_, view,
        {[](const InputEvent&) {}, [](const std::filesystem::path&) {}, [](const std::string&) {}});
    write_scene_files();
    bench_->open({folder_ / "scene.json", {}, {}});
    ASSERT_TRUE(bench_->is_loading());
    script.step(0); // before the scene is there
    double now = 0;
    ASSERT_TRUE(reach([&] {
        script.step(now += 0.01);
        return script.is_done();
    }));
    EXPECT_EQ(bench_->settings().image.spp, 3);
    EXPECT_EQ(bench_->brush().radius, 9);
    const Scene& scene = bench_->document()->scene();
    EXPECT_EQ(scene.displacements[0].scale.x, 2.5f);
    ASSERT_TRUE(scene.environment);
    EXPECT_EQ(scene.environment->strength, 0.5f);
}

TEST_F(WorkbenchTest, a_stroke_is_seen_undone_made_again_and_saved) {
    open_scene();
    const std::vector<float> before = bench_->picture()->image.pixels;
    press_key('B');
    EXPECT_EQ(bench_->tool(), Tool::paint);
    bench_->brush().radius = 6;
    bench_->brush().strength = 1;
    drag(18, 14, 32, 18);
    EXPECT_TRUE(bench_->can_undo());
    ASSERT_TRUE(reach_done());
    const std::vector<float> painted = bench_->picture()->image.pixels;
    EXPECT_NE(painted, before);
    press_key('Z', {.control = true});
    ASSERT_TRUE(reach_done());
    EXPECT_EQ(bench_->picture()->image.pixels, before);
    press_key('Y', {.control = true});
    ASSERT_TRUE(reach_done());
    EXPECT_EQ(bench_->picture()->image.pixels, painted);
    ASSERT_TRUE(bench_->save(folder_ / "painted.json")) << bench_->message();
    EXPECT_EQ(render_file("painted.json"), painted);
}

TEST_F(WorkbenchTest, a_changed_convention_keeps_what_was_painted) {
    open_scene();
    bench_->set_tool(Tool::paint);
    drag(18, 14, 32, 18);
    bench_->change_document([](Document& document) {
        document.change_displacement(0, [](Displacement& map) { map.scale = {2, 2, 2}; });
    });
    ASSERT_TRUE(reach_done());
    ASSERT_TRUE(bench_->save(folder_ / "both.json"));
    EXPECT_EQ(render_file("both.json"), bench_->picture()->image.pixels);
}

TEST_F(WorkbenchTest, how_a_map_is_meant_and_strokes_are_taken_back_in_their_order) {
    open_scene();
    const std::vector<float> before = bench_->picture()->image.pixels;
    const auto get_map = [&]() -> const Displacement& {
        return bench_->document()->scene().displacements[0];
    };
    const Displacement meaning = get_map();
    for (const float scale : {1.25f, 1.5f, 2.0f}) // one drag of a slider
        bench_->change_displacement(0, [&](Displacement& map) { map.scale = {scale, scale, scale}; });
    EXPECT_TRUE(bench_->has_unsaved());
    ASSERT_TRUE(reach_done());
    const std::vector<float> scaled = bench_->picture()->image.pixels;
    bench_->set_tool(Tool::paint);
    ASSERT_TRUE(reach_done());
    drag(18, 14, 32, 18);
    ASSERT_TRUE(reach_done());
    EXPECT_NE(bench_->picture()->image.pixels, scaled);
    press_key('Z', {.control = true});
    ASSERT_TRUE(reach_done());
    EXPECT_EQ(bench_->picture()->image.pixels, scaled);
    press_key('Z', {.control = true});
    ASSERT_TRUE(reach_done());
    EXPECT_EQ(get_map().scale, meaning.scale);
    EXPECT_EQ(bench_->picture()->image.pixels, before);
    EXPECT_FALSE(bench_->can_undo());
    press_key('Y', {.control = true});
    EXPECT_EQ(get_map().scale.x, 2);
    ASSERT_TRUE(reach_done());
    EXPECT_EQ(bench_->picture()->image.pixels, scaled);
    press_key('Y', {.control = true});
    ASSERT_TRUE(reach_done());
    EXPECT_NE(bench_->picture()->image.pixels, scaled);
    ASSERT_TRUE(bench_->save(folder_ / "redone.json"));
    EXPECT_FALSE(bench_->has_unsaved());
}

TEST_F(WorkbenchTest, materials_lights_and_maps_are_taken_back_in_their_order) {
    Scene scene = make_bumpy_scene();
    scene.lights.emplace_back();
    scene.lights[0].direction = {0, 0, -1};
    save_scene(scene, folder_ / "lit");
    bench_->open({folder_ / "lit" / "scene.json", {}, {}});
    ASSERT_TRUE(reach_done()) << bench_->message();
    const Scene& now = bench_->document()->scene();
    const std::vector<float> before = bench_->picture()->image.pixels;
    const float rough = now.materials[0].roughness;
    bench_->change_displacement(0, [](Displacement& map) { map.axes = {{0, 2, 1}, {1, 1, 1}}; });
    for (const float roughness : {0.75f, 0.5f, 0.125f}) // one drag of a slider
        bench_->change_material(0, [&](Material& material) { material.roughness = roughness; });
    ViewSettings view;
    apply_values(read_json(R"({"rotate_degrees": 90, "strength": 0.5})"), *bench_, view);
    bench_->change_light(0, [](Light& light) { light.strength = 3; });
    ASSERT_TRUE(reach_done());
    const std::vector<float> changed = bench_->picture()->image.pixels;
    press_key('Z', {.control = true});
    EXPECT_EQ(now.lights[0].strength, 1);
    EXPECT_EQ(now.environment->strength, 0.5f);
    press_key('Z', {.control = true});
    EXPECT_EQ(now.environment->strength, 1);
    EXPECT_EQ(now.environment->rotate_degrees, 0);
    EXPECT_EQ(now.materials[0].roughness, 0.125f);
    press_key('Z', {.control = true});
    EXPECT_EQ(now.materials[0].roughness, rough);
    EXPECT_NE(now.displacements[0].axes, AxisMap());
    press_key('Z', {.control = true});
    EXPECT_EQ(now.displacements[0].axes, AxisMap());
    EXPECT_FALSE(bench_->can_undo());
    ASSERT_TRUE(reach_done());
    EXPECT_EQ(bench_->picture()->image.pixels, before);
    for (int k = 0; k < 4; ++k) press_key('Y', {.control = true});
    EXPECT_FALSE(bench_->can_redo());
    ASSERT_TRUE(reach_done());
    EXPECT_EQ(bench_->picture()->image.pixels, changed);
}

TEST_F(WorkbenchTest, an_environment_that_was_dropped_stays_where_its_strength_is_taken_back) {
    open_scene();
    bench_->change_environment([](Environment& environment) { environment.strength = 0.5f; });
    Image sky;
    sky.width = 4, sky.height = 2, sky.channels = {"R", "G", "B"};
    sky.pixels.assign(24, 0.25f);
    write_image(sky, folder_ / "sky.hdr");
    bench_->drop({folder_ / "sky.hdr"});
    bench_->undo();
    const Environment& environment = *bench_->document()->scene().environment;
    EXPECT_EQ(environment.strength, 1);
    ASSERT_TRUE(environment.texture) << bench_->message();
    EXPECT_EQ(environment.texture->width, 4u);
}

TEST_F(WorkbenchTest, a_map_names_the_program_whose_values_it_has) {
    SceneInput input{folder_ / "meshes" / "plane.obj", {}, {}};
    input.mesh.displacement_map = folder_ / "maps" / "bumps.exr";
    input.mesh.map.preset = "maya";
    bench_->open(input);
    ASSERT_TRUE(reach_done()) << bench_->message();
    const auto get_preset = [&] { return bench_->document()->find_preset(0); };
    EXPECT_EQ(get_preset(), "maya"); // and not mudbox, which has the same values
    ViewSettings view;
    const auto set = [&](const char* text) { apply_values(read_json(text), *bench_, view); };
    set(R"({"preset": "cycles"})");
    EXPECT_EQ(get_preset(), "cycles");
    bench_->change_displacement(0, [](Displacement& map) { map.scale = {2, 2, 2}; });
    EXPECT_EQ(get_preset(), "cycles");
    set(R"({"axes": "t,b,n"})");
    EXPECT_EQ(get_preset(), "blender-brush"); // the first one
    set(R"({"axes": "t,-b,n"})");
    EXPECT_EQ(get_preset(), "");
    set(R"({"preset": "daz16"})");
    EXPECT_EQ(get_preset(), "daz16");
    set(R"({"space": "object", "preset": "mudbox"})");
    EXPECT_EQ(get_preset(), "mudbox");
    bench_->undo(); // what was opened has its values too
    EXPECT_EQ(get_preset(), "mudbox");
}

TEST_F(WorkbenchTest, a_mesh_opens_with_the_map_that_was_dropped_with_it) {
    bench_->drop({folder_ / "maps" / "bumps.exr", folder_ / "meshes" / "plane.obj"});
    ASSERT_TRUE(reach_done()) << bench_->message();
    ASSERT_EQ(bench_->document()->scene().displacements.size(), 1u);
    EXPECT_EQ(bench_->document()->input().file, folder_ / "meshes" / "plane.obj");
    EXPECT_FALSE(bench_->messages().empty());
}

TEST_F(WorkbenchTest, a_map_written_anew_is_shown_and_half_of_one_is_not) {
    open_scene();
    const std::vector<float> before = bench_->picture()->image.pixels;
    const std::filesystem::path file = bench_->document()->scene().displacements[0].tiles[0].texture->file;
    std::string bytes;
    {
        std::ifstream stream(file, std::ios::binary);
        bytes.assign(std::istreambuf_iterator<char>(stream), {});
    }
    std::ofstream(file, std::ios::binary) << bytes.substr(0, bytes.size() / 2);
    ASSERT_TRUE(reach([&] { return !bench_->message().empty(); }));
    EXPECT_NE(bench_->message().find("bumps.exr"), std::string::npos) << bench_->message();
    ASSERT_TRUE(reach_done());
    EXPECT_EQ(bench_->picture()->image.pixels, before);

    Displacement map = bench_->document()->scene().displacements[0];
    auto texture = std::make_shared<Texture>(*map.tiles[0].texture);
    for (uint32_t k = 0; k < 64; ++k) write_texel(*texture, k, 30, {0, 0, 0.4f});
    map.tiles[0].texture = texture;
    write_map(map, file, MapSamples::float32);
    ASSERT_TRUE(reach([&] { return bench_->message().find("read again") != std::string::npos; }));
    ASSERT_TRUE(reach_done());
    EXPECT_NE(bench_->picture()->image.pixels, before);
    EXPECT_EQ(bench_->picture()->image.pixels,
              render(load_scene(folder_ / "scene.json"), settings_).image.pixels);
}

TEST_F(WorkbenchTest, files_that_are_wrong_leave_what_was_open) {
    open_scene();
    std::ofstream(folder_ / "broken.json") << "{";
    bench_->drop({folder_ / "broken.json"});
    ASSERT_TRUE(reach([&] { return !bench_->is_loading(); }));
    EXPECT_NE(bench_->message().find("broken.json"), std::string::npos) << bench_->message();
    ASSERT_TRUE(bench_->document());
    EXPECT_EQ(bench_->document()->input().file, folder_ / "scene.json");
}

TEST_F(WorkbenchTest, another_scene_waits_for_an_answer_where_something_is_not_saved) {
    open_scene();
    bench_->change_document([](Document& document) {
        document.change_material(0, [](Material& material) { material.roughness = 0.125f; });
    });
    InputEvent event;
    event.kind = Kind::drop;
    event.files = {folder_ / "scene.json"};
    bench_->handle(event);
    EXPECT_TRUE(bench_->is_asked_to_open());
    EXPECT_FALSE(bench_->is_loading());
    bench_->forget_asked();
    ASSERT_TRUE(reach_done());
    EXPECT_EQ(bench_->document()->scene().materials[0].roughness, 0.125f);
    bench_->handle(event);
    bench_->open_asked();
    EXPECT_FALSE(bench_->is_asked_to_open());
    ASSERT_TRUE(reach_done());
    EXPECT_NE(bench_->document()->scene().materials[0].roughness, 0.125f);
    bench_->handle(event); // nothing to lose
    EXPECT_TRUE(bench_->is_loading());
    ASSERT_TRUE(reach_done());
}

TEST_F(WorkbenchTest, a_map_dropped_on_a_mesh_displaces_it) {
    bench_->drop({folder_ / "maps" / "bumps.exr"});
    EXPECT_FALSE(bench_->is_loading());
    bench_->drop({folder_ / "meshes" / "plane.obj"});
    ASSERT_TRUE(reach_done()) << bench_->message();
    EXPECT_TRUE(bench_->document()->scene().displacements.empty());
    press_key(kLeft);
    const Camera camera = bench_->camera().get();
    bench_->drop({folder_ / "maps" / "bumps.exr"});
    ASSERT_TRUE(reach_done()) << bench_->message();
    EXPECT_EQ(bench_->document()->scene().displacements.size(), 1u);
    EXPECT_EQ(bench_->camera().get().from, camera.from);
}

TEST_F(WorkbenchTest, a_click_explains_a_pixel_and_a_picture_is_written_when_it_is_done) {
    open_scene();
    send(Kind::press, 24, 16), send(Kind::release, 24, 16);
    ASSERT_TRUE(reach([&] { return bench_->explanation().text.size() > 10; }));
    for (const char* word : {"object   0 'plane'", "patch ", "texel (", "moved ", "colour "})
        EXPECT_NE(bench_->explanation().text.find(word), std::string::npos) << bench_->explanation().text;
    bench_->write_picture(folder_ / "out.exr");
    ASSERT_TRUE(reach([&] { return std::filesystem::exists(folder_ / "out.exr"); }));
    EXPECT_EQ(read_image(folder_ / "out.exr").pixels.size(), bench_->picture()->image.pixels.size());
}

TEST_F(WorkbenchTest, keys_turn_frame_and_end) {
    open_scene();
    const Vec3f from = bench_->camera().get().from;
    press_key(kRight), press_key('+');
    EXPECT_NE(bench_->camera().get().from, from);
    EXPECT_LT(bench_->camera().distance(), 3.9f);
    press_key('.');
    EXPECT_GT(bench_->camera().distance(), 3.5f);
    press_key(kF1);
    EXPECT_TRUE(bench_->is_help_shown());
    EXPECT_FALSE(bench_->wants_to_end());
    press_key('Q', {.control = true});
    EXPECT_TRUE(bench_->wants_to_end());
}

TEST_F(WorkbenchTest, a_key_that_is_held_gives_its_command_once) {
    open_scene();
    InputEvent held;
    held.kind = Kind::key_down, held.is_repeat = true;
    const float radius = bench_->brush().radius;
    const Vec3f from = bench_->camera().get().from;
    for (const int key : {int('S'), int('B'), int(kF1), int(']'), int(kLeft)})
        held.key = key, bench_->handle(held);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "scene-view.json"));
    EXPECT_EQ(bench_->tool(), Tool::look);
    EXPECT_FALSE(bench_->is_help_shown());
    EXPECT_GT(bench_->brush().radius, radius);
    EXPECT_NE(bench_->camera().get().from, from);
}

TEST_F(WorkbenchTest, shift_makes_flying_faster_until_it_is_released) {
    open_scene();
    const auto press_modifier = [&](Kind kind, bool is_held) {
        InputEvent event;
        event.kind = kind, event.key = kModifier, event.modifiers.shift = is_held;
        bench_->handle(event);
    };
    double now = 0;
    const auto measure = [&] {
        send(Kind::move, 20, 16); // which tells no modifiers
        const Vec3f before = bench_->camera().get().from;
        bench_->update(now += 0.05);
        const Vec3f way = bench_->camera().get().from - before;
        return length(way);
    };
    bench_->update(now);
    send(Kind::press, 20, 16, MouseButton::right);
    InputEvent fly;
    fly.kind = Kind::key_down, fly.key = 'W';
    bench_->handle(fly);
    const float slow = measure();
    EXPECT_GT(slow, 0);
    press_modifier(Kind::key_down, true);
    EXPECT_NEAR(measure(), 3 * slow, 0.3f * slow);
    press_modifier(Kind::key_up, false);
    EXPECT_NEAR(measure(), slow, 0.3f * slow);
}

TEST_F(WorkbenchTest, focus_brings_the_place_of_a_click_into_the_middle) {
    open_scene();
    send(Kind::press, 34, 10, MouseButton::left, {.control = true});
    send(Kind::release, 34, 10);
    EXPECT_GT(bench_->camera().get().to.x, 0.3f);
    EXPECT_GT(bench_->camera().get().to.y, 0.2f);
    EXPECT_NEAR(bench_->camera().distance(), 4, 0.3f);
}

TEST_F(WorkbenchTest, the_object_that_was_clicked_on_is_framed) {
    Scene scene = make_bumpy_scene();
    scene.objects.push_back(scene.objects[0]);
    scene.objects[1].name = "far";
    scene.objects[1].world_from_object.translation = {6, 0, 0};
    scene.camera.from = {3, 0, 9}, scene.camera.to = {3, 0, 0};
    save_scene(scene, folder_ / "two");
    bench_->open({folder_ / "two" / "scene.json", {}, {}});
    ASSERT_TRUE(reach_done()) << bench_->message();
    press_key(kHome);
    EXPECT_NEAR(bench_->camera().get().to.x, 3, 0.2f);
    ASSERT_TRUE(reach_done());
    send(Kind::press, 33, 16), send(Kind::release, 33, 16);
    EXPECT_EQ(bench_->selected_object(), 1u);
    ASSERT_TRUE(reach([&] { return !bench_->is_explaining(); }));
    EXPECT_EQ(bench_->explanation().object, 1u);
    ASSERT_FALSE(bench_->explanation().paths.empty());
    for (const auto& path : bench_->explanation().paths) {
        EXPECT_GE(path.size(), 2u);
        EXPECT_EQ(path[0], bench_->camera().get().from);
        EXPECT_EQ(path[1], bench_->explanation().paths[0][1]);
    }
    press_key('.');
    EXPECT_NEAR(bench_->camera().get().to.x, 6, 0.2f);
    press_key(kEscape);
    EXPECT_FALSE(bench_->selected_object());
    EXPECT_EQ(bench_->explanation().text, "");
    press_key('.');
    EXPECT_NEAR(bench_->camera().get().to.x, 3, 0.2f);
}

TEST_F(WorkbenchTest, a_map_is_saved_in_the_convention_of_another_program) {
    open_scene();
    ASSERT_TRUE(bench_->save_map(0, folder_ / "mudbox.exr", "mudbox")) << bench_->message();
    const Vec3f there = read_texel(read_texture(folder_ / "mudbox.exr"), 12, 20);
    EXPECT_EQ(there.y, read_texel(*make_bumps(false), 12, 20).z);
    EXPECT_FALSE(bench_->save_map(0, folder_ / "other.exr", "nobody"));
    EXPECT_NE(bench_->message().find("nobody"), std::string::npos) << bench_->message();
}

TEST_F(WorkbenchTest, a_denoised_picture_is_shown_in_place_of_the_noisy_one) {
    open_scene();
    if (!bench_->set_denoised(true)) GTEST_SKIP() << bench_->message();
    ASSERT_TRUE(reach_done()) << bench_->message();
    EXPECT_TRUE(bench_->has_denoiser());
    const Image& noisy = bench_->picture()->image;
    const Image& shown = bench_->shown_picture()->image;
    EXPECT_NE(get_channel(shown, "R"), get_channel(noisy, "R"));
    EXPECT_EQ(get_channel(shown, "noisy.R"), get_channel(noisy, "R"));
    const std::vector<float> color = get_channel(noisy, "R");
    ASSERT_TRUE(bench_->set_denoised(false));
    ASSERT_TRUE(reach_done());
    EXPECT_EQ(get_channel(bench_->shown_picture()->image, "R"), color);
}

TEST_F(WorkbenchTest, a_doubt_is_told_until_the_map_is_mended) {
    Displacement map = load_scene(folder_ / "scene.json").displacements[0];
    auto texture = std::make_shared<Texture>(*map.tiles[0].texture);
    for (uint32_t y = 0; y < 64; ++y)
        for (uint32_t x = 0; x < 64; ++x) {
            const Vec3f value = read_texel(*texture, x, y);
            write_texel(*texture, x, y, {0.5f, 0.5f, 0.5f + value.z});
        }
    map.tiles[0].texture = texture;
    write_map(map, folder_ / "maps" / "other.exr", MapSamples::float32);
    bench_->drop({folder_ / "meshes" / "plane.obj", folder_ / "maps" / "other.exr"});
    ASSERT_TRUE(reach_done()) << bench_->message();
    const std::string doubt = bench_->message();
    EXPECT_NE(doubt.find("encoding = signed"), std::string::npos) << doubt;
    bench_->change_material(0, [](Material& material) { material.roughness = 0.125f; });
    EXPECT_EQ(bench_->message(), doubt);
    bench_->change_displacement(0, [](Displacement& mended) { mended.midlevel = {0.5f, 0.5f, 0.5f}; });
    EXPECT_EQ(bench_->message(), "");
    ASSERT_TRUE(reach_done());
    EXPECT_EQ(bench_->message(), "");
    EXPECT_EQ(bench_->messages().front(), doubt);
}

TEST_F(WorkbenchTest, what_was_written_is_told_until_the_next_change) {
    open_scene();
    const auto save = [&] {
        ASSERT_TRUE(bench_->save(folder_ / "saved.json")) << bench_->message();
        ASSERT_TRUE(reach_done());
        EXPECT_EQ(bench_->message(), "wrote " + (folder_ / "saved.json").string());
    };
    save();
    bench_->change_camera([](OrbitCamera& camera) { camera.orbit(0.1f, 0); });
    EXPECT_NE(bench_->message(), "");
    bench_->change_material(0, [](Material& material) { material.roughness = 0.125f; });
    EXPECT_EQ(bench_->message(), "");
    save();
    bench_->undo();
    EXPECT_EQ(bench_->message(), "");
    bench_->set_tool(Tool::paint);
    save();
    drag(18, 14, 32, 18);
    EXPECT_EQ(bench_->message(), "");
    EXPECT_FALSE(bench_->save(folder_ / "scene.json")); // which was opened
    ASSERT_TRUE(reach_done());
    EXPECT_NE(bench_->message(), "");
    bench_->change_settings([](RenderSettings& settings) { settings.image.spp = 2; });
    EXPECT_EQ(bench_->message(), "");
}

TEST_F(WorkbenchTest, values_that_mean_nothing_are_refused) {
    open_scene();
    ViewSettings view;
    for (const char* text :
         {R"({"scael": 2})", R"({"scale": [1, 2]})", R"({"view": "smell"})", R"({"tool": "hammer"})",
          R"({"displacement": "none", "scale": 1})", R"({"spp": 0})", R"({"axes": "t,t,t"})"})
        EXPECT_THROW(apply_values(read_json(text), *bench_, view), Error) << text;
    apply_values(read_json(R"({"view": "depth", "exposure": 2, "tool": "smooth", "radius": 12})"), *bench_,
                 view);
    EXPECT_EQ(view.view, View::depth);
    EXPECT_EQ(bench_->brush().kind, BrushKind::smooth);
}

} // namespace relief::viewer
