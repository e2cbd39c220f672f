#include "engine/vulkan/kernel.h"

#include <fmt/format.h>

#include "engine/vulkan/errors.h"
#include "engine/vulkan/kernel_internals.h"
#include "engine/vulkan/shader_table.h"

namespace relief::vulkan {
namespace {

void check_config(const Device& device, const KernelConfig& config, std::span<const uint32_t> code) {
    if (code.empty())
        throw Error(ErrorKind::failed, {fmt::format("there is no shader {}", config.shader), "Vulkan", ""});
    if (config.constants.empty() || config.constants[0] == 0 || config.constants[0] > device.max_group_size())
        throw Error(ErrorKind::failed, {fmt::format("kernel {}: constant 0 is the group size, 1 to {}",
                                                    config.shader, device.max_group_size()),
                                        "Vulkan", ""});
}

vk::raii::Pipeline make_pipeline(const Device::Implementation& device, const KernelConfig& config,
                                 std::span<const uint32_t> code) {
    const vk::raii::ShaderModule module(device.device,
                                        vk::ShaderModuleCreateInfo({}, code.size_bytes(), code.data()));
    device.set_name(module, config.shader);
    std::vector<vk::SpecializationMapEntry> entries;
    for (uint32_t i = 0; i < config.constants.size(); ++i)
        entries.emplace_back(i, uint32_t(i * sizeof(uint32_t)), sizeof(uint32_t));
    const vk::SpecializationInfo constants(uint32_t(entries.size()), entries.data(),
                                           config.constants.size() * sizeof(uint32_t),
                                           config.constants.data());
    const vk::PipelineShaderStageCreateInfo stage({}, vk::ShaderStageFlagBits::eCompute, *module, "main",
                                                  &constants);
    return {device.device, device.pipeline_cache,
            vk::ComputePipelineCreateInfo({}, stage, *device.pipeline_layout)};
}

} // namespace

Kernel::Kernel() noexcept = default;

Kernel::Kernel(const Device& device, const KernelConfig& config)
    : implementation_(std::make_unique<Implementation>()) {
    const std::span<const uint32_t> code = config.code.empty() ? find_shader(config.shader) : config.code;
    check_config(device, config, code);
    implementation_->name = config.shader;
    implementation_->group_size = config.constants[0];
    check_vulkan("compiling " + config.shader, [&] {
        implementation_->pipeline = make_pipeline(device.internals(), config, code);
        device.internals().set_name(implementation_->pipeline, config.shader);
    });
}
Kernel::~Kernel() = default;
Kernel::Kernel(Kernel&&) noexcept = default;
Kernel& Kernel::operator=(Kernel&&) noexcept = default;

uint32_t Kernel::group_size() const { return implementation_->group_size; }

} // namespace relief::vulkan
