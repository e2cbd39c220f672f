// aim_scene, turn_camera and save_scene_copy: what is framed, lit and written again.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "io/scene/frame_scene.h"
#include "math/vec.h"
#include "relief/aim.h"
#include "relief/io.h"
#include "support/input_textures.h"
#include "test_files.h"

namespace relief {

using Aim = FileTest;

/// A box as a mesh of six quads.
Mesh make_box(const Vec3f& lower, const Vec3f& upper) {
    Mesh mesh;
    mesh.name = "box";
    for (int k = 0; k < 8; ++k)
        mesh.positions.push_back(
            {k & 1 ? upper.x : lower.x, k & 2 ? upper.y : lower.y, k & 4 ? upper.z : lower.z});
    mesh.position_indices = {0, 4, 6, 2, 1, 3, 7, 5, 0, 1, 5, 4, 2, 6, 7, 3, 0, 2, 3, 1, 4, 5, 7, 6};
    mesh.face_sizes.assign(6, 4);
    return mesh;
}

/// Two meshes far from each other, the second one moved and turned by its transform.
Scene make_two_boxes() {
    Scene scene;
    scene.meshes = {make_box({-1, -1, -1}, {1, 1, 1}), make_box({0, 0, 0}, {2, 1, 1})};
    Object a, b;
    a.mesh = 0, b.mesh = 1;
    b.world_from_object.translation = {6, 2, 0};
    scene.objects = {a, b};
    return scene;
}

/// Largest |x| and |y| of all corners in the picture, 1 at its border; infinite for one behind the camera.
Vec2f measure_reach(const Scene& scene, const Camera& camera, float aspect) {
    const Vec3f forward = normalize(camera.to - camera.from), right = normalize(cross(forward, camera.up));
    const Vec3f up = cross(right, forward);
    const float tangent = std::tan(camera.fov_degrees * std::numbers::pi_v<float> / 360);
    Vec2f reach{0, 0};
    for (const Object& object : scene.objects)
        for (const Vec3f& p : scene.meshes[object.mesh].positions) {
            const Vec3f d = p + object.world_from_object.translation - camera.from;
            const float depth = dot(d, forward);
            if (!(depth > 0)) return {INFINITY, INFINITY};
            reach.x = std::max(reach.x, std::fabs(dot(d, right)) / (depth * tangent * aspect));
            reach.y = std::max(reach.y, std::fabs(dot(d, up)) / (depth * tangent));
        }
    return reach;
}

TEST_F(Aim, a_zoom_changes_the_angle_of_the_camera_as_it_stands) {
    Scene framed = make_two_boxes();
    aim_scene(framed, {.view = View::front}, 1);
    for (const float zoom : {0.5f, 1.0f, 4.0f}) {
        Scene zoomed = make_two_boxes();
        aim_scene(zoomed, {.zoom = zoom, .view = View::front}, 1);
        EXPECT_EQ(zoomed.camera.from, framed.camera.from);
        const float reach = measure_reach(framed, framed.camera, 1).x;
        EXPECT_NEAR(measure_reach(zoomed, zoomed.camera, 1).x, zoom * reach, 1e-3f * zoom);
    }
    for (const float zoom : {0.0f, -1.0f, NAN, INFINITY, 1e-6f})
        EXPECT_HAS(message_of([&] { aim_scene(framed, {.zoom = zoom}, 1); }, ErrorKind::usage), "zoom");
}

TEST_F(Aim, every_view_shows_all_objects_and_fills_the_picture) {
    for (const View view :
         {View::front, View::back, View::left, View::right, View::top, View::three_quarter, View::automatic})
        for (const float aspect : {0.5f, 1.0f, 1.78f}) {
            Scene scene = make_two_boxes();
            AimOptions options;
            options.view = view;
            aim_scene(scene, options, aspect);
            const Vec2f reach = measure_reach(scene, scene.camera, aspect);
            const float middle_square = std::min(aspect, 1.0f) / aspect;
            EXPECT_LE(std::max(reach.x / middle_square, reach.y), 0.86f) << int(view) << " " << aspect;
            EXPECT_GE(std::max(reach.x / middle_square, reach.y), 0.8f) << int(view) << " " << aspect;
        }
}

TEST_F(Aim, views_look_along_the_axes_that_they_are_named_after) {
    const auto look = [](View view) {
        Scene scene = make_two_boxes();
        AimOptions options;
        options.view = view;
        aim_scene(scene, options, 1);
        return normalize(scene.camera.to - scene.camera.from);
    };
    const auto is_near = [](const Vec3f& a, const Vec3f& b) { return length(a - b) < 1e-5f; };
    EXPECT_TRUE(is_near(look(View::front), {0, 0, -1}));
    EXPECT_TRUE(is_near(look(View::back), {0, 0, 1}));
    EXPECT_TRUE(is_near(look(View::right), {-1, 0, 0}));
    EXPECT_TRUE(is_near(look(View::left), {1, 0, 0}));
    EXPECT_TRUE(is_near(look(View::top), {0, -1, 0}));
}

TEST_F(Aim, many_copies_are_framed_by_their_boxes) {
    Scene scene = make_two_boxes();
    for (int k = 0; k < 40; ++k) {
        Object object;
        object.world_from_object.translation = {0, 3.0f * float(k), 0};
        scene.objects.push_back(object);
    }
    AimOptions options;
    options.view = View::front;
    aim_scene(scene, options, 1);
    const Vec2f reach = measure_reach(scene, scene.camera, 1);
    EXPECT_NEAR(std::max(reach.x, reach.y), 0.85f, 0.01f);
}

/// Longer than wide, with the head at one end above the body.
Mesh make_animal(float facing) {
    Mesh mesh = make_box({-1, 0, -3}, {1, 1, 3});
    const Mesh head =
        make_box({-1, 2, std::min(2 * facing, 4 * facing)}, {1, 4, std::max(2 * facing, 4 * facing)});
    for (const uint32_t index : head.position_indices) mesh.position_indices.push_back(index + 8);
    mesh.positions.insert(mesh.positions.end(), head.positions.begin(), head.positions.end());
    mesh.face_sizes.insert(mesh.face_sizes.end(), head.face_sizes.begin(), head.face_sizes.end());
    return mesh;
}

TEST_F(Aim, a_body_alone_is_seen_from_its_head) {
    EXPECT_LT(make_mesh_scene(make_animal(-1), nullptr).camera.from.z, -1);
    EXPECT_GT(make_mesh_scene(make_animal(1), nullptr).camera.from.z, 1);
    // Not longer than wide, as people are: +z.
    EXPECT_GT(make_mesh_scene(make_box({-2, 0, -1}, {2, 6, 1}), nullptr).camera.from.z, 1);
}

TEST_F(Aim, a_camera_is_placed_and_aimed) {
    Scene scene = make_two_boxes();
    AimOptions options;
    options.from = Vec3f{3, 1, 20}, options.fov_degrees = 20;
    aim_scene(scene, options, 1);
    EXPECT_EQ(scene.camera.from, (Vec3f{3, 1, 20}));
    EXPECT_EQ(scene.camera.to, (Vec3f{3.5f, 1, 0})) << "the middle of the scene";
    EXPECT_EQ(scene.camera.fov_degrees, 20);
    EXPECT_NEAR(scene.camera.focus_distance, length(Vec3f{0.5f, 0, 20}), 1e-4f);
    options.to = options.from;
    EXPECT_NE(message_of([&] { aim_scene(scene, options, 1); }, ErrorKind::usage).find("its own position"),
              std::string::npos);
    options.to = Vec3f{3, -5, 20};
    aim_scene(scene, options, 1); // straight down: another axis is up
    EXPECT_GT(length(cross(scene.camera.up, scene.camera.to - scene.camera.from)), 1.0f);
}

TEST_F(Aim, suns_and_the_environment_are_replaced) {
    Scene scene = make_two_boxes();
    Light sun, point;
    sun.strength = 5, point.type = LightType::point;
    scene.lights = {sun, point, sun};
    AimOptions options;
    options.suns = {{90, 0}};
    aim_scene(scene, options, 1);
    ASSERT_EQ(scene.lights.size(), 2u);
    EXPECT_EQ(scene.lights[0].type, LightType::point);
    EXPECT_LT(length(scene.lights[1].direction - Vec3f{-1, 0, 0}), 1e-6f) << "from +x";
    EXPECT_EQ(scene.lights[1].strength, 5) << "as the suns that it replaces";
    options = {};
    options.strength = 2.0f;
    EXPECT_NE(message_of([&] { aim_scene(scene, options, 1); }, ErrorKind::usage).find("no environment"),
              std::string::npos);
    scene.environment = Environment{};
    options.rotate_degrees = 30.0f;
    aim_scene(scene, options, 1);
    EXPECT_EQ(scene.environment->strength, 2);
    EXPECT_EQ(scene.environment->rotate_degrees, 30);
}

TEST_F(Aim, the_ground_lies_under_the_lowest_point) {
    Scene scene = make_two_boxes();
    scene.hash = 7;
    AimOptions options;
    options.ground = Ground::plane;
    aim_scene(scene, options, 1);
    ASSERT_EQ(scene.objects.size(), 3u);
    for (const Vec3f& p : scene.meshes[scene.objects[2].mesh].positions) {
        EXPECT_LE(p.y, -1);
        EXPECT_NEAR(p.y, -1, 0.01f);
    }
    EXPECT_NE(scene.hash, 7u) << "another picture";
}

TEST_F(Aim, a_turntable_keeps_everything_in_the_picture) {
    Scene scene = make_two_boxes();
    AimOptions options;
    options.view = View::three_quarter, options.is_turntable = true;
    aim_scene(scene, options, 1.5f);
    float largest = 0;
    for (int degrees = 0; degrees < 360; degrees += 10) {
        const Camera camera = turn_camera(scene.camera, float(degrees));
        const Vec2f reach = measure_reach(scene, camera, 1.5f);
        largest = std::max({largest, reach.x, reach.y});
        EXPECT_NEAR(length(camera.from - camera.to), scene.camera.focus_distance, 1e-3f);
    }
    EXPECT_LE(largest, 1);
    EXPECT_GE(largest, 0.5f);
    const Camera quarter = turn_camera(scene.camera, 90), whole = turn_camera(scene.camera, 360);
    EXPECT_LT(length(whole.from - scene.camera.from), 1e-3f);
    EXPECT_NEAR(dot(quarter.from - quarter.to, scene.camera.from - scene.camera.to),
                std::pow(scene.camera.from.y - scene.camera.to.y, 2), 1e-2f);
}

TEST_F(Aim, nothing_changes_without_options) {
    Scene scene = make_two_boxes();
    scene.hash = 7;
    aim_scene(scene, {}, 1);
    EXPECT_EQ(scene.hash, 7u);
    EXPECT_EQ(scene.camera.from, Camera{}.from);
}

constexpr const char* kPlane = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\n"
                               "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n";

TEST_F(Aim, a_copy_of_a_mesh_scene_names_its_files_and_reads_back) {
    write("plane.obj", kPlane);
    write_pixels<float>("map.exr", 2, 2, 3, OIIO::TypeDesc::FLOAT, {0, 0, 1, 0, 0, 0, 0, 0, 0, 0, .5f, 0});
    std::filesystem::create_directories(folder_ / "copies");
    MeshSceneOptions options;
    options.displacement_map = folder_ / "map.exr";
    options.map.preset = "genvdm", options.map.scale = Vec3f{2, 2, 2}, options.map.wrap = "repeat";
    options.subdivision = "catmark", options.subdivision_level = 1;
    Scene scene = load_mesh_scene(folder_ / "plane.obj", options);
    AimOptions aim;
    aim.view = View::left, aim.ground = Ground::plane, aim.suns = {{10, 20}};
    aim_scene(scene, aim, 1);
    scene.picture.width = 64, scene.camera.shift = {0.125f, -0.5f};
    const std::filesystem::path file = folder_ / "copies" / "s.json";
    save_scene_copy(scene, folder_ / "plane.obj", options, file);
    const Scene read = load_scene(file);
    EXPECT_EQ(read.camera.from, scene.camera.from);
    EXPECT_EQ(read.camera.focus_distance, scene.camera.focus_distance);
    EXPECT_EQ(read.camera.shift, scene.camera.shift);
    EXPECT_EQ(read.picture.width, 64);
    ASSERT_EQ(read.objects.size(), 2u);
    EXPECT_EQ(read.meshes[0].subdivision, scene.meshes[0].subdivision);
    EXPECT_EQ(read.meshes[1].positions, scene.meshes[1].positions) << "the ground";
    EXPECT_EQ(read.displacements[0].scale, (Vec3f{2, 2, 2}));
    EXPECT_EQ(read.displacements[0].wrap, WrapMode::repeat);
    EXPECT_EQ(read.lights[0].direction, scene.lights[0].direction);
    EXPECT_EQ(read.environment->color, scene.environment->color);
}

TEST_F(Aim, a_copy_of_a_scene_file_keeps_its_keys_and_moves_its_paths) {
    write("plane.obj", kPlane);
    write_pixels<uint8_t>("colour.png", 1, 1, 3, OIIO::TypeDesc::UINT8, {255, 128, 0});
    const std::filesystem::path input = write("s.json", R"({"camera": {"from": [0, 0, 9]},
        "materials": {"red": {"base_color_texture": "colour.png", "geometry_normal": "colour.png", "roughness": 0.25}},
        "meshes": {"plane": {"file": "plane.obj"}},
        "objects": [{"mesh": "plane", "material": "red", "transform": {"translate": [0, 1, 0], "scale": 2}}]})");
    std::filesystem::create_directories(folder_ / "a" / "b");
    Scene scene = load_scene(input);
    AimOptions aim;
    aim.to = Vec3f{0, 1, 0};
    aim_scene(scene, aim, 1);
    const std::filesystem::path file = folder_ / "a" / "b" / "copy.json";
    save_scene_copy(scene, input, {}, file);
    const Scene read = load_scene(file);
    EXPECT_EQ(read.camera.to, (Vec3f{0, 1, 0}));
    EXPECT_EQ(read.materials[0].roughness, 0.25f);
    ASSERT_TRUE(test::get_texture(read.materials[0], MaterialInput::base_color));
    ASSERT_TRUE(test::get_texture(read.materials[0], MaterialInput::normal));
    EXPECT_EQ(read.objects[0].world_from_object, scene.objects[0].world_from_object);
    std::ifstream text(file);
    const std::string content{std::istreambuf_iterator<char>(text), {}};
    EXPECT_NE(content.find("../../colour.png"), std::string::npos) << content;
    EXPECT_NE(content.find("// "), std::string::npos);
    EXPECT_NE(content.find("[0.0, 0.0, 9.0]"), std::string::npos) << content;
}

