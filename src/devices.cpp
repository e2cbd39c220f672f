#include "relief/devices.h"

#ifdef RELIEF_VULKAN
#include "engine/vulkan/device.h"
#endif

namespace relief {

std::vector<DeviceInfo> vulkan_devices() {
    std::vector<DeviceInfo> result;
#ifdef RELIEF_VULKAN
    for (const vulkan::DeviceDescription& device : vulkan::list_devices())
        result.push_back({int(device.index), device.name, device.driver, device.is_cpu ? "cpu" : "gpu",
                          device.memory_bytes, device.missing});
#endif
    return result;
}

} // namespace relief
