// Pipelines are compiled once for a device.
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "vulkan/device/kernel_internals.h"
#include "vulkan/gpu_fixture.h"
#include "vulkan/layout/device_sort.h"
#include "vulkan/test_shaders.h"

namespace relief::vulkan::tests {
namespace {

using Pipeline = std::shared_ptr<const vk::raii::Pipeline>;

class Kernels : public GpuTest {
  protected:
    static Pipeline pipeline(const Kernel& kernel) { return kernel.internals().pipeline; }
};

TEST_F(Kernels, of_one_shader_and_the_same_constants_share_a_pipeline) {
    const KernelConfig config{.shader = "geometric_normal", .constants = {64}};
    const Kernel first(device(), config), second(device(), config);
    EXPECT_EQ(pipeline(first), pipeline(second));
}

TEST_F(Kernels, of_other_constants_do_not) {
    const Kernel first(device(), {.shader = "geometric_normal", .constants = {64}});
    const Kernel second(device(), {.shader = "geometric_normal", .constants = {32}});
    EXPECT_NE(pipeline(first), pipeline(second));
    EXPECT_EQ(first.group_size(), 64u);
    EXPECT_EQ(second.group_size(), 32u);
}

TEST_F(Kernels, differ_by_the_constants_that_the_shader_declares_alone) {
    const auto make = [](uint32_t unknown) {
        return Kernel(device(), {.shader = "sort_count", .constants = {scalar::kSortGroupSize, unknown}});
    };
    EXPECT_EQ(pipeline(make(0)), pipeline(make(1)));
}

TEST_F(Kernels, share_a_pipeline_where_a_constant_that_is_not_given_is_the_shaders_own) {
    const auto make = [](std::vector<uint32_t> constants) {
        return pipeline(Kernel(device(), {.shader = "finish_hits", .constants = std::move(constants)}));
    };
    EXPECT_EQ(make({64}), make({64, 0, 0, 0, 0, 0, 0, 0})); // exact leaves, and no smooth map
    EXPECT_NE(make({64}), make({64, 1}));
    EXPECT_NE(make({64}), make({64, 0, 0, 0, 0, 0, 0, 1}));
    // Eight lanes.
    EXPECT_EQ(pipeline(Kernel(device(), {.shader = "bottom_build", .constants = {8}})),
              pipeline(Kernel(device(), {.shader = "bottom_build", .constants = {8, 8}})));
    EXPECT_NE(pipeline(Kernel(device(), {.shader = "bottom_build", .constants = {8}})),
              pipeline(Kernel(device(), {.shader = "bottom_build", .constants = {8, 4}})));
}

TEST_F(Kernels, are_shared_by_devices_unless_one_is_of_its_own) {
    const KernelConfig config{.shader = "geometric_normal", .constants = {64}};
    const Device second({.index = get_test_device_index(), .is_validated = true});
    EXPECT_EQ(pipeline(Kernel(device(), config)), pipeline(Kernel(second, config)));
    EXPECT_EQ(second.allocated_bytes(Purpose::ray_buffers), 0u) << "memory is accounted for one by one";
    const Device own({.index = get_test_device_index(), .is_shared = false});
    EXPECT_NE(pipeline(Kernel(device(), config)), pipeline(Kernel(own, config)));
}

TEST_F(Kernels, of_shaders_from_elsewhere_do_not_even_under_one_name) {
    const Kernel first = make_test_kernel(device(), "add_index"),
                 second = make_test_kernel(device(), "add_index");
    EXPECT_NE(pipeline(first), pipeline(second));
}

TEST_F(Kernels, leave_their_pipeline_to_those_that_come_later) {
    const KernelConfig config{.shader = "geometric_normal", .constants = {64}};
    std::weak_ptr<const vk::raii::Pipeline> first;
    {
        const Kernel kernel(device(), config);
        first = pipeline(kernel);
    }
    EXPECT_EQ(first.lock(), pipeline(Kernel(device(), config)));
}

TEST(PipelineStore, asks_again_after_a_failure_and_no_more_after_a_success) {
    vulkan::PipelineStore<int> store;
    int count = 0;
    const auto make = [&](bool is_failure) {
        return store.find_or_make({"shader", "", {64}}, [&] {
            ++count;
            if (is_failure) throw std::runtime_error("cannot be compiled");
            return 7;
        });
    };
    EXPECT_THROW(make(true), std::runtime_error);
    const std::shared_ptr<const int> made = make(false);
    ASSERT_NE(made, nullptr);
    EXPECT_EQ(*made, 7);
    EXPECT_EQ(make(true), made);
    EXPECT_EQ(count, 2);
}

} // namespace
} // namespace relief::vulkan::tests
