// Scene files whose values change from frame to frame.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "io/scene/keyed_values.h"
#include "io/scene/scene_reader.h"
#include "io/scene_files.h"
#include "math/affine.h"
#include "math/vec.h"
#include "relief/shot.h"

namespace relief {

double find_fov(const std::string& keyed, double frame) {
    const Json document = parse_json(R"({"camera": {"fov_degrees": )" + keyed + "}}", "s.json");
    return evaluate_frame(document, frame, "s.json")["camera"]["fov_degrees"].get<double>();
}

TEST(KeyedValues, lie_on_lines_between_their_keys_and_stay_outside) {
    const char* keyed = R"({"keys": [[1, 10], [5, 30], [6, 20]]})";
    EXPECT_EQ(find_fov(keyed, -4), 10);
    EXPECT_EQ(find_fov(keyed, 1), 10);
    EXPECT_EQ(find_fov(keyed, 2), 15);
    EXPECT_EQ(find_fov(keyed, 5), 30);
    EXPECT_EQ(find_fov(keyed, 5.5), 25);
    EXPECT_EQ(find_fov(keyed, 9), 20);
}

TEST(KeyedValues, hold_until_the_next_key_where_they_step) {
    const char* keyed = R"({"keys": [[1, 10], [5, 30]], "interpolation": "step"})";
    EXPECT_EQ(find_fov(keyed, 4.99), 10);
    EXPECT_EQ(find_fov(keyed, 5), 30);
}

TEST(KeyedValues, are_smooth_through_their_keys_and_overshoot_none) {
    const char* keyed =
        R"({"keys": [[0, 10], [4, 20], [8, 40], [12, 40], [16, 30]], "interpolation": "smooth"})";
    constexpr double kStep = 1e-4;
    for (const double frame : {4.0, 8.0, 12.0}) {
        const double before = (find_fov(keyed, frame) - find_fov(keyed, frame - kStep)) / kStep;
        const double after = (find_fov(keyed, frame + kStep) - find_fov(keyed, frame)) / kStep;
        EXPECT_NEAR(before, after, 1e-3) << frame;
    }
    EXPECT_NEAR((find_fov(keyed, 4 + kStep) - 20) / kStep, 30.0 / 8, 1e-3) << "Catmull and Rom";
    EXPECT_NEAR((find_fov(keyed, kStep) - 10) / kStep, 0, 1e-3) << "at rest at the ends";
    for (double frame = 8; frame <= 12; frame += 0.25) EXPECT_EQ(find_fov(keyed, frame), 40);
    for (double frame = 0; frame <= 16; frame += 0.25) EXPECT_LE(find_fov(keyed, frame), 40);
}

TEST(KeyedValues, stay_between_their_neighbours_at_any_steps) {
    const char* keyed = R"({"keys": [[1, 0], [11, 0.01], [21, 1], [21.5, 1.001], [90, 2], [90.1, 40]],
                            "interpolation": "smooth"})";
    for (double frame = 1; frame < 90.1; frame += 0.05) {
        const double value = find_fov(keyed, frame);
        EXPECT_GE(value, 0) << frame;
        if (frame >= 11) EXPECT_GE(value, 0.01) << frame;
        if (frame <= 21) EXPECT_LE(value, 1) << frame;
        if (frame <= 90) EXPECT_LE(value, 2) << frame;
    }
}

Affine find_turn(const std::string& keyed, double frame) {
    const Json document =
        parse_json(R"({"objects": [{"transform": {"rotate_degrees": )" + keyed + "}}]}", "s.json");
    const Json turned = evaluate_frame(document, frame, "s.json");
    const Json& angles = turned["objects"][0]["transform"]["rotate_degrees"];
    return make_rotation_degrees({angles[0].get<float>(), angles[1].get<float>(), angles[2].get<float>()});
}

void expect_rotation(const Affine& a, const Affine& b, double frame) {
    for (size_t row = 0; row < 3; ++row) EXPECT_LT(length(a.rows[row] - b.rows[row]), 1e-5f) << frame;
}

