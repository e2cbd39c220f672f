// What the driver tells of every kernel of the Vulkan engine and of the laboratory: registers, spills,
// latency. Kernels are compiled and not run; a driver without a device will do.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "relief/render.h"
#include "vulkan/device/kernel_statistics.h"

namespace relief {

/// A scene or setting that needs kernels of its own.
struct KernelCase {
    std::string name, meaning;
};

struct ReportedKernel {
    vulkan::KernelStatistics statistics;
    std::vector<std::string> cases; ///< names of all that use it
};

struct KernelReport {
    std::string device, driver;
    /// Of constants by number; those that differ in meaning from kernel to kernel have none.
    std::map<uint32_t, std::string> constant_names;
    std::vector<KernelCase> cases;
    std::vector<ReportedKernel> kernels; ///< in the order in which the engine makes them
};

/// Of `settings`: device.index. `on_case` is told the name of each case before its kernels are compiled.
/// Throws Error{device_missing} where the device or its driver's statistics are missing.
KernelReport report_kernels(const RenderSettings& settings,
                            const std::function<void(const std::string&)>& on_case);

} // namespace relief
