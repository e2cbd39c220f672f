// What Relief says when a device fails. Each suite runs in a process of its own under the fault layer's
// orders (CMakeLists.txt here).
#include <algorithm>

#include <gtest/gtest.h>

#include "relief/devices.h"
#include "relief/error.h"
#include "vulkan/device/commands.h"
#include "vulkan/device/device_internals.h"
#include "vulkan/layout/device_sort.h"

namespace relief::vulkan::tests {
namespace {

/// The error that `action` ends with; of kind failed without one.
template <class Action> Error catch_error(const Action& action) {
    try {
        action();
    } catch (const Error& error) {
        return error;
    }
    return Error(ErrorKind::failed, {"no error was thrown", "", ""});
}

void expect_text(const Error& error, std::string_view part) {
    EXPECT_NE(std::string_view(error.what()).find(part), std::string_view::npos) << error.what();
}

TEST(LackingFeature, is_named_in_the_list_and_in_the_error) {
    const std::vector<DeviceInfo> devices = vulkan_devices();
    ASSERT_FALSE(devices.empty());
    EXPECT_EQ(devices[0].missing, std::vector<std::string>{"shaderBufferInt64Atomics"});
    for (const int index : {-1, 0}) {
        const Error error = catch_error([&] { const Device device({.index = index}); });
        EXPECT_EQ(error.kind(), ErrorKind::device_missing);
        expect_text(error, "shaderBufferInt64Atomics");
        expect_text(error, devices[0].name);
        expect_text(error, "device.engine = cpu");
    }
}

TEST(SmallHeap, is_never_exceeded) {
    constexpr uint64_t kHeap = 48u << 20;
    const Device device({.is_validated = true});
    EXPECT_EQ(device.description().memory_bytes, kHeap);
    EXPECT_LE(device.available_bytes(), kHeap);
    const Error error =
        catch_error([&] { const Buffer buffer(device, {.name = "everything", .bytes = 60'000'000}); });
    EXPECT_EQ(error.kind(), ErrorKind::out_of_memory);
    expect_text(error, "everything needs 60000000 bytes");
    expect_text(error, std::to_string(kHeap));
    // The driver would give more than the heap has.
    std::vector<Buffer> buffers;
    const Error last = catch_error([&] {
        for (int i = 0; i < 100; ++i)
            buffers.emplace_back(device, BufferConfig{.name = "part", .bytes = 3u << 20});
    });
    EXPECT_EQ(last.kind(), ErrorKind::out_of_memory);
    EXPECT_EQ(buffers.size(), 16u);
    EXPECT_TRUE(device.validation_messages().empty());
}

TEST(SmallHeap, has_room_to_the_last_byte) {
    const Device device({.is_validated = true});
    std::vector<Buffer> buffers;
    buffers.emplace_back(device, BufferConfig{.name = "first", .bytes = 5u << 20});
    const uint64_t left = device.available_bytes() / 16 * 16;
    ASSERT_LE(left + 16, device.max_buffer_bytes());
    const Error error =
        catch_error([&] { buffers.emplace_back(device, BufferConfig{.name = "last", .bytes = left + 16}); });
    EXPECT_EQ(error.kind(), ErrorKind::out_of_memory);
    expect_text(error, "last needs " + std::to_string(left + 16) + " bytes");
    buffers.emplace_back(device, BufferConfig{.name = "fits", .bytes = left});
    EXPECT_LT(device.available_bytes(), 16u);
    EXPECT_TRUE(device.validation_messages().empty());
}

TEST(LostDevice, is_an_error_that_names_what_ran) {
    const Device device({.is_validated = true});
    const BindingTable bindings(device);
    const Kernel kernel(device, {"sort_count", {scalar::kSortGroupSize}});
    Commands commands(device, bindings);
    const auto run = [&] {
        commands.dispatch(kernel, 1, scalar::SortPush{0, 0, 0, 15, 0});
        commands.run();
    };
    run();
    const Error error = catch_error(run);
    EXPECT_EQ(error.kind(), ErrorKind::device_missing);
    expect_text(error, "lost");
    expect_text(error, "sort_count");
    expect_text(error, device.description().name);
    expect_text(error, "device.engine = cpu");
    EXPECT_TRUE(device.validation_messages().empty());
    const Device next({.is_validated = true});
    EXPECT_NE(next.internals().shared, device.internals().shared);
}

TEST(NoDriver, is_an_empty_list_and_an_error) {
    EXPECT_TRUE(vulkan_devices().empty());
    const Error error = catch_error([] { const Device device({}); });
    EXPECT_EQ(error.kind(), ErrorKind::device_missing);
    expect_text(error, "driver");
    expect_text(error, "device.engine = cpu");
}

} // namespace
} // namespace relief::vulkan::tests
