#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "formulas/ggx_table.h"
#include "vulkan/device/errors.h"
#include "vulkan/device/kernel_internals.h"
#include "vulkan/layout/bindings.h"

namespace relief::vulkan {
namespace {

/// Texel formats as declared in shaders, in the order of vulkan/layout/bindings.h from kFirstTexelBinding on.
constexpr std::array<TexelFormat, scalar::kTexelBindingCount> kTexelFormats = {
    TexelFormat::rgba32_uint,  // nodes
    TexelFormat::r32_float,    // positions
    TexelFormat::rg32_float,   // uvs
    TexelFormat::rg32_uint,    // frames
    TexelFormat::rgba32_uint,  // quads
    TexelFormat::r32_uint,     // dominants
    TexelFormat::r32_uint,     // vertex tiles
    TexelFormat::rgba32_uint,  // overrides
    TexelFormat::r32_uint,     // override bits
    TexelFormat::r32_uint,     // levels
    TexelFormat::r32_uint,     // primitive ids
    TexelFormat::rgba32_float, // float texels
    TexelFormat::rgba16_float, // half texels
    TexelFormat::r32_float,    // environment
    TexelFormat::rg32_uint,    // emitters
    TexelFormat::rg32_float,   // albedos
};

TexelFormat find_format(uint32_t binding) {
    if (binding < scalar::kStorageBindingCount) return TexelFormat::none;
    const uint32_t index = binding - scalar::kFirstTexelBinding;
    if (binding < scalar::kFirstTexelBinding || index >= kTexelFormats.size())
        throw Error(ErrorKind::failed, {fmt::format("there is no binding {}", binding), "Vulkan", ""});
    return kTexelFormats[index];
}

void write_binding(const BindingTable::Implementation& table, uint32_t binding,
                   const Buffer::Implementation& buffer) {
    if (buffer.holds_nothing()) return;
    const vk::DescriptorBufferInfo range(*buffer.buffer, 0, VK_WHOLE_SIZE);
    const vk::BufferView texels = *buffer.texels;
    vk::WriteDescriptorSet write(*table.set, binding, 0, 1, vk::DescriptorType::eStorageBuffer, nullptr,
                                 &range, nullptr);
    if (binding >= scalar::kFirstTexelBinding) {
        write.descriptorType = vk::DescriptorType::eUniformTexelBuffer;
        write.pTexelBufferView = &texels;
    }
    table.device->shared->device.updateDescriptorSets(write, {});
}

void make_unbound(BindingTable::Implementation& table, const Device& device, TexelFormat format) {
    for (const Buffer& buffer : table.unbound)
        if (buffer.internals().config.format == format) return;
    constexpr uint64_t kBytes = 16;
    Buffer buffer(device, {.name = "unbound", .bytes = kBytes, .format = format});
    buffer.upload(std::vector<uint8_t>(kBytes, 0));
    table.unbound.push_back(std::move(buffer));
}

const Buffer& find_unbound(const BindingTable::Implementation& table, TexelFormat format) {
    return *std::find_if(table.unbound.begin(), table.unbound.end(),
                         [&](const Buffer& buffer) { return buffer.internals().config.format == format; });
}

/// The table of formulas/ggx_table.h.
Buffer make_albedos(const Device& device) {
    std::vector<Vec2f> entries(scalar::kGgxEntryCount);
    for (uint32_t i = 0; i < entries.size(); ++i) entries[i] = scalar::read_ggx_table(i);
    Buffer buffer(device, {.name = "albedos",
                           .bytes = entries.size() * sizeof(entries[0]),
                           .purpose = Purpose::structures,
                           .format = TexelFormat::rg32_float});
    buffer.upload(entries);
    return buffer;
}

} // namespace

BindingTable::BindingTable(const Device& device) : implementation_(std::make_unique<Implementation>()) {
    Implementation& own = *implementation_;
    own.device = &device.internals();
    const auto& handle = own.device->shared->device;
    check_vulkan("making the table of bindings", [&] {
        const std::array sizes = {
            vk::DescriptorPoolSize(vk::DescriptorType::eStorageBuffer, scalar::kStorageBindingCount),
            vk::DescriptorPoolSize(vk::DescriptorType::eUniformTexelBuffer, scalar::kTexelBindingCount)};
        own.pool = vk::raii::DescriptorPool(handle,
                                            {vk::DescriptorPoolCreateFlagBits::eFreeDescriptorSet, 1, sizes});
        own.device->set_name(own.pool, "relief bindings");
        own.set =
            std::move(vk::raii::DescriptorSets(handle, {*own.pool, *own.device->shared->set_layout}).front());
        own.device->set_name(own.set, "relief bindings");
    });
    make_unbound(own, device, TexelFormat::none);
    for (const TexelFormat format : kTexelFormats) make_unbound(own, device, format);
    own.albedos = make_albedos(device);
    clear();
}
BindingTable::~BindingTable() = default;

void BindingTable::clear() {
    for (uint32_t i = 0; i < scalar::kStorageBindingCount; ++i)
        bind(i, find_unbound(*implementation_, TexelFormat::none));
    for (uint32_t i = 0; i < scalar::kTexelBindingCount; ++i)
        bind(scalar::kFirstTexelBinding + i, find_unbound(*implementation_, kTexelFormats[i]));
    bind(scalar::kBindAlbedos, implementation_->albedos);
}

void BindingTable::bind(uint32_t binding, const Buffer& buffer) {
    const TexelFormat format = find_format(binding);
    const BufferConfig& config = buffer.internals().config;
    if (format != TexelFormat::none && config.format != format)
        throw Error(
            ErrorKind::failed,
            {fmt::format("{} has not the texel format of binding {}", config.name, binding), "Vulkan", ""});
    if (format == TexelFormat::none && config.bytes > implementation_->device->shared->max_buffer_bytes)
        throw Error(ErrorKind::out_of_memory,
                    {fmt::format("{} has {} bytes, a storage binding reaches {}", config.name, config.bytes,
                                 implementation_->device->shared->max_buffer_bytes),
                     "Vulkan", kUseCpu});
    write_binding(*implementation_, binding, buffer.internals());
}

} // namespace relief::vulkan
