// Programs with every_instance.cpp do not outlive a message of the validation layer.
#include <csignal>
#include <cstdlib>

#include <gtest/gtest.h>

#include "vulkan/device/commands.h"
#include "vulkan/device/device_internals.h"

namespace relief::vulkan::tests {
namespace {

/// Two copies from one buffer to the other and back, with or without the barrier that they need.
void copy_and_back(const std::function<void(const vk::raii::CommandBuffer&)>& between) {
    const Device device({});
    const Buffer one(device, {.name = "one", .bytes = 64}), two(device, {.name = "two", .bytes = 64});
    const vk::BufferCopy whole(0, 0, 64);
    device.internals().run_once("copies", [&](const vk::raii::CommandBuffer& commands) {
        commands.copyBuffer(*one.internals().buffer, *two.internals().buffer, whole);
        between(commands);
        commands.copyBuffer(*two.internals().buffer, *one.internals().buffer, whole);
    });
}

class EveryInstanceDeathTest : public testing::Test {
  protected:
    void SetUp() override { GTEST_FLAG_SET(death_test_style, "threadsafe"); }
};

TEST_F(EveryInstanceDeathTest, ends_at_a_missing_barrier) {
    EXPECT_EXIT(copy_and_back([](const auto&) {}), testing::KilledBySignal(SIGTRAP), "");
}

TEST_F(EveryInstanceDeathTest, ends_at_a_wrong_call) {
    const auto fill_beyond_the_end = [] {
        const Device device({});
        const Buffer buffer(device, {.name = "small", .bytes = 64});
        device.internals().run_once("a fill", [&](const vk::raii::CommandBuffer& commands) {
            commands.fillBuffer(*buffer.internals().buffer, 128, 4, 0);
        });
    };
    EXPECT_EXIT(fill_beyond_the_end(), testing::KilledBySignal(SIGTRAP), "");
}

TEST_F(EveryInstanceDeathTest, lives_on_without_a_message) {
    const auto copy_in_order = [] {
        copy_and_back([](const auto& commands) { record_barrier(commands); });
        std::exit(3);
    };
    EXPECT_EXIT(copy_in_order(), testing::ExitedWithCode(3), "");
}

} // namespace
} // namespace relief::vulkan::tests
