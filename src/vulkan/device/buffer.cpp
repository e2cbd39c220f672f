#include "vulkan/device/buffer.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/check.h"
#include "vulkan/device/device_internals.h"
#include "vulkan/device/errors.h"

namespace relief::vulkan {
namespace {

/// Minimum buffer size: one texel of the widest format.
constexpr uint64_t kGranularity = 16;

struct Texel {
    vk::Format format;
    uint32_t bytes;
};

Texel find_texel(TexelFormat format) {
    constexpr Texel kTexels[] = {{vk::Format::eUndefined, 0},          {vk::Format::eR32Sfloat, 4},
                                 {vk::Format::eR32G32Sfloat, 8},       {vk::Format::eR32G32B32A32Sfloat, 16},
                                 {vk::Format::eR16G16B16A16Sfloat, 8}, {vk::Format::eR32Uint, 4},
                                 {vk::Format::eR32G32Uint, 8},         {vk::Format::eR32G32B32A32Uint, 16}};
    return kTexels[size_t(format)];
}

uint64_t round_up(uint64_t bytes) {
    return (std::max<uint64_t>(bytes, 1) + kGranularity - 1) / kGranularity * kGranularity;
}

/// Texel buffers may exceed the range of a storage binding.
uint64_t find_largest(const Device::Implementation& device, TexelFormat format) {
    if (format == TexelFormat::none) return device.shared->max_buffer_bytes;
    const uint64_t texels = uint64_t(device.shared->limits.maxTexelBufferElements) * texel_bytes(format);
    return std::min(texels, device.shared->max_allocation_bytes);
}

void check_size(const Device::Implementation& device, const BufferConfig& config) {
    const uint64_t largest = find_largest(device, config.format);
    if (config.bytes <= largest && round_up(config.bytes) <= largest) return;
    throw Error(ErrorKind::out_of_memory,
                {fmt::format("{} needs {} bytes, one buffer of {} may have {}", config.name, config.bytes,
                             device.shared->description.name, largest),
                 "Vulkan", kUseCpu});
}

vk::BufferUsageFlags choose_usage(const BufferConfig& config) {
    using Usage = vk::BufferUsageFlagBits;
    vk::BufferUsageFlags usage = Usage::eStorageBuffer | Usage::eTransferSrc | Usage::eTransferDst;
    if (config.format != TexelFormat::none) usage |= Usage::eUniformTexelBuffer;
    if (config.is_indirect) usage |= Usage::eIndirectBuffer;
    return usage;
}

bool is_direct(const Buffer::Implementation& buffer) {
    return buffer.memory.mapped() && (buffer.config.is_host_visible || !buffer.device.is_staged);
}

} // namespace

uint32_t texel_bytes(TexelFormat format) { return find_texel(format).bytes; }

Buffer::Implementation::Implementation(Device::Implementation& owner, const BufferConfig& wanted)
    : device(owner), config(wanted) {
    check_size(device, config);
    if (device.compiles_only()) return;
    check_vulkan(config.name, [&] {
        buffer = vk::raii::Buffer(device.shared->device,
                                  vk::BufferCreateInfo({}, round_up(config.bytes), choose_usage(config)));
        device.set_name(buffer, config.name);
        const MemoryPlace place = config.is_host_visible ? MemoryPlace::host : MemoryPlace::device;
        memory =
            device.memory->allocate({config.name, buffer.getMemoryRequirements(), place, config.purpose});
    });
    try {
        buffer.bindMemory(*memory.block->memory, memory.offset);
        if (config.format != TexelFormat::none) {
            texels = vk::raii::BufferView(device.shared->device,
                                          {{}, *buffer, find_texel(config.format).format, 0, VK_WHOLE_SIZE});
            device.set_name(texels, config.name + " (texels)");
        }
    } catch (const vk::SystemError& error) {
        device.memory->release(memory);
        throw_vulkan_error(config.name, error);
    }
}

Buffer::Implementation::~Implementation() {
    if (holds_nothing()) return;
    texels.clear();
    buffer.clear();
    device.memory->release(memory);
}

Buffer::Buffer() noexcept = default;

Buffer::Buffer(const Device& device, const BufferConfig& config)
    : implementation_(std::make_unique<Implementation>(device.internals(), config)) {}
Buffer::~Buffer() = default;
Buffer::Buffer(Buffer&&) noexcept = default;
Buffer& Buffer::operator=(Buffer&&) noexcept = default;

uint64_t Buffer::byte_count() const { return implementation_ ? implementation_->config.bytes : 0; }

void Buffer::upload(std::span<const std::byte> data, uint64_t offset) {
    DCHECK(offset + data.size() <= byte_count());
    Implementation& own = *implementation_;
    if (data.empty() || own.holds_nothing()) return;
    if (is_direct(own)) {
        std::memcpy(own.memory.mapped() + offset, data.data(), data.size());
        return;
    }
    Implementation& staging = own.device.staging();
    for (uint64_t done = 0; done < data.size();) {
        const uint64_t part = std::min<uint64_t>(data.size() - done, staging.config.bytes);
        std::memcpy(staging.memory.mapped(), data.data() + done, part);
        own.device.run_once("upload", [&](const vk::raii::CommandBuffer& commands) {
            commands.copyBuffer(*staging.buffer, *own.buffer, vk::BufferCopy(0, offset + done, part));
        });
        done += part;
    }
}

void Buffer::download(std::span<std::byte> data, uint64_t offset) const {
    std::byte* place = data.data();
    visit(offset, data.size(), 1, [&](std::span<const std::byte> part) {
        std::memcpy(place, part.data(), part.size());
        place += part.size();
    });
}

void Buffer::visit(uint64_t offset, uint64_t count, uint64_t unit,
                   const std::function<void(std::span<const std::byte>)>& take) const {
    DCHECK(offset + count <= byte_count());
    if (count == 0) return;
    const Implementation& own = *implementation_;
    if (is_direct(own)) return take({own.memory.mapped() + offset, count});
    Implementation& staging = own.device.staging();
    const uint64_t most = staging.config.bytes / unit * unit;
    DCHECK(most > 0);
    for (uint64_t done = 0; done < count;) {
        const uint64_t part = std::min(count - done, most);
        own.device.run_once("download", [&](const vk::raii::CommandBuffer& commands) {
            commands.copyBuffer(*own.buffer, *staging.buffer, vk::BufferCopy(offset + done, 0, part));
        });
        take({staging.memory.mapped(), part});
        done += part;
    }
}

void* Buffer::mapped() const {
    DCHECK(implementation_->config.is_host_visible && !implementation_->holds_nothing());
    return implementation_->memory.mapped();
}

} // namespace relief::vulkan
