// The picture of a mesh alone: its ground and backdrop, and what its size and a saved scene leave as they
// are.
#include <algorithm>
#include <cmath>

#include "command.h"
#include "relief/io.h"

namespace relief::cli {
namespace {

class LookTest : public CommandTest {
  protected:
    void SetUp() override {
        CommandTest::SetUp();
        write_box("box.obj", 1), write_box("large.obj", 1000);
    }

    void write_box(const std::string& name, int size) {
        std::string text;
        for (int k = 0; k < 8; ++k)
            text += "v " + std::to_string(k & 1 ? size : -size) + " " + std::to_string(k & 2 ? size : -size) +
                    " " + std::to_string(k & 4 ? size : -size) + "\n";
        write(name, text + "f 1 5 7 3\nf 2 4 8 6\nf 1 2 6 5\nf 3 7 8 4\nf 1 3 4 2\nf 5 6 8 7\n");
    }

    Image render(const std::string& mesh, const std::vector<std::string>& more) {
        std::vector<std::string> words = {"render", mesh, "--size", "32x24", "-o", "look.exr"};
        words.insert(words.end(), more.begin(), more.end());
        const CommandResult result = run(words);
        EXPECT_EQ(result.exit_code, 0) << result.errors;
        return read_image(folder_ / "look.exr");
    }
};

/// Green of the leftmost columns, where neither the box nor its shadow is: one mean a row.
std::vector<float> measure_rows(const Image& image) {
    constexpr int kColumns = 4;
    const size_t green = *image.find_channel("G");
    std::vector<float> rows;
    for (int y = 0; y < image.height; ++y) {
        float sum = 0;
        for (int x = 0; x < kColumns; ++x) sum += image.at(x, y, green);
        rows.push_back(sum / kColumns);
    }
    return rows;
}

float find_largest_step(const std::vector<float>& rows) {
    float largest = 0;
    for (size_t y = 1; y < rows.size(); ++y)
        largest = std::max(largest, std::fabs(rows[y] - rows[y - 1]) / std::max(rows[y], rows[y - 1]));
    return largest;
}

TEST_F(LookTest, a_ground_has_no_horizon_from_any_side_and_distance) {
    const std::vector<std::vector<std::string>> cameras = {{"--view", "front"},
                                                           {"--view", "back"},
                                                           {"--view", "left"},
                                                           {"--view", "right"},
                                                           {"--view", "top"},
                                                           {"--view", "three-quarter"},
                                                           {"--from", "0,60,200", "--fov", "2"},
                                                           {"--from", "0,0.2,-3", "--fov", "60"},
                                                           {"--view", "front", "--light", "sun:-30,50"}};
    for (std::vector<std::string> camera : cameras) {
        camera.insert(camera.end(), {"--ground", "--spp", "256", "--bounces", "1"});
        EXPECT_LT(find_largest_step(measure_rows(render("box.obj", camera))), 0.05f)
            << camera[0] << " " << camera[1];
    }
    // What a horizon is: the same under another environment.
    render("box.obj", {"--view", "front", "--ground", "--spp", "1", "--save-scene", "grey.json"});
    std::string scene = read("grey.json");
    const size_t file = scene.find("\"file\": \"grey_studio.exr\",");
    ASSERT_NE(file, std::string::npos) << scene;
    write("grey.json", scene.erase(file, std::string("\"file\": \"grey_studio.exr\",").size()));
    EXPECT_GT(find_largest_step(measure_rows(render("grey.json", {"--spp", "256", "--bounces", "1"}))), 0.2f);
}

TEST_F(LookTest, a_mesh_without_ground_lies_before_a_soft_backdrop) {
    for (const char* view : {"front", "three-quarter", "top"}) {
        const Image image = render("box.obj", {"--view", view, "--spp", "4"});
        EXPECT_LT(find_largest_step(measure_rows(image)), 0.15f) << view;
        EXPECT_EQ(image.at(0, 0, *image.find_channel("A")), 0) << "it is no object";
    }
}

TEST_F(LookTest, a_mesh_of_another_size_makes_the_same_picture) {
    const std::vector<std::string> more = {"--view", "three-quarter", "--ground", "--spp", "64"};
    const Image small = render("box.obj", more), large = render("large.obj", more);
    const size_t green = *small.find_channel("G");
    double difference = 0, sum = 0;
    for (int y = 0; y < small.height; ++y)
        for (int x = 0; x < small.width; ++x) {
            difference += std::fabs(small.at(x, y, green) - large.at(x, y, green));
            sum += small.at(x, y, green);
        }
    EXPECT_LT(difference, 0.01 * sum);
}

TEST_F(LookTest, no_side_is_burnt_or_black_all_around) {
    const CommandResult turn = run({"render", "box.obj", "--view", "three-quarter", "--turntable", "6",
                                    "--size", "32x24", "--spp", "32", "-o", "turn.exr"});
    ASSERT_EQ(turn.exit_code, 0) << turn.errors;
    for (int k = 1; k <= 6; ++k) {
        const Image image = read_image(folder_ / ("turn.000" + std::to_string(k) + ".exr"));
        const size_t green = *image.find_channel("G"), alpha = *image.find_channel("A");
        for (int y = 0; y < image.height; ++y)
            for (int x = 0; x < image.width; ++x) {
                if (image.at(x, y, alpha) < 1) continue;
                EXPECT_GT(image.at(x, y, green), 0.02f) << k << ": " << x << ", " << y;
                EXPECT_LT(image.at(x, y, green), 1.5f) << k << ": " << x << ", " << y;
            }
    }
}

} // namespace
} // namespace relief::cli
