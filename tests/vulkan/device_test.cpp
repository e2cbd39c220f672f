// Which devices there are, what they refuse, what they keep between runs.
#include <filesystem>
#include <fstream>
#include <iterator>

#include <gtest/gtest.h>
#include <unistd.h>

#include "relief/devices.h"
#include "relief/error.h"
#include "vulkan/device/commands.h"
#include "vulkan/gpu_fixture.h"
#include "vulkan/layout/bindings.h"
#include "vulkan/test_shaders.h"

namespace relief::vulkan::tests {
namespace {

class Devices : public GpuTest {};

TEST_F(Devices, are_listed_with_what_they_lack) {
    const std::vector<DeviceInfo> devices = vulkan_devices();
    ASSERT_FALSE(devices.empty());
    const DeviceDescription& used = device().description();
    EXPECT_TRUE(used.missing.empty());
    const DeviceInfo& listed = devices.at(used.index);
    EXPECT_EQ(listed.index, int(used.index));
    EXPECT_EQ(listed.name, used.name);
    EXPECT_EQ(listed.kind, used.is_cpu ? "cpu" : "gpu");
    EXPECT_EQ(listed.memory_bytes, used.memory_bytes);
}

TEST_F(Devices, tell_their_limits) {
    EXPECT_GE(device().max_buffer_bytes(), 1u << 27);
    EXPECT_GE(device().max_texel_count(), 1u << 24);
    EXPECT_GE(device().max_group_size(), 256u);
    EXPECT_GE(device().resident_group_count(), 1u);
    EXPECT_GT(device().available_bytes(), 0u);
    EXPECT_LE(device().available_bytes(), device().description().memory_bytes);
}

TEST_F(Devices, that_do_not_exist_are_refused) {
    try {
        const Device none({.index = 1000});
        FAIL() << "made a device that does not exist";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::device_missing);
        EXPECT_NE(error.message().find("1000"), std::string::npos) << error.what();
    }
}

std::vector<char> read_file(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// Runs one kernel on a device of its own with this cache; true if the result is right.
bool run_with_cache(const std::filesystem::path& path) {
    const Device device(
        {.index = get_test_device_index(), .pipeline_cache = path, .is_validated = true, .is_shared = false});
    const Buffer values(device, {.name = "values", .bytes = 256});
    BindingTable bindings(device);
    bindings.bind(scalar::kBindFilm, values);
    const Kernel kernel = make_test_kernel(device, "add_index");
    vulkan::Commands commands(device, bindings);
    commands.fill(values, 0, 256, 0);
    commands.dispatch(kernel, 64, std::array<uint32_t, 2>{64, 1});
    commands.run();
    return values.download<uint32_t>(64)[63] == 63 && device.validation_messages().empty();
}

class PipelineCaches : public GpuTest {
  protected:
    PipelineCaches()
        : folder_(std::filesystem::path(testing::TempDir()) / ("relief_cache_" + std::to_string(getpid()))),
          path_(folder_ / "pipelines.bin") {}
    ~PipelineCaches() override { std::filesystem::remove_all(folder_); }

    std::filesystem::path folder_, path_;
};

TEST_F(PipelineCaches, are_written_and_read_again) {
    EXPECT_TRUE(run_with_cache(path_));
    const std::vector<char> first = read_file(path_);
    EXPECT_GT(first.size(), 32u);
    EXPECT_TRUE(run_with_cache(path_));
    EXPECT_EQ(read_file(path_), first);
    const auto files = std::filesystem::directory_iterator(folder_);
    EXPECT_EQ(std::distance(begin(files), end(files)), 1) << "a temporary file was left";
}

TEST_F(PipelineCaches, that_are_damaged_are_ignored_and_replaced) {
    ASSERT_TRUE(run_with_cache(path_));
    const std::vector<char> good = read_file(path_);
    const auto write = [&](std::vector<char> data) {
        std::ofstream(path_, std::ios::binary).write(data.data(), std::streamsize(data.size()));
    };
    std::vector<char> flipped = good;
    flipped[good.size() / 2] ^= 1;
    std::vector<char> foreign = good;
    foreign[16] ^= 1; // the device's UUID
    for (const std::vector<char>& data :
         {std::vector<char>(), std::vector<char>(100, 'x'), flipped, foreign,
          std::vector<char>(good.begin(), good.begin() + std::ptrdiff_t(good.size() - 1))}) {
        write(data);
        EXPECT_TRUE(run_with_cache(path_));
        const std::vector<char> replaced = read_file(path_);
        EXPECT_NE(replaced, data);
        EXPECT_TRUE(run_with_cache(path_));
        EXPECT_EQ(read_file(path_), replaced) << "it does not serve";
    }
}

TEST_F(PipelineCaches, that_cannot_be_written_stop_nothing) {
    EXPECT_TRUE(run_with_cache("/proc/nowhere/pipelines.bin"));
}

} // namespace
} // namespace relief::vulkan::tests
