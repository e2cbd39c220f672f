#include "vulkan/device/kernel_statistics.h"

#include <utility>

#include "base/check.h"
#include "vulkan/device/device_internals.h"
#include "vulkan/device/errors.h"

namespace relief::vulkan {
namespace {

KernelFigure make_figure(const vk::PipelineExecutableStatisticKHR& statistic) {
    using Format = vk::PipelineExecutableStatisticFormatKHR;
    KernelFigure figure{statistic.name.data(), statistic.description.data(), false};
    switch (statistic.format) {
    case Format::eBool32:
        figure.value = statistic.value.b32 != 0;
        break;
    case Format::eInt64:
        figure.value = int64_t(statistic.value.i64);
        break;
    case Format::eUint64:
        figure.value = uint64_t(statistic.value.u64);
        break;
    case Format::eFloat64:
        figure.value = statistic.value.f64;
        break;
    }
    return figure;
}

std::vector<KernelProgram> read_programs(const vk::raii::Device& device, vk::Pipeline pipeline) {
    std::vector<KernelProgram> programs;
    uint32_t index = 0;
    for (const auto& properties : device.getPipelineExecutablePropertiesKHR({pipeline})) {
        KernelProgram program{properties.name.data(), properties.subgroupSize, {}};
        for (const auto& statistic : device.getPipelineExecutableStatisticsKHR({pipeline, index}))
            program.figures.push_back(make_figure(statistic));
        programs.push_back(std::move(program));
        ++index;
    }
    return programs;
}

} // namespace

std::vector<KernelStatistics> take_kernel_statistics(const Device& device) {
    const Device::Implementation& own = device.internals();
    DCHECK(own.compiles_only());
    std::vector<KernelStatistics> result;
    check_vulkan("reading statistics of kernels", [&] {
        for (CompiledKernel& kernel : std::exchange(own.shared->compiled, {}))
            result.push_back({std::move(kernel.shader), std::move(kernel.vertex_shader),
                              std::move(kernel.constants),
                              read_programs(own.shared->device, **kernel.pipeline)});
    });
    return result;
}

} // namespace relief::vulkan
