#include "vulkan/tracer.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include "formulas/patch_tree.h"
#include "prepare/bounce_lod.h"
#include "relief/error.h"
#include "vulkan/cast_buffers.h"
#include "vulkan/cast_kernels.h"
#include "vulkan/layout/bindings.h"
#include "vulkan/layout/device_rays.h"
#include "vulkan/patch_tree_cache.h"
#include "vulkan/radix_sort.h"
#include "vulkan/tile_directory.h"

namespace relief::vulkan {

namespace {

using scalar::CastPush;
using scalar::CounterData;

static_assert(scalar::kMostCollected < (1u << (32 - scalar::kCellBits)));

constexpr uint32_t kPairCountWord = offsetof(CounterData, pair_count) / sizeof(uint32_t);

/// Bounces may see coarser trees. A ray of a later round needs room for all its candidates.
TracerConfig complete_config(TracerConfig config, const PreparedScene& scene,
                             const RenderSettings& settings) {
    config.may_see_coarser |= make_bounce_lod(scene, settings).cell_angle > 0;
    config.pair_capacity = std::max({config.pair_capacity, scalar::kMostSlots, config.collected});
    return config;
}

PatchTreeCache make_cache(const Device& device, const DeviceScene& scene, const RenderSettings& settings,
                          const TracerConfig& config) {
    const PoolLimits limits{settings.surface.cache_bytes, scene.tree_bytes(), config.pool_restart_units};
    return {device, limits, config.pool_growth ? *config.pool_growth : choose_pool_growth(device, limits)};
}

/// Totals over the whole render.
struct Totals {
    uint64_t pairs = 0, pairs_with_hit = 0, reused = 0;
    std::array<uint64_t, scalar::kTreeLevels + 1> built{};
};

} // namespace

struct Tracer::Implementation {
    Implementation(const Device& d, const PreparedScene& s, const DeviceScene& ds,
                   const RenderSettings& settings, const TracerConfig& c)
        : device(d),
          scene(s),
          device_scene(ds),
          config(complete_config(c, s, settings)),
          bindings(d),
          commands(d, bindings),
          directories(d, s, ds),
          cache(make_cache(d, ds, settings, c)),
          sort(d),
          buffers(d, config, sort.histogram_words(config.pair_capacity)),
          kernels(d, ds, settings, config, directories.stack_size()) {
        device_scene.bind(bindings);
        directories.bind(bindings);
        cache.bind(bindings);
        buffers.bind(bindings);
        reserve_trees();
        const float pixel = float(2 * std::tan(s.camera.fov_degrees * std::numbers::pi / 360) / s.height);
        push.pixel_angle = settings.surface.pixel_error * pixel;
        push.is_ray_lod = settings.surface.lod == LodRule::ray;
        push.root = device_scene.root();
        push.visibility_mask = kVisibleToAll;
        push.patch_count = device_scene.patch_count();
        push.request_limit = kRequestCapacity;
    }

    CastStatistics cast(const Buffer& list, uint32_t count);
    CastStatistics cast_or_discard(const Buffer& list, uint32_t count);
    uint32_t trace_round(uint32_t active_count);
    void trace_chunk();
    void traverse_scene();
    bool build_directories();
    void sort_pairs();
    void trace_waves();
    void build_and_trace();
    void run_fused();
    void read_counters();
    void check_nothing_lost(uint32_t pairs_done, uint32_t jobs_done) const;
    void reserve_trees();

    uint32_t tree_count() const { return device_scene.patch_count() + directories.tile_count(); }
    void clear(size_t offset, size_t bytes) { commands.fill(buffers.counters, offset, bytes, 0); }

