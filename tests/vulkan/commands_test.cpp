// Fill, copy, dispatch and their order.
#include <gtest/gtest.h>

#include "engine/vulkan/commands.h"
#include "math/scalar.h"
#include "vulkan/gpu_fixture.h"
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

} // namespace
} // namespace relief::vulkan::tests
