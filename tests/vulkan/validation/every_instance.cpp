// Part of test programs that reach Vulkan by the public calls or by the command: validates every instance of
// the process and of its children. tests/vulkan/validation/every_instance_test.cpp proves it.
#include <cstdlib>

namespace relief::vulkan::tests {
namespace {

[[maybe_unused]] const bool is_validated = [] {
    setenv("VK_LAYER_SETTINGS_PATH", RELIEF_VALIDATION_SETTINGS, 1);
    setenv("VK_INSTANCE_LAYERS", "VK_LAYER_KHRONOS_validation", 1);
    return true;
}();

} // namespace
} // namespace relief::vulkan::tests