TEST(KeyedValues, turn_about_one_axis_as_far_as_their_angles_say) {
    const char* keyed = R"({"keys": [[0, [0, 0, 10]], [10, [0, 720, 10]]]})";
    for (const double frame : {1.0, 2.5, 7.0})
        expect_rotation(find_turn(keyed, frame), make_rotation_degrees({0, float(72 * frame), 10}), frame);
}

/// Angle of the rotation that takes `a` to `b`.
double find_angle_between(const Affine& a, const Affine& b) {
    double trace = 0;
    for (size_t row = 0; row < 3; ++row) trace += double(dot(a.rows[row], b.rows[row]));
    return std::acos(std::min((trace - 1) / 2, 1.0)) * 180 / std::numbers::pi;
}

TEST(KeyedValues, turn_the_shortest_way_at_one_speed) {
    const char* keyed = R"({"keys": [[0, [30, 20, 10]], [8, [-70, 85, 120]], [9, [90, 90, 90]]]})";
    expect_rotation(find_turn(keyed, 0), make_rotation_degrees({30, 20, 10}), 0);
    expect_rotation(find_turn(keyed, 8), make_rotation_degrees({-70, 85, 120}), 8);
    expect_rotation(find_turn(keyed, 9), make_rotation_degrees({90, 90, 90}), 9);
    const double whole = find_angle_between(find_turn(keyed, 0), find_turn(keyed, 8));
    EXPECT_LE(whole, 180);
    for (int frame = 0; frame < 8; ++frame)
        EXPECT_NEAR(find_angle_between(find_turn(keyed, frame), find_turn(keyed, frame + 1)), whole / 8,
                    0.05);
}

TEST(KeyedValues, refuse_what_makes_no_curve) {
    const auto error_of = [](const std::string& keyed) {
        try {
            find_fov(keyed, 1);
        } catch (const Error& error) {
            return error.where() + ": " + error.message();
        }
        return std::string("taken");
    };
    EXPECT_NE(error_of(R"({"keys": []})").find("camera.fov_degrees.keys: there is no key"),
              std::string::npos);
    EXPECT_NE(error_of(R"({"keys": [[2, 1], [2, 3]]})").find("keys[1]: frame 2 does not come after frame 2"),
              std::string::npos);
    EXPECT_NE(error_of(R"({"keys": [[1, 2], [2, [3]]]})").find("another kind"), std::string::npos);
    EXPECT_NE(error_of(R"({"keys": [[1, 2, 3]]})").find("a key is [frame, value]"), std::string::npos);
    EXPECT_NE(error_of(R"({"keys": [["a", 2]]})").find("keys[0][0]"), std::string::npos);
    EXPECT_NE(error_of(R"({"keys": [[1, 2]], "interpolation": "cubic"})").find("no interpolation 'cubic'"),
              std::string::npos);
    EXPECT_NE(error_of(R"({"keys": [[1, "a"]], "interpolation": "linear"})").find("only numbers"),
              std::string::npos);
    EXPECT_NE(error_of(R"({"keys": [[1, 2]], "easing": 1})").find("easing"), std::string::npos);
}

TEST(FrameNumbers, are_lists_and_ranges) {
    EXPECT_EQ(parse_frames("3"), (std::vector<int>{3}));
    EXPECT_EQ(parse_frames("1-7x3,5,4-5"), (std::vector<int>{1, 4, 7, 5}));
    for (const char* text : {"", "a", "-0", "1-", "5-1", "1-5x0", "1,,2", "-3", "1000001", "1 2"})
        EXPECT_THROW(parse_frames(text), Error) << text;
}

TEST(FrameNumbers, are_put_into_names) {
    EXPECT_EQ(name_frame("out/shot.####.exr", 12), "out/shot.0012.exr");
    EXPECT_EQ(name_frame("out/shot.##.exr", 1234), "out/shot.1234.exr");
    EXPECT_EQ(name_frame("out.####/shot.exr", 7), "out.####/shot.0007.exr");
    EXPECT_EQ(name_frame("a#1.exr", 7), "a#1.0007.exr");
    EXPECT_EQ(name_frame("a.0007.exr", 7), "a.0007.exr");
    EXPECT_EQ(name_frame("a.0007.exr", 8), "a.0007.0008.exr");
    EXPECT_EQ(name_frame("0007.exr", 7), "0007.0007.exr");
    EXPECT_EQ(fill_frame_number("wave.###.exr", 3.75), "wave.003.exr");
    EXPECT_EQ(fill_frame_number("take.##/#wave.####.exr", 3), "take.03/#wave.0003.exr");
}

