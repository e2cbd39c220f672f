// Fill, copy, dispatch and their order.
#include <gtest/gtest.h>

#include "base/stop_request.h"
#include "formulas/constants.h"
#include "relief/error.h"
#include "vulkan/device/commands.h"
#include "vulkan/gpu_fixture.h"
#include "vulkan/layout/bindings.h"
#include "vulkan/test_shaders.h"

namespace relief::vulkan::tests {
namespace {

class Commands : public GpuTest {};

struct AddIndexPush {
    uint32_t count, factor;
};

TEST_F(Commands, fills_and_dispatches_see_each_other_in_order) {
    constexpr uint32_t kCount = 1000;
    const Buffer values(device(), {.name = "values", .bytes = kCount * 4});
    const Buffer copy(device(), {.name = "copy", .bytes = kCount * 4});
    BindingTable bindings(device());
    bindings.bind(scalar::kBindFilm, values);
    const Kernel kernel = make_test_kernel(device(), "add_index");
    vulkan::Commands commands(device(), bindings);
    commands.fill(values, 0, kCount * 4, 7);
    commands.dispatch(kernel, kCount, AddIndexPush{kCount, 10});
    commands.dispatch(kernel, kCount, AddIndexPush{kCount, 100});
    commands.copy(values, 0, copy, 0, kCount * 4);
    commands.fill(values, 0, kCount * 4, 0);
    commands.run();
    const std::vector<uint32_t> result = copy.download<uint32_t>(kCount);
    for (uint32_t i = 0; i < kCount; ++i) ASSERT_EQ(result[i], (70 + i) * 100 + i);
    EXPECT_EQ(commands.dispatch_count(), 2u);
}

TEST_F(Commands, dispatches_of_many_groups_cover_every_invocation) {
    // Groups of 2 make more than one row of them.
    constexpr uint32_t kCount = 200'001;
    const Buffer values(device(), {.name = "values", .bytes = kCount * 4});
    BindingTable bindings(device());
    bindings.bind(scalar::kBindFilm, values);
    const Kernel kernel = make_test_kernel(device(), "add_index", {2});
    EXPECT_EQ(kernel.group_size(), 2u);
    vulkan::Commands commands(device(), bindings);
    commands.fill(values, 0, kCount * 4, 3);
    commands.dispatch(kernel, kCount, AddIndexPush{kCount, 2});
    commands.run();
    const std::vector<uint32_t> result = values.download<uint32_t>(kCount);
    for (uint32_t i = 0; i < kCount; ++i) ASSERT_EQ(result[i], 6 + i);
}

TEST_F(Commands, indirect_dispatches_read_what_came_before) {
    constexpr uint32_t kCount = 640;
    const Buffer values(device(), {.name = "values", .bytes = kCount * 4});
    const Buffer arguments(device(), {.name = "arguments", .bytes = 32, .is_indirect = true});
    BindingTable bindings(device());
    bindings.bind(scalar::kBindFilm, values);
    const Kernel kernel = make_test_kernel(device(), "add_index");
    vulkan::Commands commands(device(), bindings);
    commands.fill(values, 0, kCount * 4, 1);
    commands.fill(arguments, 0, 32, 1);
    commands.fill(arguments, 16, 4, 5);
    commands.dispatch_indirect(kernel, arguments, 16, AddIndexPush{kCount, 10});
    commands.run();
    const std::vector<uint32_t> result = values.download<uint32_t>(kCount);
    for (uint32_t i = 0; i < kCount; ++i) ASSERT_EQ(result[i], i < 320 ? 10 + i : 1);
}

TEST_F(Commands, launches_in_parts_on_a_cpu_device_cover_every_invocation_until_a_stop_is_asked_for) {
    constexpr uint32_t kCount = 100'001;
    constexpr uint64_t kPartCount = kCount / 2 / vulkan::Commands::kPartGroups + 1;
    const Buffer values(device(), {.name = "values", .bytes = kCount * 4});
    const Buffer arguments(device(), {.name = "arguments", .bytes = 32, .is_indirect = true});
    BindingTable bindings(device());
    bindings.bind(scalar::kBindFilm, values);
    const Kernel kernel = make_test_kernel(device(), "add_index", {2});
    vulkan::Commands commands(device(), bindings);
    uint64_t queries = 0, most_queries = ~uint64_t(0);
    const Device::StopScope scope(device(), [&] { return ++queries > most_queries; });
    commands.fill(values, 0, kCount * 4, 3);
    commands.fill(arguments, 0, 12, 1);
    commands.fill(arguments, 0, 4, (kCount + 1) / 2);
    commands.dispatch(kernel, kCount, AddIndexPush{kCount, 2});
    commands.dispatch_indirect(kernel, arguments, 0, AddIndexPush{kCount, 10});
    commands.run();
    const std::vector<uint32_t> result = values.download<uint32_t>(kCount);
    for (uint32_t i = 0; i < kCount; ++i) ASSERT_EQ(result[i], (6 + i) * 10 + i);
    EXPECT_LE(queries, 2 * kPartCount + 4);
    if (!device().is_cpu()) return; // a GPU runs launches whole
    EXPECT_GE(queries, 6u);

    const uint64_t launched = commands.dispatch_count();
    commands.fill(values, 0, kCount * 4, 3);
    most_queries = queries + 3; // the fill and two parts: 1 row, then 1 or 2
    EXPECT_THROW(commands.dispatch(kernel, kCount, AddIndexPush{kCount, 2}), StopRequest);
    const std::vector<uint32_t> part = values.download<uint32_t>(kCount);
    EXPECT_EQ(part[2 * vulkan::Commands::kPartGroups - 1], 6 + 2 * vulkan::Commands::kPartGroups - 1);
    for (uint32_t i = 3 * 2 * vulkan::Commands::kPartGroups; i < kCount; ++i) ASSERT_EQ(part[i], 3u) << i;
    EXPECT_EQ(commands.dispatch_count(), launched + 3) << "the last one was recorded, and is discarded";
    most_queries = ~uint64_t(0);
    commands.run();
    EXPECT_EQ(values.download<uint32_t>(kCount), part);
}

TEST_F(Commands, of_nothing_do_nothing) {
    BindingTable bindings(device());
    const Buffer values(device(), {.name = "values", .bytes = 16});
    const Kernel kernel = make_test_kernel(device(), "add_index");
    vulkan::Commands commands(device(), bindings);
    commands.run();
    commands.dispatch(kernel, 0, AddIndexPush{0, 0});
    commands.fill(values, 0, 0, 1);
    commands.copy(values, 0, values, 8, 0);
    commands.run();
    EXPECT_EQ(commands.dispatch_count(), 0u);
}

TEST_F(Commands, time_goes_to_the_stage_that_took_it) {
    constexpr uint32_t kCount = 1u << 20;
    const Buffer values(device(), {.name = "values", .bytes = kCount * 4});
    BindingTable bindings(device());
    bindings.bind(scalar::kBindFilm, values);
    const Kernel kernel = make_test_kernel(device(), "add_index");
    vulkan::Commands commands(device(), bindings);
    commands.fill(values, 0, kCount * 4, 1);
    commands.begin_stage(Stage::sort);
    for (int i = 0; i < 20; ++i) commands.dispatch(kernel, kCount, AddIndexPush{kCount, 1});
    commands.begin_stage(Stage::film);
    commands.dispatch(kernel, 64, AddIndexPush{64, 1});
    commands.begin_stage(Stage::shade);
    commands.run();
    const std::array<double, kStageCount>& seconds = commands.stage_seconds();
    EXPECT_GT(seconds[size_t(Stage::sort)], 0.0);
    EXPECT_GT(seconds[size_t(Stage::film)], 0.0);
    EXPECT_LT(seconds[size_t(Stage::film)], seconds[size_t(Stage::sort)]);
    EXPECT_EQ(seconds[size_t(Stage::shade)], 0.0);
    EXPECT_EQ(seconds[size_t(Stage::top_traversal)], 0.0);
}

TEST_F(Commands, unknown_shaders_and_group_sizes_are_refused) {
    EXPECT_THROW(Kernel(device(), {"no_such_shader", {64}}), Error);
    EXPECT_THROW(make_test_kernel(device(), "add_index", {}), Error);
    EXPECT_THROW(make_test_kernel(device(), "add_index", {1u << 20}), Error);
}

/// On a device that draws.
class FullScreen : public testing::Test {
  protected:
    void TearDown() override {
        for (const std::string& message : device_.validation_messages()) ADD_FAILURE() << message;
    }