TEST_F(Aim, a_copy_keeps_what_its_file_held_and_says_what_it_cannot_hold) {
    write("plane.obj", kPlane);
    const std::filesystem::path file = write("copy.json", "mine"), input = folder_ / "plane.obj";
    const auto read = [](const std::filesystem::path& name) {
        std::ifstream stream(name);
        return std::string(std::istreambuf_iterator<char>(stream), {});
    };
    const std::filesystem::path backup = folder_ / "copy.json.bak";
    const Scene scene = load_mesh_scene(input, {});
    save_scene_copy(scene, input, {}, file, {"--background white", "--exposure 1"});
    EXPECT_EQ(read(backup), "mine");
    EXPECT_NE(read(file).find("// Its picture was rendered with --background white --exposure 1,"),
              std::string::npos)
        << read(file);
    save_scene_copy(scene, input, {}, file, {"--background white", "--exposure 1"});
    EXPECT_EQ(read(backup), "mine") << "the same text again replaces nothing";
    save_scene_copy(scene, input, {}, file);
    EXPECT_EQ(read(backup), "mine");
    EXPECT_NE(read(folder_ / "copy.json.bak2").find("--exposure 1"), std::string::npos);
    EXPECT_EQ(load_scene(file).meshes.size(), 1u);
}

TEST_F(Aim, files_are_written_where_links_lead) {
    std::filesystem::create_directories(folder_ / "there");
    write("there/a.txt", "old");
    std::filesystem::create_symlink(folder_ / "there" / "a.txt", folder_ / "link.txt");
    write_text_file(folder_ / "link.txt", "new");
    EXPECT_TRUE(std::filesystem::is_symlink(folder_ / "link.txt"));
    std::ifstream stream(folder_ / "there" / "a.txt");
    EXPECT_EQ(std::string(std::istreambuf_iterator<char>(stream), {}), "new");
    std::filesystem::create_symlink("there/b.txt", folder_ / "waits.txt");
    write_text_file(folder_ / "waits.txt", "first");
    EXPECT_TRUE(std::filesystem::is_symlink(folder_ / "waits.txt"));
    EXPECT_TRUE(std::filesystem::exists(folder_ / "there" / "b.txt")) << "a link to what is not there yet";
}