constexpr const char* kMovingScene = R"({"render": {"frames": "2-4", "spp": 3},
  "camera": {"from": {"keys": [[1, [0, 0, 5]], [5, [4, 0, 5]]]}, "to": [0, 0, 0]},
  "materials": {"clay": {"roughness": {"keys": [[2, 0.5], [3, 0.5], [4, 1]]}}},
  "displacements": {"ear": {"file": "map.exr", "type": "vector"}},
  "meshes": {"plane": {"file": "plane.obj"}},
  "objects": [{"mesh": "plane", "displacement": "ear", "material": "clay"}]})";

class Shots : public SceneFiles {
  protected:
    Shot make_shot(const std::string& text) {
        write("s.json", text);
        return Shot(folder_ / "s.json");
    }
};

TEST_F(Shots, are_read_frame_by_frame) {
    Shot shot = make_shot(kMovingScene);
    EXPECT_TRUE(shot.is_animated());
    EXPECT_EQ(shot.frames(), (std::vector<int>{2, 3, 4}));
    const Scene second = shot.load(2), fourth = shot.load(4);
    EXPECT_EQ(second.camera.from.x, 1);
    EXPECT_EQ(fourth.camera.from.x, 3);
    EXPECT_EQ(fourth.materials[0].roughness, 1);
    EXPECT_EQ(fourth.displacements[0].tiles[0].texture, second.displacements[0].tiles[0].texture)
        << "the map was read again";
    EXPECT_NE(second.hash, fourth.hash);
    EXPECT_EQ(load_scene(folder_ / "s.json").hash, second.hash) << "the first frame";
}

TEST_F(Shots, know_where_the_camera_alone_moves) {
    Shot shot = make_shot(kMovingScene);
    EXPECT_FALSE(shot.find_view(2).has_value()) << "nothing is loaded";
    shot.load(2);
    const auto view = shot.find_view(3);
    ASSERT_TRUE(view.has_value());
    EXPECT_EQ(view->camera.from.x, 2);
    EXPECT_NE(view->scene_hash, 0u);
    EXPECT_FALSE(shot.find_view(4).has_value()) << "the material changes too";
    EXPECT_EQ(shot.load(3).hash, view->scene_hash);
}

TEST_F(Shots, number_their_files) {
    write_pixels<float>("wave.0001.exr", 1, 1, 3, OIIO::TypeDesc::FLOAT, {1, 2, 3});
    write_pixels<float>("wave.0002.exr", 1, 1, 3, OIIO::TypeDesc::FLOAT, {4, 5, 6});
    Shot shot = make_shot(R"({"displacements": {"w": {"file": "wave.####.exr", "type": "vector"}},
      "meshes": {"plane": {"file": "plane.obj"}}, "objects": [{"mesh": "plane", "displacement": "w"}]})");
    EXPECT_TRUE(shot.is_animated());
    EXPECT_EQ(shot.load(1).displacements[0].tiles[0].texture->floats[0], 1);
    EXPECT_EQ(shot.load(2).displacements[0].tiles[0].texture->floats[0], 4);
    EXPECT_FALSE(shot.find_view(1).has_value());
    EXPECT_HAS(message_of([&] { shot.load(3); }), "wave.0003.exr");
}

TEST_F(Shots, refuse_keys_where_nothing_lies_between) {
    EXPECT_HAS(error_of(with_object(
                   R"(, "transform": {"matrix": {"keys": [[1, [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0]]]}})")),
               "translate, rotate_degrees and scale");
    EXPECT_HAS(error_of(R"({"render": {"frames": "1-"}})"), "render.frames");
}

} // namespace relief
