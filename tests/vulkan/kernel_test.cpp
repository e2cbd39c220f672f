// Pipelines are compiled once for a device.
#include <memory>
#include <stdexcept>

#include <gtest/gtest.h>

#include "vulkan/device/kernel_internals.h"
#include "vulkan/gpu_fixture.h"
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
