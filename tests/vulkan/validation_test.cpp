// The validation that all other tests rely on is there.
#include <algorithm>

#include <gtest/gtest.h>

#include "gpu_fixture.h"
#include "vulkan/device/commands.h"
#include "vulkan/device/device_internals.h"

namespace relief::vulkan::tests {
namespace {

bool has_message(const Device& device, std::string_view part) {
    const std::vector<std::string> messages = device.validation_messages();
    return std::any_of(messages.begin(), messages.end(),
                       [&](const std::string& m) { return m.find(part) != std::string::npos; });
}

TEST(Validation, finds_a_missing_barrier) {
    const Device device({.index = get_test_device_index(), .is_validated = true, .is_shared = false});
    const Buffer one(device, {.name = "one", .bytes = 64}), two(device, {.name = "two", .bytes = 64});
    const auto copy = [](const vk::raii::CommandBuffer& commands, const Buffer& from, const Buffer& to) {
        commands.copyBuffer(*from.internals().buffer, *to.internals().buffer, vk::BufferCopy(0, 0, 64));
    };
    device.internals().run_once("copies in order", [&](const vk::raii::CommandBuffer& commands) {
        copy(commands, one, two);
        record_barrier(commands);
        copy(commands, two, one);
    });
    EXPECT_TRUE(device.validation_messages().empty());
    device.internals().run_once("copies without order", [&](const vk::raii::CommandBuffer& commands) {
        copy(commands, one, two);
        copy(commands, two, one);
    });
    EXPECT_TRUE(has_message(device, "SYNC-HAZARD-READ-AFTER-WRITE"));
}

TEST(Validation, finds_a_wrong_call_and_names_the_object) {
    const Device device({.index = get_test_device_index(), .is_validated = true, .is_shared = false});
    const Buffer buffer(device, {.name = "the small one", .bytes = 64});
    device.internals().run_once("a fill beyond the end", [&](const vk::raii::CommandBuffer& commands) {
        commands.fillBuffer(*buffer.internals().buffer, 128, 4, 0);
    });
    EXPECT_TRUE(has_message(device, "VUID-vkCmdFillBuffer-dstOffset"));
    EXPECT_TRUE(has_message(device, "the small one"));
}

TEST(Validation, is_off_unless_asked_for) {
    const Device device({});
    EXPECT_TRUE(device.validation_messages().empty());
    EXPECT_EQ(device.internals().shared->messages, nullptr);
}

} // namespace
} // namespace relief::vulkan::tests
