// A map with values of 1e38 is named by every verb that reads it.
#include "command.h"
#include "relief/io.h"

namespace relief::cli {
namespace {

class FarMap : public CommandTest {
  protected:
    void SetUp() override {
        CommandTest::SetUp();
        Image image = read_image(folder_ / "bump.exr");
        const auto red = *image.find_channel("R");
        for (int y = 0; y < image.height; ++y)
            for (int x = 0; x < image.width; ++x) image.at(x, y, red) = 1e38f;
        write_image(image, folder_ / "far.exr");
    }
};

TEST_F(FarMap, is_named_by_all_verbs) {
    for (const std::vector<std::string>& line :
         {std::vector<std::string>{"render", "plane.obj", "--vdm", "far.exr", "--size", "8x8", "-o", "o.exr"},
          {"inspect", "plane.obj", "--vdm", "far.exr"},
          {"inspect", "far.exr", "-o", "check.png"},
          {"convert", "far.exr", "--to-axes", "b,t,n", "-o", "o.exr"},
          {"convert", "far.exr", "-o", "o.png"},
          {"convert", "plane.obj", "--vdm", "far.exr", "--level", "1", "-o", "o.obj"}}) {
        const CommandResult result = run(line);
        EXPECT_EQ(result.exit_code, 3) << line[0] << ' ' << line[1] << result.errors;
        EXPECT_TRUE(contains(result.errors, "far.exr")) << line[0] << ' ' << line[1] << result.errors;
        EXPECT_TRUE(contains(result.errors, "1e+38")) << result.errors;
    }
    const CommandResult inspected = run({"inspect", "far.exr"});
    EXPECT_EQ(inspected.exit_code, 3);
    EXPECT_TRUE(contains(inspected.output, "error: E-FAR: a displacement of 1e+38 at")) << inspected.output;
    EXPECT_EQ(run({"inspect", "far.exr", "--vdm-scale", "1e-38"}).exit_code, 0);
}

} // namespace
} // namespace relief::cli
