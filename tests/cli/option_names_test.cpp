// Settings of the library, as users of the command read of them.
#include "common/option_names.h"

#include <string>

#include <gtest/gtest.h>

#include "command.h"
#include "common/whole_names.h"
#include "render_warnings.h"

namespace relief::cli {
namespace {

TEST(OptionNames, replace_names_of_settings_and_their_equals_signs) {
    EXPECT_EQ(name_options("render it in parts with image.crop and merge them"),
              "render it in parts with --crop and merge them");
    EXPECT_EQ(name_options("surface.lod = field, or experiment.method = compute or fragment"),
              "--lod field, or --method compute or fragment");
    EXPECT_EQ(name_options("the same image.width and image.height"), "the same --size");
    EXPECT_EQ(name_options("vulkan_devices() lists them, 0 to 3"), "`relief devices` lists them, 0 to 3");
}

TEST(OptionNames, leave_other_names_alone) {
    for (const char* text : {"", "read maps/image.crop", "surface.level.exr is there", "my_image.spp = 3"})
        EXPECT_EQ(name_options(text), text);
}

TEST(OptionNames, are_keys_of_a_scene_file_for_what_stands_there) {
    const std::string text = "write displacement.wrap = repeat; surface.cache_bytes sets its cap";
    EXPECT_EQ(name_setting(text, true), "write --wrap repeat; --bottom-cache sets its cap");
    EXPECT_EQ(name_setting(text, false), "write \"wrap\": \"repeat\"; --bottom-cache sets its cap");
}

TEST(OptionNames, are_keys_alone_where_one_displacement_is_seen) {
    EXPECT_EQ(name_map_keys("write displacement.axes = t,n,b (or displacement.scale)"),
              "write axes = t,n,b (or scale)");
    for (const char* text : {"displacement 'displacement.1001' of displacement.exr", "my-displacement.axes",
                             "displacement.axes.exr", "maps/displacement.axes"})
        EXPECT_EQ(name_map_keys(text), text);
}

class OptionNamesOfCommand : public CommandTest {};

TEST_F(OptionNamesOfCommand, are_what_the_hint_of_an_error_gives) {
    const CommandResult result = run({"render", "plane.obj", "--engine", "vulkan", "--method", "hybrid",
                                      "--lod", "ray", "-o", "plane.exr"});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_NE(result.errors.find("hint: --lod field, or --method compute or fragment"), std::string::npos)
        << result.errors;
}

} // namespace
} // namespace relief::cli
