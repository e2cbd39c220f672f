// Pipelines are compiled once for a device.
#include <gtest/gtest.h>

#include "engine/vulkan/kernel_internals.h"
#include "vulkan/gpu_fixture.h"
#include "vulkan/test_shaders.h"

namespace relief::vulkan::tests {
namespace {

class Kernels : public GpuTest {
  protected:
    static VkPipeline pipeline(const Kernel& kernel) { return **kernel.internals().pipeline; }
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

TEST_F(Kernels, outlive_those_that_they_share_with) {
    const KernelConfig config{.shader = "geometric_normal", .constants = {64}};
    Kernel second;
    {
        const Kernel first(device(), config);
        second = Kernel(device(), config);
    }
    const Kernel third(device(), config);
    EXPECT_EQ(pipeline(second), pipeline(third));
}

} // namespace
} // namespace relief::vulkan::tests
