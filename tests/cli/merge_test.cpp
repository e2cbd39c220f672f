// merge: parts that make a whole picture, and parts that do not.
#include "command.h"
#include "relief/io.h"

namespace relief::cli {
namespace {

class Merge : public CommandTest {
  protected:
    void render_ok(const std::string& output, const std::vector<std::string>& more) {
        const CommandResult result = render_bump(output, more);
        ASSERT_EQ(result.exit_code, 0) << result.errors;
    }
    void expect_refused(std::vector<std::string> parts, const std::string& message) {
        parts.insert(parts.begin(), "merge");
        parts.insert(parts.end(), {"-o", "whole.exr"});
        const CommandResult refused = run(parts);
        EXPECT_EQ(refused.exit_code, 3) << refused.errors;
        EXPECT_NE(refused.errors.find(message), std::string::npos) << refused.errors;
        EXPECT_NE(refused.errors.find("--allow-gaps"), std::string::npos) << refused.errors;
        EXPECT_FALSE(exists("whole.exr"));
        parts.emplace_back("--allow-gaps");
        const CommandResult joined = run(parts);
        EXPECT_EQ(joined.exit_code, 0) << joined.errors;
        EXPECT_NE(joined.errors.find(message), std::string::npos) << joined.errors;
        EXPECT_TRUE(exists("whole.exr"));
        std::filesystem::remove(folder_ / "whole.exr");
    }
};

TEST_F(Merge, names_the_rows_of_tiles_that_are_missing) {
    // 24 x 16 pixels: bands of 5, 5 and 6 rows.
    for (const char* tile : {"0/3", "1/3", "2/3"})
        render_ok(std::string("t") + tile[0] + ".exr", {"--tile", tile});
    expect_refused({"t0.exr", "t2.exr"}, "missing: rows 5 to 9 (--crop 0,5,24,10)");
    expect_refused({"t1.exr", "t0.exr"}, "missing: rows 10 to 15 (--crop 0,10,24,16)");
    const CommandResult black = run({"merge", "t0.exr", "t2.exr", "-o", "black.png", "--allow-gaps"});
    EXPECT_EQ(black.exit_code, 2) << black.errors;
    EXPECT_FALSE(exists("black.png"));
    const CommandResult whole = run({"merge", "t0.exr", "t1.exr", "t2.exr", "-o", "whole.exr"});
    EXPECT_EQ(whole.exit_code, 0) << whole.errors;
    EXPECT_EQ(whole.errors, "");
}

TEST_F(Merge, names_the_samples_that_are_missing) {
    for (const char* range : {"0:1", "1:3", "3:4"})
        render_ok(std::string("s") + range[0] + ".exr", {"--samples", range});
    expect_refused({"s0.exr", "s3.exr"}, "missing: samples 1:3");
    EXPECT_EQ(run({"merge", "s0.exr", "s3.exr", "-o", "fewer.png", "--allow-gaps"}).exit_code, 0);
    expect_refused({"s3.exr", "s1.exr"}, "missing: samples 0:1");
    render_ok("upper.exr", {"--samples", "1:4", "--crop", "0,0,24,9"});
    render_ok("lower.exr", {"--samples", "1:2", "--crop", "0,9,24,16"});
    expect_refused({"s0.exr", "upper.exr", "lower.exr"},
                   "missing: samples 2:4 of rows 9 to 15 (--crop 0,9,24,16)");
}

TEST_F(Merge, a_tile_alone_is_not_the_picture) {
    render_ok("t0.exr", {"--tile", "0/3"});
    render_ok("t1.exr", {"--tile", "1/3"});
    render_ok("t2.exr", {"--tile", "2/3"});
    expect_refused({"t0.exr"}, "missing: rows 5 to 15 (--crop 0,5,24,16)");
    EXPECT_EQ(run({"merge", "t0.exr", "t1.exr", "-o", "two.exr", "--allow-gaps"}).exit_code, 0);
    expect_refused({"two.exr"}, "missing: rows 10 to 15 (--crop 0,10,24,16)");
    EXPECT_EQ(run({"merge", "two.exr", "t2.exr", "-o", "whole.exr"}).errors, "");
}

TEST_F(Merge, tiles_of_one_crop_are_whole) {
    for (const char* tile : {"0/2", "1/2"})
        render_ok(std::string("t") + tile[0] + ".exr", {"--crop", "2,3,20,9", "--tile", tile});
    EXPECT_EQ(run({"merge", "t0.exr", "t1.exr", "-o", "whole.exr"}).errors, "");
    std::filesystem::remove(folder_ / "whole.exr");
    expect_refused({"t1.exr"}, "missing: rows 3 to 5 (--crop 2,3,20,6)");
    render_ok("again.exr", {"--crop", "2,3,20,6"}); // as merge asks for it
    EXPECT_EQ(run({"merge", "again.exr", "t1.exr", "-o", "whole.exr"}).errors, "");
    EXPECT_EQ(run({"merge", "whole.exr", "-o", "same.exr"}).errors, "");
}

TEST_F(Merge, samples_of_a_given_number_are_missed) {
    render_ok("first.exr", {"--samples", "0:1", "--spp", "3"});
    render_ok("rest.exr", {"--samples", "1:3", "--spp", "3"});
    expect_refused({"first.exr"}, "missing: samples 1:3");
    EXPECT_EQ(run({"merge", "first.exr", "rest.exr", "-o", "whole.exr"}).errors, "");
    render_ok("band.exr", {"--samples", "0:1", "--spp", "3", "--tile", "0/2"});
    const CommandResult black = run({"merge", "band.exr", "-o", "black.png", "--allow-gaps"});
    EXPECT_EQ(black.exit_code, 2) << black.errors;
}

TEST_F(Merge, refuses_parts_that_were_rendered_otherwise) {
    render_ok("a.exr", {"--samples", "0:1", "--spp", "2"});
    render_ok("b.exr", {"--samples", "1:2", "--spp", "2", "--bounces", "2", "--structure", "kdtree"});
    render_ok("c.exr", {"--samples", "1:2", "--spp", "2", "--structure", "kdtree"});
    const CommandResult refused = run({"merge", "a.exr", "b.exr", "-o", "whole.exr"});
    EXPECT_EQ(refused.exit_code, 3) << refused.errors;
    EXPECT_NE(refused.errors.find("bounces 2 (there: bounces 1)"), std::string::npos) << refused.errors;
    EXPECT_EQ(run({"merge", "a.exr", "c.exr", "-o", "whole.exr"}).errors, "");
}

TEST_F(Merge, ranges_of_one_crop_are_whole) {
    render_ok("a.exr", {"--samples", "0:1", "--spp", "2", "--crop", "2,3,9,8"});
    render_ok("b.exr", {"--samples", "1:2", "--spp", "2", "--crop", "2,3,9,8"});
    const CommandResult result = run({"merge", "a.exr", "b.exr", "-o", "whole.exr"});
    EXPECT_EQ(result.exit_code, 0) << result.errors;
}

} // namespace
} // namespace relief::cli
