// Options of `relief render` that place the camera, light the scene and show the picture.
#include <filesystem>

#include "command.h"
#include "relief/io.h"

namespace relief::cli {
namespace {

class AimOptionsTest : public CommandTest {
  protected:
    Image render(const std::string& output, const std::vector<std::string>& more) {
        const CommandResult result = render_bump(output, more);
        EXPECT_EQ(result.exit_code, 0) << result.errors;
        return read_image(folder_ / output);
    }
    std::string refuse(const std::vector<std::string>& more) {
        const CommandResult result = render_bump("no.png", more);
        EXPECT_EQ(result.exit_code, 2) << result.errors;
        EXPECT_FALSE(exists("no.png"));
        return result.errors;
    }
};

float count_covered(const Image& image) {
    float sum = 0;
    const size_t alpha = *image.find_channel("A"), channels = image.channels.size();
    for (size_t k = alpha; k < image.pixels.size(); k += channels) sum += image.pixels[k];
    return sum;
}

TEST_F(AimOptionsTest, a_view_frames_and_a_position_is_taken) {
    const float front = count_covered(render("front.exr", {"--view", "front"}));
    const float edge = count_covered(render("left.exr", {"--view", "left"}));
    const float far = count_covered(render("far.exr", {"--from", "0,0,40"}));
    EXPECT_GT(front, 100);
    EXPECT_LT(edge, front) << "a plane from its side";
    EXPECT_LT(far, 10);
    EXPECT_GT(far, 0) << "without --to it looks at the scene";
    EXPECT_GT(count_covered(render("near.exr", {"--from", "0,0,40", "--fov", "5"})), 10 * far);
}

TEST_F(AimOptionsTest, a_zoom_makes_all_larger_from_the_same_place) {
    const float far = count_covered(render("far.exr", {"--from", "0,0,15"}));
    const float near = count_covered(render("near.exr", {"--from", "0,0,15", "--zoom", "3"}));
    EXPECT_GT(near, 7 * far);
    EXPECT_LT(near, 11 * far) << "nine times the area";
}

TEST_F(AimOptionsTest, a_saved_scene_tells_which_options_it_does_not_hold) {
    const CommandResult result = render_bump("a.png", {"--background", "white", "--save-scene", "copy.json"});
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_NE(result.output.find("copy.json; a scene does not hold --background '#ffffff': add that"),
              std::string::npos)
        << result.output;
    const CommandResult whole = render_bump("b.png", {"--save-scene", "copy.json"});
    EXPECT_EQ(whole.output.find("does not hold"), std::string::npos) << whole.output;
}

TEST_F(AimOptionsTest, a_saved_scene_renders_the_same_picture) {
    render("a.exr", {"--view", "three-quarter", "--light", "sun:20,30", "--ground", "--env-strength", "2",
                     "--save-scene", "copy.json"});
    const CommandResult again = run({"render", "copy.json", "-o", "b.exr"});
    ASSERT_EQ(again.exit_code, 0) << again.errors;
    EXPECT_EQ(run({"compare", "a.exr", "b.exr"}).exit_code, 0);
}

/// Coverage of the outermost pixels, and of all.
TEST_F(AimOptionsTest, pictures_of_any_shape_and_angle_show_all_of_a_mesh) {
    const auto expect_framed = [&](const std::vector<std::string>& more) {
        const Image image = render("framed.exr", more);
        const size_t alpha = *image.find_channel("A");
        float rim = 0;
        for (int y = 0; y < image.height; ++y)
            for (int x = 0; x < image.width; ++x)
                if (x == 0 || y == 0 || x + 1 == image.width || y + 1 == image.height)
                    rim += image.at(x, y, alpha);
        EXPECT_EQ(rim, 0) << more[1];
        EXPECT_GT(count_covered(image), 0.1f * float(image.width * image.height)) << more[1];
    };
    expect_framed({"--size", "16x48"});
    expect_framed({"--size", "48x16"});
    expect_framed({"--size", "32x32", "--fov", "10"});
    expect_framed({"--size", "32x32", "--fov", "100"});
}

TEST_F(AimOptionsTest, a_turntable_writes_numbered_pictures_that_differ) {
    const CommandResult result = render_bump("turn.exr", {"--turntable", "3"});
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    for (const char* name : {"turn.0001.exr", "turn.0002.exr", "turn.0003.exr"}) EXPECT_TRUE(exists(name));
    EXPECT_EQ(run({"compare", "turn.0001.exr", "turn.0002.exr"}).exit_code, 7);
    EXPECT_FALSE(exists("turn.exr"));
}

TEST_F(AimOptionsTest, no_picture_of_a_turntable_and_no_ground_replaces_what_is_read) {
    std::filesystem::copy(folder_ / "bump.exr", folder_ / "turn.0002.exr");
    const std::string before = read("turn.0002.exr");
    const CommandResult turn = run({"render", "plane.obj", "--vdm", "turn.0002.exr", "--size", "8x8", "--spp",
                                    "1", "--turntable", "2", "-o", "turn.exr"});
    EXPECT_EQ(turn.exit_code, 2) << turn.errors;
    EXPECT_EQ(read("turn.0002.exr"), before);
    std::filesystem::copy(folder_ / "plane.obj", folder_ / "s_ground.obj");
    const CommandResult ground = run({"render", "s_ground.obj", "--size", "8x8", "--spp", "1", "--ground",
                                      "--save-scene", "s.json", "-o", "g.png"});
    EXPECT_EQ(ground.exit_code, 2) << ground.errors;
    EXPECT_EQ(read("s_ground.obj"), read("plane.obj"));
}

TEST_F(AimOptionsTest, backgrounds_and_exposure_reach_the_png) {
    const Image color = render("colour.png", {"--background", "#ff0080"});
    EXPECT_EQ(color.at(0, 0, 0), 1);
    EXPECT_EQ(color.at(0, 0, 1), 0);
    const Image film = render("film.exr", {"--background", "transparent"});
    EXPECT_EQ(film.at(0, 0, *film.find_channel("R")), 0);
    ASSERT_EQ(run({"merge", "film.exr", "-o", "brighter.png", "--exposure", "3"}).exit_code, 0);
    EXPECT_EQ(run({"merge", "film.exr", "-o", "film.hdr", "--exposure", "3"}).exit_code, 2);
    ASSERT_EQ(run({"merge", "film.exr", "-o", "film.png"}).exit_code, 0);
    const auto sum = [&](const char* name) {
        float total = 0;
        for (const float value : read_image(folder_ / name).pixels) total += value;
        return total;
    };
    EXPECT_GT(sum("brighter.png"), 1.2f * sum("film.png"));
    EXPECT_EQ(read_texture(folder_ / "film.png").channel_count, 4u);
    const Image plain = render("plain.png", {}), bright = render("bright.png", {"--exposure", "+3"});
    EXPECT_GT(bright.at(12, 8, 0), plain.at(12, 8, 0));
    for (const char* name : {"aces", "filmic", "standard", "raw"}) {
        render(std::string(name) + ".png", {"--tonemap", name});
        EXPECT_NE(read("plain.png"), read(std::string(name) + ".png")) << name;
    }
    render("deep.png", {"--png-bits", "16"});
    EXPECT_EQ(read_texture(folder_ / "deep.png").source_type, SampleType::uint16);
}

/// A bump floats above the ground, so that it has no shadow but from the sun.
TEST_F(AimOptionsTest, a_ground_of_shadows_alone_shows_the_background) {
    const std::vector<std::string> view = {"--from", "0,6,6", "--to", "0,0,0", "--light", "sun:60,40"};
    const auto render_ground = [&](const std::string& output, std::vector<std::string> more) {
        more.insert(more.end(), view.begin(), view.end());
        return render(output, more);
    };
    const Image none = render_ground("none.exr", {"--background", "transparent"});
    const Image film = render_ground("film.exr", {"--background", "transparent", "--ground=shadow"});
    EXPECT_GT(count_covered(film), 1.05f * count_covered(none));
    EXPECT_LT(count_covered(film), 0.9f * float(film.width * film.height));
    const Image white = render_ground("white.png", {"--background", "white", "--ground=shadow"});
    const Image plain = render_ground("plain.png", {"--background", "white"});
    float darkened = 0;
    for (size_t k = 0; k < white.pixels.size(); ++k)
        darkened += plain.pixels[k] == 1 && white.pixels[k] < 0.9f;
    EXPECT_GT(darkened, 10);
    render_ground("a.exr", {"--background", "transparent", "--ground=shadow", "--save-scene", "caught.json"});
    ASSERT_EQ(run({"render", "caught.json", "--background", "transparent", "-o", "b.exr"}).exit_code, 0);
    EXPECT_EQ(run({"compare", "a.exr", "b.exr"}).exit_code, 0);
    EXPECT_NE(refuse({"--ground=shadow"}).find("--background transparent"), std::string::npos);
    EXPECT_NE(refuse({"--ground=moon"}).find("--ground=shadow"), std::string::npos);
}

TEST_F(AimOptionsTest, what_cannot_be_is_refused_before_the_render) {
    EXPECT_NE(refuse({"--view", "fornt"}).find("did you mean 'front'"), std::string::npos);
    EXPECT_NE(refuse({"--from", "1,2"}).find("x,y,z"), std::string::npos);
    EXPECT_NE(refuse({"--light", "moon:1,2"}).find("sun:AZIMUTH,ELEVATION"), std::string::npos);
    EXPECT_NE(refuse({"--tonemap", "acess"}).find("did you mean 'aces'"), std::string::npos);
    EXPECT_NE(refuse({"--background", "blue"}).find("#rrggbb"), std::string::npos);
    EXPECT_NE(refuse({"--save-scene", "copy.txt"}).find(".json"), std::string::npos);
    EXPECT_NE(refuse({"--turntable", "2", "--stats", "s.json"}).find("several pictures"), std::string::npos);
    EXPECT_NE(render_bump("a.hdr", {"--background", "transparent"}).errors.find("has no alpha"),
              std::string::npos);
    EXPECT_NE(render_bump("a.hdr", {"--exposure", "1"}).errors.find("radiance is written as it is"),
              std::string::npos);
}

} // namespace
} // namespace relief::cli
