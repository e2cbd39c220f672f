#include "vulkan/device/memory.h"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include "vulkan/device/errors.h"
#include "vulkan/device/instance.h"

namespace relief::vulkan {
namespace {

constexpr uint64_t kLargestBlock = 64u << 20;
/// Smaller blocks on small heaps.
constexpr uint64_t kBlocksPerHeap = 16;

uint64_t align_up(uint64_t value, uint64_t alignment) {
    return (value + alignment - 1) / alignment * alignment;
}

void give_back(std::map<uint64_t, uint64_t>& free_spans, uint64_t offset, uint64_t bytes) {
    auto next = free_spans.lower_bound(offset);
    if (next != free_spans.end() && offset + bytes == next->first) {
        bytes += next->second;
        next = free_spans.erase(next);
    }
    if (next != free_spans.begin()) {
        const auto previous = std::prev(next);
        if (previous->first + previous->second == offset) {
            previous->second += bytes;
            return;
        }
    }
    free_spans.emplace(offset, bytes);
}

} // namespace

MemoryAllocator::MemoryAllocator(const vk::raii::PhysicalDevice& physical, const vk::raii::Device& device)
    : physical_(physical),
      device_(device),
      properties_(physical.getMemoryProperties()),
      has_budget_(has_extension(physical, VK_EXT_MEMORY_BUDGET_EXTENSION_NAME)) {}

uint32_t MemoryAllocator::choose_type(uint32_t type_bits, MemoryPlace place) const {
    using Flag = vk::MemoryPropertyFlagBits;
    const vk::MemoryPropertyFlags wanted = place == MemoryPlace::device
                                               ? vk::MemoryPropertyFlags(Flag::eDeviceLocal)
                                               : Flag::eHostVisible | Flag::eHostCoherent;
    // The largest heap: a host-visible window into device memory may be a separate heap.
    const auto rank = [&](uint32_t type) {
        const vk::MemoryType& t = properties_.memoryTypes[type];
        const bool is_cached = place == MemoryPlace::host && (t.propertyFlags & Flag::eHostCached);
        return std::pair(is_cached, uint64_t(properties_.memoryHeaps[t.heapIndex].size));
    };
    const vk::MemoryPropertyFlags special =
        Flag::eProtected | Flag::eLazilyAllocated | Flag::eDeviceCoherentAMD | Flag::eDeviceUncachedAMD;
    std::optional<uint32_t> best;
    for (uint32_t type = 0; type < properties_.memoryTypeCount; ++type) {
        const vk::MemoryPropertyFlags flags = properties_.memoryTypes[type].propertyFlags;
        const bool is_fit = (type_bits >> type & 1u) != 0 && (flags & wanted) == wanted && !(flags & special);
        if (is_fit && (!best || rank(type) > rank(*best))) best = type;
    }
    if (!best) throw Error(ErrorKind::device_missing, {"no memory type fits buffers", "Vulkan", kUseCpu});
    return *best;
}

uint32_t MemoryAllocator::device_heap() const {
    return properties_.memoryTypes[choose_type(~0u, MemoryPlace::device)].heapIndex;
}

uint64_t MemoryAllocator::compute_available(uint32_t heap) const {
    const uint64_t size = properties_.memoryHeaps[heap].size;
    const uint64_t own = heap_bytes_[heap];
    uint64_t available = size > own ? size - own : 0;
    if (has_budget_) {
        const auto chain = physical_.getMemoryProperties2<vk::PhysicalDeviceMemoryProperties2,
                                                          vk::PhysicalDeviceMemoryBudgetPropertiesEXT>();
        const auto& budget = chain.get<vk::PhysicalDeviceMemoryBudgetPropertiesEXT>();
        const uint64_t limit = budget.heapBudget[heap], used = budget.heapUsage[heap];
        available = std::min(available, limit > used ? limit - used : 0);
    }
    return available;
}

std::string_view MemoryAllocator::heap_name(uint32_t heap) const {
    const bool is_local(properties_.memoryHeaps[heap].flags & vk::MemoryHeapFlagBits::eDeviceLocal);
    return is_local ? "device memory" : "host memory for the device";
}

void MemoryAllocator::refuse(uint32_t type, const Request& request) const {
    const uint32_t heap = properties_.memoryTypes[type].heapIndex;
    throw Error(ErrorKind::out_of_memory,
                {fmt::format("{} needs {} bytes of {}, {} of {} bytes are available", request.name,
                             request.requirements.size, heap_name(heap), compute_available(heap),
                             properties_.memoryHeaps[heap].size),
                 "Vulkan", "lower surface.cache_bytes or the resolution, or use device.engine = cpu"});
}

std::list<MemoryBlock>::iterator MemoryAllocator::try_block(uint32_t type, uint64_t bytes) {
    const vk::MemoryType& properties = properties_.memoryTypes[type];
    if (bytes > compute_available(properties.heapIndex)) return blocks_.end();
    try {
        MemoryBlock block;
        block.memory = vk::raii::DeviceMemory(device_, vk::MemoryAllocateInfo(bytes, type));
        block.type = type;
        block.bytes = bytes;
        block.free_spans.emplace(0, bytes);
        const auto reachable =
            vk::MemoryPropertyFlagBits::eHostVisible | vk::MemoryPropertyFlagBits::eHostCoherent;
        if ((properties.propertyFlags & reachable) == reachable)
            block.mapped = static_cast<std::byte*>(block.memory.mapMemory(0, VK_WHOLE_SIZE));
        blocks_.push_back(std::move(block));
    } catch (const vk::OutOfDeviceMemoryError&) {
        return blocks_.end();
    } catch (const vk::OutOfHostMemoryError&) {
        return blocks_.end();
    } catch (const vk::SystemError& error) {
        throw_vulkan_error("vkAllocateMemory", error);
    }
    heap_bytes_[properties.heapIndex] += bytes;
    return std::prev(blocks_.end());
}

std::list<MemoryBlock>::iterator MemoryAllocator::add_block(uint32_t type, const Request& request) {
    const uint64_t heap_size = properties_.memoryHeaps[properties_.memoryTypes[type].heapIndex].size;
    const uint64_t usual = std::min(kLargestBlock, heap_size / kBlocksPerHeap);
    const uint64_t needed = request.requirements.size;
    if (needed <= usual / 2) {
        const auto block = try_block(type, usual);
        if (block != blocks_.end()) return block;
    }
    const auto block = try_block(type, needed);
    if (block == blocks_.end()) refuse(type, request);
    return block;
}

MemorySpan MemoryAllocator::carve(std::list<MemoryBlock>::iterator block, uint64_t offset,
                                  const Request& request) {
    const uint64_t begin = align_up(offset, request.requirements.alignment);
    const uint64_t end = begin + request.requirements.size;
    const auto span = block->free_spans.find(offset);
    const uint64_t span_end = offset + span->second;
    block->free_spans.erase(span);
    if (begin > offset) block->free_spans.emplace(offset, begin - offset);
    if (span_end > end) block->free_spans.emplace(end, span_end - end);
    uint64_t& account = bytes_[size_t(request.purpose)];
    account += request.requirements.size;
    peak_[size_t(request.purpose)] = std::max(peak_[size_t(request.purpose)], account);
    return {block, begin, request.requirements.size, request.purpose};
}

MemorySpan MemoryAllocator::allocate(const Request& request) {
    const std::lock_guard lock(mutex_);
    const uint32_t type = choose_type(request.requirements.memoryTypeBits, request.place);
    for (auto block = blocks_.begin(); block != blocks_.end(); ++block) {
        if (block->type != type) continue;
        for (const auto& [offset, bytes] : block->free_spans)
            if (align_up(offset, request.requirements.alignment) + request.requirements.size <=
                offset + bytes)
                return carve(block, offset, request);
    }
    return carve(add_block(type, request), 0, request);
}

void MemoryAllocator::release(const MemorySpan& span) {
    const std::lock_guard lock(mutex_);
    bytes_[size_t(span.purpose)] -= span.bytes;
    give_back(span.block->free_spans, span.offset, span.bytes);
    if (span.block->free_spans.begin()->second < span.block->bytes) return;
    heap_bytes_[properties_.memoryTypes[span.block->type].heapIndex] -= span.block->bytes;
    blocks_.erase(span.block);
}

uint64_t MemoryAllocator::available_bytes() const {
    const std::lock_guard lock(mutex_);
    return compute_available(device_heap());
}

uint64_t MemoryAllocator::held_bytes() const {
    const std::lock_guard lock(mutex_);
    return heap_bytes_[device_heap()];
}

uint64_t MemoryAllocator::allocated_bytes(Purpose purpose) const {
    const std::lock_guard lock(mutex_);
    return bytes_[size_t(purpose)];
}

uint64_t MemoryAllocator::peak_bytes(Purpose purpose) const {
    const std::lock_guard lock(mutex_);
    return peak_[size_t(purpose)];
}

} // namespace relief::vulkan
