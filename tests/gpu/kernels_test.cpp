// Figures of drivers come under their own names and, where they mean the same, under one.
#include "gpu/kernels.h"

#include <utility>

#include <gtest/gtest.h>

#include "relief/devices.h"
#include "relief/error.h"

namespace relief::gpu {
namespace {

using vulkan::KernelProgram;

KernelReport make_report(KernelProgram program, std::vector<uint32_t> constants = {64}) {
    KernelReport report;
    report.device = "a device", report.driver = "a driver";
    report.constant_names = {{0, "group_size"}, {7, "smooth"}};
    report.cases = {{"plain", "the plainest"}, {"other", "another"}};
    report.kernels.push_back({{"walk", "", std::move(constants), {std::move(program)}}, {"plain", "other"}});
    return report;
}

const KernelProgram kOfRadv{"Compute Shader",
                            64,
                            {{"VGPRs", "registers", uint64_t(48)},
                             {"Spilled VGPRs", "spilled", uint64_t(3)},
                             {"Scratch size", "Private memory in bytes per subgroup", uint64_t(65536)},
                             {"Subgroups per SIMD", "at once", uint64_t(20)},
                             {"Hash", "of the code", uint64_t(77)}}};

TEST(Kernels, have_figures_under_one_name_and_under_that_of_the_driver) {
    const Value list = describe_kernels(make_report(kOfRadv));
    const Value& row = list["kernels"][0];
    EXPECT_EQ(row["registers"].get<int>(), 48);
    EXPECT_EQ(row["spills"].get<int>(), 3);
    EXPECT_EQ(row["waves"].get<int>(), 20);
    EXPECT_EQ(row["scratch_bytes"].get<int>(), 1024) << "of an invocation, not of a wave";
    EXPECT_EQ(row["reported"]["Scratch size"].get<int>(), 65536);
    EXPECT_EQ(row["reported"]["Hash"].get<int>(), 77);
    EXPECT_FALSE(row.contains("latency")) << "the driver tells nothing of it";
    EXPECT_EQ(list["figures"].text_or_empty("Hash"), "of the code");
    EXPECT_EQ(list["cases"].text_or_empty("other"), "another");
}

TEST(Kernels, of_another_driver_have_the_same_names) {
    const KernelProgram program{
        "main", 32, {{"Register Count", "", uint64_t(40)}, {"Local Memory", "", uint64_t(16)}}};
    const Value list = describe_kernels(make_report(program));
    EXPECT_EQ(list["kernels"][0]["registers"].get<int>(), 40);
    EXPECT_EQ(list["kernels"][0]["scratch_bytes"].get<int>(), 16);
}

TEST(Kernels, name_the_constants_that_are_on) {
    const Value list = describe_kernels(make_report(kOfRadv, {64, 5, 0, kNoIndex, 0, 0, 0, 1}));
    const Value& constants = list["kernels"][0]["constants"];
    EXPECT_EQ(constants.members().size(), 3u);
    EXPECT_EQ(constants["group_size"].get<int>(), 64);
    EXPECT_EQ(constants["1"].get<int>(), 5);
    EXPECT_EQ(constants["smooth"].get<int>(), 1);
}

TEST(Kernels, are_a_table_of_what_the_driver_tells) {
    const std::string table = print_kernels(describe_kernels(make_report(kOfRadv)));
    EXPECT_EQ(table, "a device, a driver\n"
                     "kernel  case      registers  spills  scratch  waves\n"
                     "walk    plain +1         48       3     1024     20\n");
}

TEST(Kernels, are_refused_where_the_driver_tells_nothing) {
    for (const DeviceInfo& device : vulkan_devices()) {
        if (device.driver.find("llvmpipe Mesa 22.3") == std::string::npos) continue;
        RenderSettings settings;
        settings.device.index = device.index;
        try {
            list_kernels(settings, [](const std::string&) {});
            FAIL() << "lavapipe of Mesa 22.3 has no such extension";
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::device_missing);
            EXPECT_NE(error.message().find("VK_KHR_pipeline_executable_properties"), std::string::npos);
            EXPECT_FALSE(error.hint().empty());
        }
        return;
    }
    GTEST_SKIP() << "there is no lavapipe of Mesa 22.3";
}

} // namespace
} // namespace relief::gpu