    const Device& device;
    const PreparedScene& scene;
    const DeviceScene& device_scene;
    TracerConfig config;
    BindingTable bindings;
    Commands commands;
    TileDirectories directories;
    PatchTreeCache cache;
    RadixSort sort;
    CastBuffers buffers;
    CastKernels kernels;
    CastPush push{};
    CounterData counters{};
    Totals totals;
    uint64_t cast_pairs = 0;    ///< of this cast
    bool has_collected = false; ///< in this cast
};

void Tracer::Implementation::reserve_trees() {
    buffers.reserve_trees(device, std::max(tree_count(), 1u), commands, bindings);
    push.builds_stride = buffers.job_capacity();
    push.directory_mask = directories.directory_mask();
}

void Tracer::Implementation::read_counters() {
    commands.copy(buffers.counters, 0, buffers.counters_on_host, 0, sizeof(CounterData));
    commands.run();
    std::memcpy(&counters, buffers.counters_on_host.mapped(), sizeof(counters));
}

CastStatistics Tracer::Implementation::cast(const Buffer& list, uint32_t count) {
    CastStatistics result;
    result.rays = count;
    if (count == 0) return result;
    const std::array<double, kStageCount> before = commands.stage_seconds();
    cast_pairs = 0;
    commands.begin_stage(Stage::top_traversal);
    commands.copy(list, 0, buffers.active, 0, uint64_t(count) * sizeof(uint32_t));
    push.round = 0;
    for (uint32_t active = count; active > 0; ++push.round) active = trace_round(active);
    if (push.is_any == 0) {
        commands.begin_stage(Stage::bottom_traversal);
        commands.copy(list, 0, buffers.active, 0, uint64_t(count) * sizeof(uint32_t));
        push.first = 0, push.count = count;
        commands.dispatch(kernels.finish_hits, count, push);
    }
    commands.run();
    const auto seconds = [&](Stage stage) {
        return commands.stage_seconds()[size_t(stage)] - before[size_t(stage)];
    };
    result.pairs = cast_pairs;
    result.top_traversal_s = seconds(Stage::top_traversal);
    result.sort_s = seconds(Stage::sort);
    result.bottom_build_s = seconds(Stage::bottom_build);
    result.bottom_traversal_s = seconds(Stage::bottom_traversal);
    return result;
}

/// After an error, discard recorded commands that would disturb the next cast.
CastStatistics Tracer::Implementation::cast_or_discard(const Buffer& list, uint32_t count) {
    try {
        return cast(list, count);
    } catch (...) {
        commands.discard();
        throw;
    }
}

/// One round of all active rays; returns the number of rays that stay active.
uint32_t Tracer::Implementation::trace_round(uint32_t active_count) {
    // Few rays need a second round, but some of those need many: they offer more candidates per round.
    push.slots = push.round == 0 ? config.slots : std::min(2 * config.slots, scalar::kMostSlots);
    if (push.round == 0) has_collected = false;
    const bool has_room = uint64_t(active_count) * config.collected <= config.pair_capacity;
    push.is_collecting = push.round > 0 && !has_collected && has_room && kernels.collecting_traversal;
    has_collected |= push.is_collecting != 0;
    if (push.is_collecting) push.slots = config.collected;
    const uint32_t chunk = std::max(1u, config.pair_capacity / push.slots);
    clear(offsetof(CounterData, next_active_count), sizeof(uint32_t));
    for (push.first = 0; push.first < active_count; push.first += chunk) {
        push.count = std::min(chunk, active_count - push.first);
        trace_chunk();
    }
    buffers.swap_active(bindings);
    return counters.next_active_count;
}

void Tracer::Implementation::trace_chunk() {
    push.is_repeated = 0;
    cache.begin_chunk(buffers.trees, commands, bindings);
    clear(offsetof(CounterData, pair_count), sizeof(uint32_t));
    clear(offsetof(CounterData, rays_lost), sizeof(uint32_t));
    do traverse_scene();
    while (directories.is_needed() && build_directories());
    sort_pairs();
    trace_waves();
    cast_pairs += counters.pair_count;
    totals.pairs += counters.pair_count;
}

void Tracer::Implementation::traverse_scene() {
    commands.begin_stage(Stage::top_traversal);
    clear(offsetof(CounterData, request_count), sizeof(uint32_t));
    if (directories.is_needed()) commands.fill(buffers.histogram, 0, scalar::kRequestBits / 8, 0);
    commands.dispatch(push.is_collecting ? *kernels.collecting_traversal : kernels.scene_traversal,
                      push.count, push);
}

/// Builds the tiles requested by rays; true: the traversal must be repeated.
bool Tracer::Implementation::build_directories() {
    read_counters();
    if (counters.request_count == 0) return false;
    const uint32_t asked = std::min(counters.request_count, kRequestCapacity);
    directories.build(buffers.requests.download<scalar::RequestData>(asked), commands, bindings);
    reserve_trees();
    push.is_repeated = 1;
    return true;
}

void Tracer::Implementation::sort_pairs() {
    commands.begin_stage(Stage::sort);
    clear(offsetof(CounterData, job_count), sizeof(uint32_t));
    const uint64_t most_pairs = uint64_t(push.count) * push.slots;
    sort.record(commands, most_pairs, uint32_t(std::bit_width(tree_count())), kPairCountWord);
    commands.dispatch(kernels.prepare_arguments, 1, kernels.arguments_push);
    commands.dispatch_indirect(kernels.find_jobs, buffers.arguments, kArgumentBytes * scalar::kArgumentsPairs,
                               push);
}

/// Runs the jobs in waves, each as large as the pool allows, then commits the hits.
void Tracer::Implementation::trace_waves() {
    uint32_t pairs_done = 0, jobs_done = 0;
    do {
        build_and_trace();
        commands.begin_stage(Stage::bottom_traversal);
        commands.dispatch(kernels.commit_round, push.count, push);
        read_counters();
        for (uint32_t bin = 0; bin < scalar::kBuildBinCount && !kernels.is_fused; ++bin)
            if (!kernels.bottom_build[bin] && counters.build_count[bin] > 0)
                throw Error(
                    ErrorKind::failed,
                    {"trees of a level were requested that the scene has not", "",
                     "use experiment.bottom = fused, or device.engine = cpu, and tell the developers"});
        cache.end_wave(counters);
        pairs_done += counters.pairs_done, jobs_done += counters.jobs_done;
        totals.pairs_with_hit += counters.pairs_with_hit;
        totals.reused += counters.reused;
        for (size_t level = 0; level < totals.built.size(); ++level)
            totals.built[level] += counters.built[level];
    } while (counters.deferred_count > 0);
    check_nothing_lost(pairs_done, jobs_done);
}

void Tracer::Implementation::build_and_trace() {
    commands.begin_stage(Stage::bottom_build);
    clear(offsetof(CounterData, deferred_count), sizeof(uint32_t));
    const size_t wave_counts = offsetof(CounterData, next_job);
    clear(wave_counts, offsetof(CounterData, path_count) - wave_counts);
    cache.begin_wave(push, buffers.counters, commands);
    commands.dispatch(kernels.prepare_arguments, 1, kernels.arguments_push);
    commands.dispatch_indirect(kernels.bottom_cache, buffers.arguments,
                               kArgumentBytes * scalar::kArgumentsJobs, push);
    if (kernels.is_fused) return run_fused();
    commands.dispatch(kernels.prepare_arguments, 1, kernels.arguments_push);
    // Launches have a cost even if they have no work.
    for (uint32_t bin = 0; bin < scalar::kBuildBinCount; ++bin)
        if (kernels.bottom_build[bin])
            commands.dispatch_indirect(*kernels.bottom_build[bin], buffers.arguments,
                                       kArgumentBytes * (scalar::kArgumentsBuilds + bin), push);
    commands.begin_stage(Stage::bottom_traversal);
    commands.dispatch_indirect(kernels.patch_traversal, buffers.arguments,
                               kArgumentBytes * scalar::kArgumentsPairs, push);
}

/// Persistent groups process the job queue; devices that limit loops need several launches.
void Tracer::Implementation::run_fused() {
    commands.begin_stage(Stage::bottom_traversal);
    if (kernels.fused_jobs_per_group == std::numeric_limits<uint32_t>::max()) {
        commands.dispatch(kernels.bottom_fused,
                          uint64_t(kernels.fused_group_count) * kernels.bottom_fused.group_size(), push);
    } else {
        do {
            read_counters();
            const uint64_t groups = std::min(kernels.fused_group_count, counters.job_count);
            commands.dispatch(kernels.bottom_fused, groups * kernels.bottom_fused.group_size(), push);
            read_counters();
        } while (counters.next_job < counters.job_count);
    }
    if (kernels.has_leftover)
        commands.dispatch_indirect(kernels.leftover, buffers.arguments,
                                   kArgumentBytes * scalar::kArgumentsPairs, push);
}

/// Checks that every ray, pair and job was completed, to detect devices that drop work.
void Tracer::Implementation::check_nothing_lost(uint32_t pairs_done, uint32_t jobs_done) const {
    if (pairs_done == counters.pair_count && jobs_done == counters.job_count && counters.rays_lost == 0)
        return;
    throw Error(
        ErrorKind::failed,
        {fmt::format("the device finished {} of {} pairs and {} of {} jobs, and left {} rays on their way",
                     pairs_done, counters.pair_count, jobs_done, counters.job_count, counters.rays_lost),
         device.description().name, "update its driver, or use device.engine = cpu"});
}

Tracer::Tracer(const Device& device, const PreparedScene& scene, const DeviceScene& device_scene,
               const RenderSettings& settings, const TracerConfig& config)
    : implementation_(std::make_unique<Implementation>(device, scene, device_scene, settings, config)) {}

Tracer::~Tracer() = default;

void Tracer::set_visibility_mask(uint32_t mask) { implementation_->push.visibility_mask = mask; }

CastStatistics Tracer::closest_hits(const Buffer& list, uint32_t count) {
    implementation_->push.is_any = 0;
    return implementation_->cast_or_discard(list, count);
}

CastStatistics Tracer::any_hits(const Buffer& list, uint32_t count) {
    implementation_->push.is_any = 1;
    CastStatistics result = implementation_->cast_or_discard(list, count);
    result.is_shadow = true;
    return result;
}

BindingTable& Tracer::bindings() { return implementation_->bindings; }
Commands& Tracer::commands() { return implementation_->commands; }
const Device& Tracer::device() const { return implementation_->device; }
const DeviceScene& Tracer::device_scene() const { return implementation_->device_scene; }
const PreparedScene& Tracer::scene() const { return implementation_->scene; }
const TracerConfig& Tracer::config() const { return implementation_->config; }
Buffer& Tracer::rays() { return implementation_->buffers.rays; }
const Buffer& Tracer::hits() const { return implementation_->buffers.hits; }
const Buffer& Tracer::counter_buffer() const { return implementation_->buffers.counters; }

const scalar::CounterData& Tracer::read_counters() {
    implementation_->read_counters();
    return implementation_->counters;
}

void Tracer::add_statistics(Statistics& statistics) const {
    const Implementation& self = *implementation_;
    const std::array<double, kStageCount>& seconds = self.commands.stage_seconds();
    statistics.top_traversal_s += seconds[size_t(Stage::top_traversal)];
    statistics.sort_s += seconds[size_t(Stage::sort)];
    statistics.bottom_build_s += seconds[size_t(Stage::bottom_build)];
    statistics.bottom_traversal_s += seconds[size_t(Stage::bottom_traversal)];
    statistics.shade_s += seconds[size_t(Stage::shade)];
    statistics.film_s += seconds[size_t(Stage::film)];
    statistics.pairs_emitted += self.totals.pairs;
    statistics.pairs_with_hit += self.totals.pairs_with_hit;
    statistics.bottom_reused += self.totals.reused;
    statistics.bottom_levels.resize(self.totals.built.size());
    for (size_t level = 0; level < self.totals.built.size(); ++level) {
        statistics.bottom_built += self.totals.built[level];
        statistics.bottom_levels[level] += self.totals.built[level];
    }
}

} // namespace relief::vulkan
