#include "relief/devices.h"

#ifdef RELIEF_VULKAN
#include "vulkan/device/device.h"
#endif

namespace relief {

#ifdef RELIEF_VULKAN
namespace {

std::vector<std::string> find_methods(const vulkan::DeviceDescription& device) {
    if (!device.missing.empty()) return {};
    if (!device.missing_to_draw.empty()) return {"compute"};
    return {"compute", "fragment", "hybrid"};
}

} // namespace
#endif

std::vector<DeviceInfo> vulkan_devices() {
    std::vector<DeviceInfo> result;
#ifdef RELIEF_VULKAN
    for (const vulkan::DeviceDescription& device : vulkan::list_devices())
        result.push_back({int(device.index), device.name, device.driver, device.is_cpu ? "cpu" : "gpu",
                          device.memory_bytes, device.missing, device.missing_to_draw, find_methods(device)});
#endif
    return result;
}

} // namespace relief
