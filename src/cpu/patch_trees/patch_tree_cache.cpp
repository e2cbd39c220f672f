#include "cpu/patch_trees/patch_tree_cache.h"

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <new>
#include <utility>

#include "base/check.h"
#include "base/machine.h"
#include "base/stop_request.h"
#include "base/timer.h"

namespace relief::cpu {

namespace {

static_assert(std::atomic<TreeSlot>::is_always_lock_free);

constexpr size_t kProbeCount = 8;       ///< slots looked at for one key
constexpr size_t kMeanTreeBytes = 4096; ///< decides the size of the table
constexpr size_t kLongestSearch = 8192; ///< slots that one eviction looks at
constexpr size_t kTableGrowth = 4;      ///< for how many times the first cap there are slots

uint64_t hash_key(const TreeKey& key) {
    // Two rounds of the finalizer of Steele, Lea and Flood 2014 (SplitMix64).
    const auto mix = [](uint64_t x) {
        x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
        x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
        return x ^ (x >> 31);
    };
    return mix(mix(uint64_t(key.patch) << 32 | key.surface) + (uint64_t(key.tile) << 32 | key.levels));
}

/// Directories above one that is visited stay where they are.
TileDirectory* find_directory_scratch(const TraceContext& context, const TreeKey& key) {
    return static_cast<TileDirectory*>(context.directory_scratch.get()) +
           DirectoryPlace::from_number(key.tile).step;
}

/// What a ray looks at next, while the key is still on its way.
void prefetch_boxes(const CachedTree* tree) {
    const char* boxes = reinterpret_cast<const char*>(tree + 1);
    for (size_t line = 0; line < sizeof(Node16); line += 64) __builtin_prefetch(boxes + line);
}

void* allocate_aligned(size_t bytes) {
    void* memory = std::aligned_alloc(64, (bytes + 63) / 64 * 64);
    if (!memory) throw std::bad_alloc();
    return memory;
}

} // namespace

void TraceContext::AlignedFree::operator()(void* memory) const { std::free(memory); }

void TraceCounters::add(const TraceCounters& other) {
    pairs_emitted += other.pairs_emitted, pairs_with_hit += other.pairs_with_hit;
    built += other.built, reused += other.reused, rebuilt += other.rebuilt;
    upper_nodes += other.upper_nodes, patch_nodes += other.patch_nodes, blocks += other.blocks;
    for (int level = 0; level <= kMaxLevel; ++level) built_at_level[level] += other.built_at_level[level];
    bottom_build_s += other.bottom_build_s, sampled_bottom_s += other.sampled_bottom_s;
}

void CastCounters::add(const CastCounters& other) {
    batches += other.batches, rays += other.rays, pairs += other.pairs;
    bottom_build_s += other.bottom_build_s, trace_s += other.trace_s;
    sampled_trace_s += other.sampled_trace_s, sampled_bottom_s += other.sampled_bottom_s;
}

PatchTreeCache::PatchTreeCache(CacheLimits limits, BuildTreeFunction build_tree) : build_tree_(build_tree) {
    if (limits.cap_bytes > 0) {
        // Fixed from here on; a cache that has to grow holds trees larger than the mean.
        const size_t expected_bytes = std::min(limits.most_bytes, kTableGrowth * limits.cap_bytes);
        const size_t count = std::max(limits.cap_bytes, expected_bytes) / kMeanTreeBytes;
        const size_t most_slots = std::bit_floor(limits.cap_bytes / (8 * sizeof(slots_[0])) + 1);
        slot_count_ = std::max(std::bit_ceil(std::clamp<size_t>(count, 64, size_t(1) << 20)),
                               std::min(std::bit_ceil(2 * limits.patch_count), most_slots));
        slots_ = std::make_unique<std::atomic<TreeSlot>[]>(slot_count_);
    }
    const auto without_table = [&](size_t bytes) { return bytes - std::min(bytes, table_bytes()); };
    cap_bytes_ = without_table(limits.cap_bytes), most_bytes_ = without_table(limits.most_bytes);
    while (!memory_.add(cap_bytes_))
        most_bytes_ = cap_bytes_ = cap_bytes_ / 2; // where the system sets a limit
}

PatchTreeCache::~PatchTreeCache() {
    for (size_t slot = 0; slot < slot_count_; ++slot)
        if (CachedTree* tree = slots_[slot].load().tree()) free_tree(tree);
    for (TraceContext* context = contexts_.load(); context;) {
        for (const TraceContext::Retired& retired : context->retired) free_tree(retired.tree);
        delete std::exchange(context, context->next);
    }
}

TraceContext& PatchTreeCache::acquire() {
    TraceContext* context = contexts_.load();
    for (; context; context = context->next)
        if (!context->is_taken.load() && !context->is_taken.exchange(true)) break;
    if (!context) {
        context = new TraceContext;
        context->is_taken.store(true);
        context->tree_scratch.reset(allocate_aligned(PatchTree::size_bytes(kTileLevel)));
        context->directory_scratch.reset(allocate_aligned(kMostDirectorySteps * sizeof(TileDirectory)));
        context->next = contexts_.load();
        while (!contexts_.compare_exchange_weak(context->next, context)) {
        }
    }
    refresh(*context);
    return *context;
}

void PatchTreeCache::release(TraceContext& context) {
    context.epoch.store(0);
    context.is_taken.store(false);
}

void PatchTreeCache::remove(const std::function<bool(const TreeKey&)>& is_stale) {
    for (size_t slot = 0; slot < slot_count_; ++slot) {
        CachedTree* tree = slots_[slot].load().tree();
        if (!tree || !is_stale(tree->key)) continue;
        slots_[slot].store({});
        free_tree(tree);
    }
    // What workers found last is found anew.
    epoch_.fetch_add(1);
}

CachedTree* PatchTreeCache::find(TraceContext& context, const TreeKey& key) const {
    if (slot_count_ == 0) return nullptr;
    const size_t home = hash_key(key);
    for (size_t probe = 0; probe < kProbeCount; ++probe) {
        const TreeSlot slot = slots_[(home + probe) & (slot_count_ - 1)].load(std::memory_order_seq_cst);
        if (!slot.may_hold(home)) continue;
        CachedTree* tree = slot.tree();
        prefetch_boxes(tree);
        if (tree->key == key) {
            if (!tree->is_recent.load(std::memory_order_relaxed))
                tree->is_recent.store(1, std::memory_order_relaxed);
            ++context.counters.reused;
            context.recent.place(key) = {key, tree, context.epoch.load(std::memory_order_relaxed)};
            return tree;
        }
    }
    return nullptr;
}

const CachedTree& PatchTreeCache::find_or_build_elsewhere(TraceContext& context, const Surface& surface,
                                                          const TreeKey& key) {
    if (const CachedTree* found = context.owns_trees ? find_owned(context, key) : find(context, key))
        return *found;
    if (is_stop_asked_for_ && is_stop_asked_for_()) throw StopRequest();
    const Timer timer;
    const bool is_directory = key.tile >= kDirectories;
    CachedTree* tree = is_directory ? static_cast<CachedTree*>(make_directory(context, surface, key))
                                    : make_tree(context, surface, key);
    const bool is_scratch =
        tree == context.tree_scratch.get() || (is_directory && tree == find_directory_scratch(context, key));
    if (slot_count_ > 0) note_rebuild(context, *tree);
    if (context.owns_trees)
        own(context, tree);
    else if (is_scratch)
        given_up_.add(hash_key(key));
    else
        offer(context, tree);
    context.counters.bottom_build_s += timer.seconds();
    return *tree;
}

PatchTree* PatchTreeCache::make_tree(TraceContext& context, const Surface& surface, const TreeKey& key) {
    const PatchLevels levels = unpack_levels(key.levels);
    const int depth = std::max(0, int(levels.patch) - kTileLevel);
    const int level = levels.patch - depth;
    const size_t bytes = PatchTree::size_bytes(level);
    void* memory = allocate(context, bytes);
    BlockGuard guard{*this, memory, TreeMemory::block_bytes(bytes), context.owns_trees};
    PatchTree* tree = new (memory ? memory : context.tree_scratch.get()) PatchTree;
    tree->key = key;
    tree->byte_count = uint32_t(bytes);
    tree->level = uint32_t(level);
    tree->cell_x = (key.tile & ((1u << depth) - 1)) << kTileLevel;
    tree->cell_y = (key.tile >> depth) << kTileLevel;
    build_tree_(surface, levels, *tree);
    guard.memory = nullptr;
    ++context.counters.built;
    ++context.counters.built_at_level[level];
    return tree;
}

TileDirectory* PatchTreeCache::make_directory(TraceContext& context, const Surface& surface,
                                              const TreeKey& key) {
    constexpr size_t kBytes = sizeof(TileDirectory);
    void* memory = allocate(context, kBytes);
    BlockGuard guard{*this, memory, TreeMemory::block_bytes(kBytes), context.owns_trees};
    TileDirectory* directory = new (memory ? memory : find_directory_scratch(context, key)) TileDirectory;
    directory->key = key;
    directory->byte_count = uint32_t(kBytes);
    build_tile_directory(surface, unpack_levels(key.levels), *directory);
    guard.memory = nullptr;
    return directory;
}

void* PatchTreeCache::allocate(TraceContext& context, size_t bytes) {
    if (context.owns_trees) {
        const size_t taken = TreeMemory::block_bytes(bytes);
        note_peak(allocated_.fetch_add(taken) + taken);
        return allocate_aligned(bytes);
    }
    if (slot_count_ == 0) return nullptr;
    void* memory = memory_.allocate(bytes);
    if (!memory) {
        free_retired(context);
        memory = memory_.allocate(bytes);
        if (!memory && grow()) memory = memory_.allocate(bytes);
        // Unlinked entries become free when other workers move on; more would only empty the table.
        if (!memory && retired_.load() < find_reserve(bytes)) evict(context, bytes);
    }
    if (memory) {
        const size_t taken = TreeMemory::block_bytes(bytes);
        note_peak(allocated_.fetch_add(taken) + taken);
    }
    return memory;
}

void PatchTreeCache::note_peak(size_t now) {
    for (size_t peak = peak_.load(); peak < now && !peak_.compare_exchange_weak(peak, now);) {
    }
}

PatchTreeCache::OwnedTrees::OwnedTrees(PatchTreeCache& cache, TraceContext& context)
    : cache_(cache), context_(context) {
    context_.owns_trees = true;
}

PatchTreeCache::OwnedTrees::~OwnedTrees() {
    for (CachedTree* tree : context_.owned) {
        context_.recent.place(tree->key).epoch = 0;
        cache_.allocated_.fetch_sub(TreeMemory::block_bytes(tree->byte_count));
        std::free(static_cast<void*>(tree));
    }
    context_.owned.clear();
    context_.owns_trees = false;
}

void PatchTreeCache::own(TraceContext& context, CachedTree* tree) const {
    context.owned.push_back(tree);
    context.recent.place(tree->key) = {tree->key, tree, context.epoch.load(std::memory_order_relaxed)};
}

CachedTree* PatchTreeCache::find_owned(TraceContext& context, const TreeKey& key) const {
    const auto found =
        std::ranges::find_if(context.owned, [&](const auto* tree) { return tree->key == key; });
    if (found == context.owned.end()) return nullptr;
    ++context.counters.reused;
    context.recent.place(key) = {key, *found, context.epoch.load(std::memory_order_relaxed)};
    return *found;
}

void PatchTreeCache::offer(TraceContext& context, CachedTree* tree) {
    const size_t home = hash_key(tree->key);
    const TreeSlot slot(tree, home);
    for (size_t probe = 0; probe < kProbeCount; ++probe) {
        TreeSlot expected;
        const size_t number = (home + probe) & (slot_count_ - 1);
        TreeMemory::set_owner(tree, uint32_t(number)); // before others see the tree
        if (slots_[number].compare_exchange_strong(expected, slot)) return;
    }
    // Every slot of this key is taken: the first one makes way.
    TreeMemory::set_owner(tree, uint32_t(home & (slot_count_ - 1)));
    if (CachedTree* previous = slots_[home & (slot_count_ - 1)].exchange(slot).tree())
        retire(context, previous);
}

void PatchTreeCache::retire(TraceContext& context, CachedTree* tree) {
    given_up_.add(hash_key(tree->key));
    retired_.fetch_add(TreeMemory::block_bytes(tree->byte_count));
    TreeMemory::set_owner(tree, TreeMemory::kLeaving);
    context.retired.push_back({tree, epoch_.fetch_add(1)});
}

void PatchTreeCache::note_rebuild(TraceContext& context, const CachedTree& tree) {
    if (!given_up_.may_contain(hash_key(tree.key))) return;
    context.counters.rebuilt += tree.key.tile < kDirectories;
    rebuilt_bytes_.fetch_add(tree.byte_count, std::memory_order_relaxed);
}

size_t PatchTreeCache::find_room() const {
    const size_t cap = cap_bytes_.load();
    return cap + std::min(most_bytes_ - cap, cap < most_bytes_ ? available_memory_bytes() / 2 : 0);
}

/// Raises the cap if trees are built again and memory is available; true if there is more room now.
bool PatchTreeCache::grow() {
    if (rebuilt_bytes_.load(std::memory_order_relaxed) < cap_bytes_.load() / 4) return false;
    const std::lock_guard lock(grow_mutex_);
    const size_t cap = cap_bytes_.load(), most = most_bytes_.load();
    if (cap >= most) return false;
    if (rebuilt_bytes_.exchange(0) < cap / 4) return true; // another worker was first
    const size_t wanted = std::min(2 * cap, most);
    if (available_memory_bytes() / 2 < wanted - cap) return false; // looks again after as many builds
    if (!memory_.add(wanted - cap)) {
        most_bytes_ = cap;
        return false;
    }
    cap_bytes_ = wanted;
    return true;
}

/// Takes out what the slot holds; returns its bytes.
size_t PatchTreeCache::unlink(TraceContext& context, uint32_t slot) {
    TreeSlot held = slots_[slot].load();
    CachedTree* tree = held.tree();
    if (!tree) return 0;
    const size_t bytes = TreeMemory::block_bytes(tree->byte_count);
    if (!slots_[slot].compare_exchange_strong(held, TreeSlot())) return 0;
    retire(context, tree);
    return bytes;
}

/// First neighbours in memory, so that there will be room for `bytes` in one place; then others.
void PatchTreeCache::evict(TraceContext& context, size_t bytes) {
    const size_t target = find_reserve(bytes); // and no endless search
    const size_t step_count = std::min(2 * slot_count_, kLongestSearch);
    size_t unlinked = 0;
    bool has_run = false;
    std::vector<uint32_t> neighbours;
    for (size_t step = 0; step < step_count && unlinked < target; ++step) {
        const auto number = uint32_t(hand_.fetch_add(1) & (slot_count_ - 1));
        CachedTree* tree = slots_[number].load().tree();
        if (!tree || tree->is_recent.exchange(0)) continue;
        if (!has_run && memory_.find_owners(tree, bytes, neighbours)) {
            has_run = true;
            for (const uint32_t neighbour : neighbours) unlinked += unlink(context, neighbour);
        }
        unlinked += unlink(context, number);
    }
}

void PatchTreeCache::free_retired(TraceContext& context) {
    uint64_t oldest = epoch_.load();
    for (const TraceContext* other = contexts_.load(); other; other = other->next)
        if (const uint64_t epoch = other->epoch.load()) oldest = std::min(oldest, epoch);
    free_older(context, oldest);
    // Idle workers cannot free what they retired last: a worker that needs the memory does it for them.
    for (TraceContext* other = contexts_.load(); other; other = other->next) {
        if (other->is_taken.load() || other->is_taken.exchange(true)) continue;
        free_older(*other, oldest);
        other->is_taken.store(false);
    }
}

void PatchTreeCache::free_older(TraceContext& context, uint64_t epoch) {
    const auto is_free = [&](const TraceContext::Retired& retired) { return retired.epoch < epoch; };
    size_t bytes = 0;
    context.freed.clear();
    for (const TraceContext::Retired& retired : context.retired) {
        if (!is_free(retired)) continue;
        bytes += TreeMemory::block_bytes(retired.tree->byte_count);
        context.freed.push_back(retired.tree);
    }
    allocated_.fetch_sub(bytes); // before others can take it
    memory_.free(context.freed);
    retired_.fetch_sub(bytes);
    std::erase_if(context.retired, is_free);
}

void PatchTreeCache::free_tree(CachedTree* tree) {
    allocated_.fetch_sub(TreeMemory::block_bytes(tree->byte_count));
    void* const block = tree;
    memory_.free({&block, 1});
}

PatchTreeCache::BlockGuard::~BlockGuard() {
    if (!memory) return;
    cache.allocated_.fetch_sub(taken);
    if (is_owned)
        std::free(memory);
    else
        cache.memory_.free({&memory, 1});
}

TraceCounters PatchTreeCache::sum_counters() const {
    TraceCounters sum;
    for (const TraceContext* context = contexts_.load(); context; context = context->next)
        sum.add(context->counters);
    return sum;
}

std::vector<CastCounters> PatchTreeCache::sum_casts() const {
    std::vector<CastCounters> sums;
    for (const TraceContext* context = contexts_.load(); context; context = context->next) {
        sums.resize(std::max(sums.size(), context->casts.size()));
        for (size_t k = 0; k < context->casts.size(); ++k) sums[k].add(context->casts[k]);
    }
    return sums;
}

} // namespace relief::cpu