    const Device device_{
        {.index = get_test_device_index(), .method = RenderMethod::fragment, .is_validated = true}};
    const Kernel kernel_{device_,
                         {"add_index", {kFragmentGroup}, find_shader("add_index_fragment"), kFullScreen}};
};

TEST_F(FullScreen, runs_every_invocation_once) {
    constexpr uint32_t kMost = 70'000; // more rows of squares than one
    const Buffer values(device_, {.name = "values", .bytes = kMost * 4});
    BindingTable bindings(device_);
    bindings.bind(scalar::kBindFilm, values);
    vulkan::Commands commands(device_, bindings);
    for (const uint32_t count : {1u, 63u, 64u, 65u, 1000u, 16384u, 16385u, kMost}) {
        commands.fill(values, 0, kMost * 4, 3);
        commands.dispatch(kernel_, count, AddIndexPush{count, 2});
        commands.run();
        const std::vector<uint32_t> result = values.download<uint32_t>(kMost);
        for (uint32_t i = 0; i < kMost; ++i) ASSERT_EQ(result[i], i < count ? 6 + i : 3) << count;
    }
}

TEST_F(FullScreen, reads_its_groups_from_the_arguments_of_an_indirect_launch) {
    constexpr uint32_t kRow = scalar::kScreenColumns * kFragmentGroup, kRun = 300 * kFragmentGroup;
    const Buffer values(device_, {.name = "values", .bytes = 3 * kRow * 4});
    const Buffer arguments(device_, {.name = "arguments", .bytes = 64, .is_indirect = true});
    BindingTable bindings(device_);
    bindings.bind(scalar::kBindFilm, values);
    vulkan::Commands commands(device_, bindings);
    commands.fill(values, 0, 3 * kRow * 4, 3);
    const uint64_t draw = 32 + scalar::kArgumentDrawWord * 4;
    commands.fill(arguments, 0, 64, 0);
    commands.fill(arguments, draw, 4, 300);
    commands.fill(arguments, draw + 4, 4, 1);
    commands.dispatch_indirect(kernel_, arguments, 32, AddIndexPush{3 * kRow, 2});
    commands.run();
    const std::vector<uint32_t> result = values.download<uint32_t>(3 * kRow);
    for (uint32_t i = 0; i < 3 * kRow; ++i) ASSERT_EQ(result[i], i < kRun ? 6 + i : 3);
}

/// Helper invocations read zeros, loop forever, and use up the loop budget of their neighbours on lavapipe.
TEST_F(FullScreen, has_no_fragments_beside_its_own) {
    constexpr uint32_t kCount = 3 * scalar::kScreenColumns * kFragmentGroup;
    Buffer next(device_, {.name = "next", .bytes = kCount * 4});
    const Buffer steps(device_, {.name = "steps", .bytes = kCount * 4});
    std::vector<uint32_t> list(kCount);
    for (uint32_t i = 0; i < kCount; ++i) list[i] = i % 5 == 0 ? scalar::kNone : i - 1;
    next.upload(list);
    BindingTable bindings(device_);
    bindings.bind(scalar::kBindFilm, next);
    bindings.bind(scalar::kBindPaths, steps);
    const Kernel kernel(device_,
                        {"walk_list", {kFragmentGroup}, find_shader("walk_list_fragment"), kFullScreen});
    vulkan::Commands commands(device_, bindings);
    commands.dispatch(kernel, kCount, kCount);
    commands.run();
    const std::vector<uint32_t> result = steps.download<uint32_t>(kCount);
    for (uint32_t i = 0; i < kCount; ++i) ASSERT_EQ(result[i], i % 5) << i;
}

TEST_F(FullScreen, refuses_more_than_the_screen_holds) {
    const BindingTable bindings(device_);
    vulkan::Commands commands(device_, bindings);
    const uint64_t all = uint64_t(scalar::kScreenColumns) * scalar::kScreenRows * kFragmentGroup;
    EXPECT_THROW(commands.dispatch(kernel_, all + 1, AddIndexPush{0, 0}), Error);
    commands.dispatch(kernel_, all, AddIndexPush{0, 0});
    commands.run();
}

} // namespace
} // namespace relief::vulkan::tests
