#include "vulkan/cast_buffers.h"
#include "vulkan/layout/bindings.h"
#include "vulkan/layout/device_rays.h"

#include <algorithm>
#include <utility>

namespace relief::vulkan {

namespace {

template <class T> Buffer make_array(const Device& device, const char* name, uint64_t count) {
    return {device, {name, count * sizeof(T), Purpose::ray_buffers}};
}

} // namespace

CastBuffers::CastBuffers(const Device& device, const TracerConfig& config, uint64_t histogram_words)
    : pair_capacity_(config.pair_capacity) {
    const uint64_t chunk = config.pair_capacity / config.slots;
    const uint64_t places = std::max(config.pair_capacity, scalar::kMostSlots);
    rays = make_array<scalar::RayData>(device, "rays", config.ray_capacity);
    hits = make_array<scalar::HitData>(device, "hits", config.ray_capacity);
    active = make_array<uint32_t>(device, "active rays", config.ray_capacity);
    next_active = make_array<uint32_t>(device, "next active rays", config.ray_capacity);
    cursors = make_array<scalar::CursorData>(device, "cursors", config.ray_capacity);
    candidates = make_array<scalar::CandidateData>(device, "candidates", places);
    pairs = make_array<uint64_t>(device, "pairs", places);
    sorted_pairs = make_array<uint64_t>(device, "sorted pairs", places);
    histogram = make_array<uint32_t>(device, "histogram",
                                     std::max<uint64_t>(histogram_words, scalar::kRequestBits / 32));
    nearest = make_array<uint64_t>(device, "nearest", chunk);
    counters = make_array<scalar::CounterData>(device, "counters", 1);
    BufferConfig on_host{"counters on the host", sizeof(scalar::CounterData), Purpose::staging};
    on_host.is_host_visible = true;
    counters_on_host = Buffer(device, on_host);
    BufferConfig indirect{"arguments", scalar::kArgumentCount * kArgumentBytes, Purpose::ray_buffers};
    indirect.is_indirect = true;
    arguments = Buffer(device, indirect);
    requests = make_array<scalar::RequestData>(device, "tile requests", kRequestCapacity);
}

void CastBuffers::bind(BindingTable& bindings) const {
    const std::pair<uint32_t, const Buffer*> table[] = {
        {scalar::kBindRays, &rays},           {scalar::kBindHits, &hits},
        {scalar::kBindActive, &active},       {scalar::kBindNextActive, &next_active},
        {scalar::kBindCursors, &cursors},     {scalar::kBindCandidates, &candidates},
        {scalar::kBindPairs, &pairs},         {scalar::kBindSortedPairs, &sorted_pairs},
        {scalar::kBindHistogram, &histogram}, {scalar::kBindNearest, &nearest},
        {scalar::kBindCounters, &counters},   {scalar::kBindArguments, &arguments},
        {scalar::kBindRequests, &requests}};
    for (const auto& [number, buffer] : table) bindings.bind(number, *buffer);
}

void CastBuffers::reserve_trees(const Device& device, uint32_t count, Commands& commands,
                                BindingTable& bindings) {
    if (count <= tree_capacity_) return;
    const uint32_t capacity = tree_capacity_ == 0 ? count : count + count / 2;
    Buffer larger = make_array<scalar::TreeRecord>(device, "tree records", capacity);
    const uint64_t old_bytes = uint64_t(tree_capacity_) * sizeof(scalar::TreeRecord);
    if (old_bytes > 0) commands.copy(trees, 0, larger, 0, old_bytes);
    commands.fill(larger, old_bytes, capacity * sizeof(scalar::TreeRecord) - old_bytes, 0);
    commands.run();
    trees = std::move(larger);
    tree_capacity_ = capacity;
    bindings.bind(scalar::kBindTrees, trees);
    if (job_capacity_ == pair_capacity_) return;
    job_capacity_ = std::min(pair_capacity_, capacity);
    jobs = make_array<uint32_t>(device, "jobs", job_capacity_);
    builds = make_array<uint32_t>(device, "builds", uint64_t(scalar::kBuildBinCount) * job_capacity_);
    bindings.bind(scalar::kBindJobs, jobs);
    bindings.bind(scalar::kBindBuilds, builds);
}

void CastBuffers::swap_active(BindingTable& bindings) {
    std::swap(active, next_active);
    bindings.bind(scalar::kBindActive, active);
    bindings.bind(scalar::kBindNextActive, next_active);
}

} // namespace relief::vulkan