TEST_F(Aim, a_copy_keeps_names_that_look_like_vectors) {
    const std::string name = R"(a [1 2,3] "b" [4, 5].obj)";
    const std::filesystem::path input = write(name, kPlane);
    const std::filesystem::path file = folder_ / "copy.json";
    save_scene_copy(load_mesh_scene(input, {}), input, {}, file);
    EXPECT_EQ(load_scene(file).meshes.size(), 1u);
}

TEST_F(Aim, a_ground_takes_no_name_and_no_file_of_others) {
    write("plane.obj", kPlane);
    const std::filesystem::path input =
        write("s.json", R"({"materials": {"ground": {"base_color": [1, 0, 0]}},
        "meshes": {"ground": {"file": "plane.obj"}},
        "objects": [{"name": "ground", "mesh": "ground", "material": "ground"}]})");
    AimOptions aim;
    aim.ground = Ground::plane;
    Scene scene = load_scene(input);
    aim_scene(scene, aim, 1);
    const std::filesystem::path file = folder_ / "copy.json";
    save_scene_copy(scene, input, {}, file);
    save_scene_copy(scene, input, {}, file); // over its own files
    const Scene read = load_scene(file);
    ASSERT_EQ(read.objects.size(), 2u);
    EXPECT_EQ(read.materials[read.objects[0].material].base_color, (Vec3f{1, 0, 0}));
    EXPECT_EQ(read.materials[read.objects[1].material].base_color, (Vec3f{0.5f, 0.5f, 0.5f}));
    EXPECT_EQ(read.meshes[read.objects[0].mesh].positions, scene.meshes[0].positions);
    write("copy_ground-2.obj", "mine");
    EXPECT_THROW(save_scene_copy(scene, input, {}, file), Error);
}

TEST_F(Aim, a_camera_is_placed_or_framed) {
    const std::filesystem::path input = write("plane.obj", kPlane);
    AimOptions aim;
    aim.from = Vec3f{0, 0, 100}, aim.frame_all = true;
    Scene scene = load_mesh_scene(input, {});
    EXPECT_THROW(aim_scene(scene, aim, 1), Error);
    aim.frame_all = false, aim.view = View::back;
    EXPECT_THROW(aim_scene(scene, aim, 1), Error);
}

} // namespace relief
