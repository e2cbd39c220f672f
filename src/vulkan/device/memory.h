// Suballocated device memory, accounted by the byte, within heap sizes. Part of device.h's implementation.
#pragma once

#include <array>
#include <list>
#include <map>
#include <mutex>
#include <string_view>

#include <vulkan/vulkan_raii.hpp>

#include "vulkan/device/device.h"

namespace relief::vulkan {

enum class MemoryPlace { device, host };

struct MemoryBlock {
    vk::raii::DeviceMemory memory = nullptr;
    uint32_t type = 0;
    uint64_t bytes = 0;
    std::byte* mapped = nullptr;             ///< null if not host-coherent
    std::map<uint64_t, uint64_t> free_spans; ///< offset to bytes; coalesced
};

/// Part of a block that belongs to one buffer.
struct MemorySpan {
    std::list<MemoryBlock>::iterator block;
    uint64_t offset = 0, bytes = 0;
    Purpose purpose = Purpose::ray_buffers;

    std::byte* mapped() const { return block->mapped ? block->mapped + offset : nullptr; }
};

/// Thread safe.
class MemoryAllocator {
  public:
    MemoryAllocator(const vk::raii::PhysicalDevice& physical, const vk::raii::Device& device);

    struct Request {
        std::string_view name; ///< of the buffer, for messages
        vk::MemoryRequirements requirements;
        MemoryPlace place = MemoryPlace::device;
        Purpose purpose = Purpose::ray_buffers;
    };
    /// Throws Error{out_of_memory} with the requested and the available bytes.
    MemorySpan allocate(const Request& request);
    void release(const MemorySpan& span);

    /// Maximum bytes of one more allocation of device memory.
    uint64_t available_bytes() const;
    /// Bytes of the blocks of device memory.
    uint64_t held_bytes() const;
    uint64_t allocated_bytes(Purpose purpose) const;
    uint64_t peak_bytes(Purpose purpose) const;

  private:
    uint32_t choose_type(uint32_t type_bits, MemoryPlace place) const;
    uint32_t device_heap() const;
    uint64_t compute_available(uint32_t heap) const;
    MemorySpan carve(std::list<MemoryBlock>::iterator block, uint64_t offset, const Request& request);
    std::list<MemoryBlock>::iterator add_block(uint32_t type, const Request& request);
    std::list<MemoryBlock>::iterator try_block(uint32_t type, uint64_t bytes);
    [[noreturn]] void refuse(uint32_t type, const Request& request) const;
    std::string_view heap_name(uint32_t heap) const;

    const vk::raii::PhysicalDevice& physical_;
    const vk::raii::Device& device_;
    vk::PhysicalDeviceMemoryProperties properties_;
    bool has_budget_ = false;
    mutable std::mutex mutex_;
    std::list<MemoryBlock> blocks_;
    std::array<uint64_t, VK_MAX_MEMORY_HEAPS> heap_bytes_{};
    std::array<uint64_t, kPurposeCount> bytes_{}, peak_{};
};

} // namespace relief::vulkan
