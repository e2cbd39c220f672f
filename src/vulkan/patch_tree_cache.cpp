#include "vulkan/patch_tree_cache.h"
#include "formulas/patch_tree.h"
#include "vulkan/layout/bindings.h"
#include "vulkan/layout/device_rays.h"

#include <algorithm>
#include <cstddef>

namespace relief::vulkan {

namespace {

constexpr uint64_t kUnitBytes = scalar::kPoolUnitWords * sizeof(uint32_t);
constexpr uint64_t kLeastBytes = uint64_t(1) << 20;    ///< room for a few of the largest trees
constexpr uint64_t kWorkingBytes = uint64_t(64) << 20; ///< size of the pool without a cache
constexpr uint32_t kBudgetShare = 4;                   ///< a wave may fill 1 / kBudgetShare of the pool

} // namespace

PatchTreeCache::PatchTreeCache(const Device& device, uint64_t cap_bytes, uint32_t last_head)
    : is_kept_(cap_bytes > 0), last_head_(last_head) {
    const uint64_t wanted = std::max(is_kept_ ? cap_bytes : kWorkingBytes, kLeastBytes);
    const uint64_t bytes =
        std::max(kLeastBytes, std::min({wanted, device.max_buffer_bytes(), device.available_bytes() / 4}));
    capacity_ = uint32_t(bytes / kUnitBytes);
    pool_ = Buffer(device, {"patch trees", capacity_ * kUnitBytes, Purpose::bottom_cache});
}

void PatchTreeCache::bind(BindingTable& bindings) const { bindings.bind(scalar::kBindPool, pool_); }

void PatchTreeCache::begin_chunk(const Buffer& trees, Commands& commands) {
    if (head_ < last_head_) return;
    head_ = 0;
    commands.fill(trees, 0, trees.byte_count(), 0);
}

void PatchTreeCache::begin_wave(scalar::CastPush& push, const Buffer& counters, Commands& commands) {
    ++wave_;
    if (!is_kept_) head_ = 0;
    commands.fill(counters, offsetof(scalar::CounterData, pool_head), sizeof(uint32_t), head_);
    push.wave = wave_;
    push.pool_start = head_;
    push.pool_capacity = capacity_;
    push.pool_budget = is_kept_ ? capacity_ / kBudgetShare : capacity_;
    push.is_cached = is_kept_;
}

void PatchTreeCache::end_wave(const scalar::CounterData& counters) {
    // Allocations refused at the end of the wave advanced the counter as well.
    const uint32_t limit = head_ + (is_kept_ ? capacity_ / kBudgetShare : capacity_);
    head_ = std::min(counters.pool_head, limit);
}

} // namespace relief::vulkan
