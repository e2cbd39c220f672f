#include "bench/cycles_log.h"

#include <gtest/gtest.h>

#include "relief/error.h"

namespace relief::bench {
namespace {

/// Lines of a log of Blender 3.4.1 with its own times, some left out.
std::vector<LogLine> make_log() {
    const std::string state = " (Peak 326.01M) | Time:00:00.00 | Mem:0.00M, Peak:";
    return {
        {0.4, "Blender 3.4.1"},
        {0.9, "relief: blender 3.4.1"},
        {1.0, "relief: render starts"},
        {1.0, "Fra:1 Mem:9.84M" + state + "0.00M | Scene, ViewLayer | Synchronizing object | rock"},
        {1.15, "Fra:1 Mem:103.02M" + state + "0.00M | Scene, ViewLayer | Updating Displacement Images"},
        {1.15, "Fra:1 Mem:103.02M" + state + "0.00M | Scene, ViewLayer | Updating Images | Loading rock.exr"},
        {1.25, "Fra:1 Mem:119.03M" + state + "16.00M | Scene, ViewLayer | Updating Mesh | Computing normals"},
        {2.0, "Fra:1 Mem:266.25M" + state + "281.17M | Scene, ViewLayer | Updating Images"},
        {2.0, "Fra:1 Mem:266.25M" + state + "281.17M | Scene, ViewLayer | Updating Images | Loading sky.exr"},
        {2.02, "Fra:1 Mem:268.25M" + state + "283.17M | Scene, ViewLayer | Updating Camera Volume"},
        {2.39, "Fra:1 Mem:269.76M" + state + "284.92M | Scene, ViewLayer | Sample 0/16"},
        {3.12, "Fra:1 Mem:283.82M (Peak 283.82M) | Time:00:03.12 | Remaining:00:26.80 | Mem:298.99M, "
               "Peak:298.99M | Scene, ViewLayer | Sample 1/16"},
        {8.4, "Fra:1 Mem:297.88M" + state + "298.99M | Scene, ViewLayer | Sample 16/16"},
        {8.4, "Fra:1 Mem:297.88M" + state + "298.99M | Scene, ViewLayer | Finished"},
        {8.5, "relief: render ends"},
        {8.5, "relief: peak resident 725385216"},
        {8.6, ""},
        {8.6, "Blender quit"}};
}

TEST(CyclesLog, counts_from_the_call_of_the_render) {
    const CyclesTimes times = read_cycles_log(make_log());
    EXPECT_EQ(times.version, "3.4.1");
    EXPECT_NEAR(times.synchronisation_s, 1.39, 1e-9);
    EXPECT_NEAR(times.first_sample_s, 2.12, 1e-9);
    EXPECT_NEAR(times.render_s, 7.5, 1e-9);
}

TEST(CyclesLog, adds_up_the_reading_of_images) {
    EXPECT_NEAR(read_cycles_log(make_log()).images_s, 0.1 + 0.02, 1e-9);
}

TEST(CyclesLog, tells_both_peaks_of_memory) {
    const CyclesTimes times = read_cycles_log(make_log());
    EXPECT_EQ(times.cycles_peak_bytes, uint64_t(298.99 * (1 << 20)));
    EXPECT_EQ(times.resident_peak_bytes, 725385216u);
}

TEST(CyclesLog, what_is_missing_is_an_error_that_quotes_the_end) {
    for (const char* words : {"render starts", "render ends", "peak resident", "Sample 1"}) {
        std::vector<LogLine> lines;
        for (const LogLine& line : make_log())
            if (line.text.find(words) == std::string::npos) lines.push_back(line);
        try {
            read_cycles_log(lines);
            FAIL() << words;
        } catch (const Error& error) {
            EXPECT_NE(std::string(error.what()).find("Blender quit"), std::string::npos);
        }
    }
    EXPECT_THROW(read_cycles_log({}), Error);
}

} // namespace
} // namespace relief::bench
