#include "vulkan/device/kernel.h"

#include <algorithm>
#include <array>
#include <map>

#include <fmt/format.h>

#include "base/check.h"
#include "vulkan/device/errors.h"
#include "vulkan/device/kernel_internals.h"
#include "vulkan/device/shader_table.h"

namespace relief::vulkan {
namespace {

void check_config(const Device& device, const KernelConfig& config, std::span<const uint32_t> code) {
    if (code.empty())
        throw Error(ErrorKind::failed, {fmt::format("there is no shader {}", config.shader), "Vulkan", ""});
    if (config.constants.empty() || config.constants[0] == 0 || config.constants[0] > device.max_group_size())
        throw Error(ErrorKind::failed, {fmt::format("kernel {}: constant 0 is the group size, 1 to {}",
                                                    config.shader, device.max_group_size()),
                                        "Vulkan", ""});
    DCHECK(config.vertex_shader.empty() || device.method() != RenderMethod::compute);
    DCHECK(config.vertex_shader != kFullScreen || config.constants[0] == kFragmentGroup);
}

vk::raii::ShaderModule make_module(const Device::Implementation& device, const std::string& name,
                                   std::span<const uint32_t> code) {
    vk::raii::ShaderModule module(device.shared->device,
                                  vk::ShaderModuleCreateInfo({}, code.size_bytes(), code.data()));
    device.set_name(module, name);
    return module;
}

/// Points or triangles of either winding, without attachments; viewport and scissor are dynamic.
vk::raii::Pipeline make_drawn_pipeline(const Device::Implementation& device, const KernelConfig& config,
                                       const vk::PipelineShaderStageCreateInfo& fragment_stage,
                                       vk::PipelineCreateFlags flags) {
    const vk::raii::ShaderModule module =
        make_module(device, config.vertex_shader, find_shader(config.vertex_shader));
    const std::array stages = {
        vk::PipelineShaderStageCreateInfo({}, vk::ShaderStageFlagBits::eVertex, *module, "main"),
        fragment_stage};
    const vk::PipelineVertexInputStateCreateInfo no_input;
    const vk::PipelineInputAssemblyStateCreateInfo topology({}, config.vertex_shader == kFullScreen
                                                                    ? vk::PrimitiveTopology::ePointList
                                                                    : vk::PrimitiveTopology::eTriangleList);
    const vk::PipelineViewportStateCreateInfo one_viewport({}, 1, nullptr, 1, nullptr);
    vk::PipelineRasterizationStateCreateInfo raster;
    raster.lineWidth = 1;
    const vk::PipelineMultisampleStateCreateInfo one_sample({}, vk::SampleCountFlagBits::e1);
    const std::array dynamic = {vk::DynamicState::eViewport, vk::DynamicState::eScissor};
    const vk::PipelineDynamicStateCreateInfo dynamic_state({}, dynamic);
    const vk::PipelineColorBlendStateCreateInfo no_colors;
    const vk::PipelineRenderingCreateInfo no_attachments;
    vk::GraphicsPipelineCreateInfo info(flags, stages, &no_input, &topology, nullptr, &one_viewport, &raster,
                                        &one_sample, nullptr, &no_colors, &dynamic_state,
                                        *device.shared->pipeline_layout);
    info.pNext = &no_attachments;
    return {device.shared->device, device.shared->pipeline_cache, info};
}

vk::raii::Pipeline make_pipeline(const Device::Implementation& device, const KernelConfig& config,
                                 std::span<const uint32_t> code) {
    const vk::raii::ShaderModule module = make_module(device, config.shader, code);
    std::vector<vk::SpecializationMapEntry> entries;
    for (uint32_t i = 0; i < config.constants.size(); ++i)
        entries.emplace_back(i, uint32_t(i * sizeof(uint32_t)), sizeof(uint32_t));
    const vk::SpecializationInfo constants(uint32_t(entries.size()), entries.data(),
                                           config.constants.size() * sizeof(uint32_t),
                                           config.constants.data());
    const bool is_drawn = !config.vertex_shader.empty();
    // Commands launches compute kernels in parts on a CPU device.
    vk::PipelineCreateFlags flags;
    if (device.compiles_only()) flags |= vk::PipelineCreateFlagBits::eCaptureStatisticsKHR;
    if (device.shared->description.is_cpu && !is_drawn) flags |= vk::PipelineCreateFlagBits::eDispatchBase;
    const vk::PipelineShaderStageCreateInfo stage(
        {}, is_drawn ? vk::ShaderStageFlagBits::eFragment : vk::ShaderStageFlagBits::eCompute, *module,
        "main", &constants);
    vk::raii::Pipeline pipeline =
        is_drawn ? make_drawn_pipeline(device, config, stage, flags)
                 : vk::raii::Pipeline(
                       device.shared->device, device.shared->pipeline_cache,
                       vk::ComputePipelineCreateInfo(flags, stage, *device.shared->pipeline_layout));
    device.set_name(pipeline, config.shader);
    return pipeline;
}

/// The constants as the shader sees them: those that it declares, its own values where none are given; 0 in
/// place of others, which change nothing (SPIR-V specification, 2.3 and 3.20).
std::vector<uint32_t> keep_declared(const std::vector<uint32_t>& constants, std::span<const uint32_t> code) {
    constexpr uint32_t kDecorate = 71, kSpecId = 1, kSpecConstant = 50;
    constexpr size_t kHeaderWords = 5;
    std::map<uint32_t, uint32_t> numbers; // by the result that is decorated, which comes later
    std::vector<uint32_t> kept;
    for (size_t i = kHeaderWords; i < code.size();) {
        const uint32_t operation = code[i] & 0xffff, words = code[i] >> 16;
        if (operation == kDecorate && words == 4 && code[i + 2] == kSpecId)
            numbers[code[i + 1]] = code[i + 3];
        if (operation == kSpecConstant && words == 4 && numbers.contains(code[i + 2])) {
            const uint32_t number = numbers[code[i + 2]];
            kept.resize(std::max<size_t>(kept.size(), number + 1), 0);
            kept[number] = number < constants.size() ? constants[number] : code[i + 3];
        }
        i += std::max(words, 1u);
    }
    return kept;
}

/// The device's cached pipeline, or an own one for external SPIR-V.
std::shared_ptr<const vk::raii::Pipeline>
find_pipeline(Device::Implementation& device, const KernelConfig& config, std::span<const uint32_t> code) {
    const auto make = [&] {
        device.heed_stop();
        return make_pipeline(device, config, code);
    };
    if (!config.code.empty()) return std::make_shared<const vk::raii::Pipeline>(make());
    return device.shared->pipelines.find_or_make(
        {config.shader, config.vertex_shader, keep_declared(config.constants, code)}, make);
}

} // namespace

Kernel::Kernel() noexcept = default;

Kernel::Kernel(const Device& device, const KernelConfig& config)
    : implementation_(std::make_unique<Implementation>()) {
    const std::span<const uint32_t> code = config.code.empty() ? find_shader(config.shader) : config.code;
    check_config(device, config, code);
    implementation_->name = config.shader;
    implementation_->group_size = config.constants[0];
    implementation_->is_drawn = !config.vertex_shader.empty();
    check_vulkan("compiling " + config.shader,
                 [&] { implementation_->pipeline = find_pipeline(device.internals(), config, code); });
    if (device.internals().compiles_only())
        device.internals().shared->compiled.push_back({config.shader, config.vertex_shader,
                                                       keep_declared(config.constants, code),
                                                       implementation_->pipeline});
}
Kernel::~Kernel() = default;
Kernel::Kernel(Kernel&&) noexcept = default;
Kernel& Kernel::operator=(Kernel&&) noexcept = default;

uint32_t Kernel::group_size() const { return implementation_->group_size; }
bool Kernel::is_drawn() const { return implementation_->is_drawn; }

Kernel make_kernel(const Device& device, const char* shader) {
    return Kernel(device, {.shader = shader, .constants = {kGroupSize}});
}

} // namespace relief::vulkan
