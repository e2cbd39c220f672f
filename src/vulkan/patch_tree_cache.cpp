#include "vulkan/patch_tree_cache.h"
#include "formulas/patch_tree.h"
#include "relief/error.h"
#include "relief/render.h"
#include "vulkan/layout/bindings.h"
#include "vulkan/layout/device_rays.h"

#include <algorithm>
#include <cstddef>

namespace relief::vulkan {

namespace {

constexpr uint64_t kUnitBytes = scalar::kPoolUnitWords * sizeof(uint32_t);
constexpr uint64_t kLeastBytes = uint64_t(1) << 20;    ///< room for a few of the largest trees
constexpr uint64_t kWorkingBytes = uint64_t(64) << 20; ///< size of the pool without a cache
constexpr uint32_t kBudgetShare = 4;                   ///< a wave may overwrite 1 / kBudgetShare of the pool
/// A wave of a GPU costs more than what it overwrites.
constexpr uint32_t kBudgetShareOfGpu = 2;
constexpr uint64_t kDeviceShare = 4; ///< the pool may take 1 / kDeviceShare of what is free
constexpr uint64_t kGrowth = 4;
/// The most that a GPU begins with. Its driver makes memory ready much slower (45 ms a GB on an H100, driver
/// 580) than trees are built there (0.8 ms), so that more pays only once very many were built again.
constexpr uint64_t kFirstBytes = uint64_t(1) << 30;
constexpr uint64_t kLeastBytesOfGpu = uint64_t(512) << 20;
constexpr uint64_t kRebuildsBeforeGrowth = 32;

} // namespace

/// A GPU has work for all its lanes only where the trees of a wave have room.
PoolGrowth choose_pool_growth(const Device& device, const PoolLimits& limits) {
    const bool is_kept = limits.cap_bytes.value_or(1) > 0;
    const uint64_t most = std::min(device.max_buffer_bytes(), device.available_bytes() / kDeviceShare);
    PoolGrowth growth;
    growth.rebuilds = kRebuildsBeforeGrowth;
    growth.budget_share = device.is_cpu() ? kBudgetShare : kBudgetShareOfGpu;
    growth.first_bytes = is_kept ? limits.cap_bytes.value_or(kDefaultCacheBytes) : kWorkingBytes;
    if (!device.is_cpu() && !(is_kept && limits.cap_bytes)) {
        // Levels that several rays see differently, and tiles, take more than is known.
        const uint64_t expected = limits.tree_bytes + limits.tree_bytes / 8;
        growth.first_bytes = std::clamp(expected, kLeastBytesOfGpu, kFirstBytes);
        growth.most_bytes = is_kept ? most : 0;
    }
    growth.first_bytes = std::max(kLeastBytes, std::min(growth.first_bytes, most));
    return growth;
}

PatchTreeCache::PatchTreeCache(const Device& device, const PoolLimits& limits, const PoolGrowth& growth)
    : device_(device),
      is_kept_(limits.cap_bytes.value_or(1) > 0),
      last_head_(limits.last_head),
      growth_(growth) {
    make_pool(growth.first_bytes);
}

void PatchTreeCache::make_pool(uint64_t bytes) {
    capacity_ = uint32_t(bytes / kUnitBytes);
    pool_ = {}; // frees its memory
    pool_ = Buffer(device_, {"patch trees", capacity_ * kUnitBytes, Purpose::bottom_cache});
}

void PatchTreeCache::bind(BindingTable& bindings) const { bindings.bind(scalar::kBindPool, pool_); }

/// Keeps its size where the device has no room for more, and does not try again.
void PatchTreeCache::grow(Commands& commands, BindingTable& bindings) {
    commands.run(); // what was recorded may use the pool
    const uint64_t bytes = pool_.byte_count();
    try {
        make_pool(std::min(
            {kGrowth * bytes, growth_.most_bytes, bytes + device_.available_bytes() / kDeviceShare}));
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::out_of_memory) throw;
        growth_.most_bytes = bytes;
        make_pool(bytes);
    }
    built_units_ = 0;
    bind(bindings);
}

void PatchTreeCache::begin_chunk(const Buffer& trees, Commands& commands, BindingTable& bindings) {
    const bool is_growing = built_units_ > uint64_t(growth_.rebuilds) * capacity_ &&
                            pool_.byte_count() + kLeastBytes <= growth_.most_bytes;
    if (head_ < last_head_ && !is_growing) return;
    if (is_growing) grow(commands, bindings);
    head_ = 0;
    commands.fill(trees, 0, trees.byte_count(), 0);
}

/// Units that a wave may take: all that no tree has had yet, or a share of the pool. Without a cache all of
/// it.
uint32_t PatchTreeCache::find_budget() const {
    if (!is_kept_) return capacity_;
    return std::max(capacity_ / growth_.budget_share, capacity_ - std::min(head_, capacity_));
}

void PatchTreeCache::begin_wave(scalar::CastPush& push, const Buffer& counters, Commands& commands) {
    ++wave_;
    if (!is_kept_) head_ = 0;
    commands.fill(counters, offsetof(scalar::CounterData, pool_head), sizeof(uint32_t), head_);
    push.wave = wave_;
    push.pool_start = head_;
    push.pool_capacity = capacity_;
    push.pool_budget = find_budget();
    push.is_cached = is_kept_;
}

void PatchTreeCache::end_wave(const scalar::CounterData& counters) {
    // Allocations refused at the end of the wave advanced the counter as well.
    const uint32_t head = std::min(counters.pool_head, head_ + find_budget());
    built_units_ += head - head_;
    head_ = head;
}

} // namespace relief::vulkan
