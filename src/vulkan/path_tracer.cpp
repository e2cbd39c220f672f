#include "vulkan/path_tracer.h"

#include <algorithm>
#include <cstddef>

#include "base/check.h"
#include "base/parallel.h"
#include "base/stop_request.h"
#include "base/timer.h"
#include "formulas/light_kinds.h"
#include "formulas/path.h"
#include "formulas/pixel_order.h"
#include "prepare/bounce_lod.h"
#include "prepare/camera_frame.h"
#include "vulkan/layout/bindings.h"
#include "vulkan/layout/device_paths.h"
#include "vulkan/layout/device_rays.h"
#include "vulkan/layout/device_scene.h"
#include "vulkan/work_statistics.h"

namespace relief::vulkan {

namespace {

static_assert(sizeof(scalar::CameraPush) <= scalar::kMaxPushBytes);
static_assert(sizeof(scalar::PathPush) <= scalar::kMaxPushBytes);
static_assert(sizeof(scalar::PathData) == 96 && sizeof(scalar::SurfacePointData) == 68);
static_assert(sizeof(scalar::SurfacePointData) == scalar::kSurfacePointWords * sizeof(uint32_t));
static_assert(sizeof(scalar::InputNumbers) == scalar::kInputWords * sizeof(uint32_t));
static_assert(kLightKinds.size() == scalar::kKindCount);
static_assert(offsetof(scalar::CounterData, shadow_count) ==
              offsetof(scalar::CounterData, path_count) + sizeof(uint32_t));

constexpr size_t kRangesAtOnce = 16;

/// Of one path, in all samples of a launch.
constexpr uint64_t kFirstHitBytes = PathTracer::kSamplesPerLaunch * sizeof(uint32_t);

/// One that reads maps or textures.
Kernel make_reading_kernel(const Tracer& tracer, const char* shader) {
    return Kernel(tracer.device(),
                  {.shader = shader, .constants = tracer.device_scene().add_filter({kGroupSize})});
}

/// Those of light_sums.glsl; none where the picture has no layers of light.
std::vector<uint32_t> add_light_layers(std::vector<uint32_t> constants, const LightLayers& layers,
                                       const LightGroups& groups) {
    if (layers.count() == 0) return constants;
    constants.resize(std::max<size_t>(constants.size(), scalar::kGuidesConstant + 1));
    constants[scalar::kLightKindsConstant] = uint32_t(layers.kind_count());
    constants[scalar::kLightGroupsConstant] = uint32_t(layers.groups.size());
    constants[scalar::kGuidesConstant] = layers.has_guides ? 1 : 0;
    constants[scalar::kDefaultGroupConstant] = groups.of_default;
    constants[scalar::kEnvironmentGroupConstant] = groups.of_environment;
    return constants;
}

template <class T>
Buffer make_buffer(const Device& device, const char* name, uint64_t count, uint64_t least_bytes = 0) {
    return Buffer(device, {.name = name,
                           .bytes = std::max<uint64_t>(count * sizeof(T), least_bytes),
                           .purpose = Purpose::ray_buffers});
}

/// Returns the size of the buffer of points. It holds the points, then the numbers of vertices, then
/// tangents, as paths.glsl reads them.
uint64_t find_point_bytes(const PreparedScene& scene, uint64_t capacity) {
    constexpr uint64_t point = sizeof(scalar::SurfacePointData), numbers = sizeof(scalar::InputNumbers);
    uint64_t bytes = capacity * point;
    if (scene.textured.has_vertex_numbers) bytes = (bytes / numbers + 1 + capacity) * numbers;
    return bytes + (scene.has_anisotropy ? capacity * sizeof(Vec3f) : 0);
}

/// Those of the ranges, one after the other.
std::vector<uint32_t> list_pixels(std::span<const PixelRange> ranges) {
    std::vector<uint64_t> begins = {0};
    for (const PixelRange& range : ranges) begins.push_back(begins.back() + range.count);
    std::vector<uint32_t> pixels(begins.back());
    parallel_for("list_pixels", ranges.size(), kRangesAtOnce, [&](size_t begin, size_t end) {
        for (size_t r = begin; r < end; ++r) {
            const Window& window = ranges[r].window;
            for (uint64_t k = 0; k < ranges[r].count; ++k) {
                const scalar::PixelPlace place =
                    scalar::place_pixel(uint32_t(ranges[r].first + k), uint32_t(window.x1 - window.x0),
                                        uint32_t(window.y1 - window.y0));
                pixels[begins[r] + k] =
                    scalar::pack_pixel(uint32_t(window.x0) + place.x, uint32_t(window.y0) + place.y);
            }
        }
    });
    return pixels;
}

} // namespace

PathTracer::PathTracer(Tracer& tracer, const RenderSettings& settings)
    : tracer_(tracer),
      settings_(settings),
      camera_(make_camera_frame(tracer.scene())),
      capacity_(uint32_t(tracer.rays().byte_count() / sizeof(scalar::RayData) / 2)),
      light_layers_(find_light_layers(settings.image.layers)),
      notes_first_hits_(needs_mattes(settings.image.layers)),
      lights_(tracer.device(), tracer.scene(), tracer.device_scene()),
      film_reader_(tracer.device()) {
    DCHECK(capacity_ > 0);
    const Device& device = tracer.device();
    camera_kernel_ = make_kernel(device, "camera");
    background_ = make_scattering_kernel("background");
    surface_point_ = make_reading_kernel(tracer, "surface_point");
    shading_normal_ = Kernel(device, {.shader = "shading_normal",
                                      .constants = tracer.device_scene().add_normal_maps({kGroupSize})});
    meet_surface_ = make_scattering_kernel("meet_surface");
    light_sample_ = make_scattering_kernel(
        tracer.scene().terminators == Terminators::none ? "light_sample" : "light_sample_terminators");
    bounce_ = make_scattering_kernel("bounce");
    far_rays_ = make_kernel(device, "far_rays");
    inner_hits_ = make_reading_kernel(tracer, "inner_hits");
    shadow_light_ = make_lighting_kernel("shadow_light");
    film_ = make_kernel(device, "film");
    if (tracer.scene().terminators != Terminators::none) {
        lifted_rays_.emplace(make_kernel(device, "lifted_rays"));
        lift_rays_.emplace(make_kernel(device, "lift_rays"));
    }
    if (tracer.scene().has_cut_outs) {
        cut_outs_.emplace(make_scattering_kernel("cut_outs"));
        saved_list_ = make_buffer<uint32_t>(device, "saved_list", capacity_);
    }
    make_buffers();
    if (settings.experiment.method == RenderMethod::hybrid)
        rasteriser_ =
            std::make_unique<Rasteriser>(tracer, RasterBuffers{.vertices = &points_, .items = &shadow_list_});
}

Kernel PathTracer::make_lighting_kernel(const char* shader) const {
    return Kernel(tracer_.device(), {.shader = shader,
                                     .constants = add_light_layers(
                                         lights_.add_choice(tracer_.device_scene().add_filter({kGroupSize})),
                                         light_layers_, tracer_.scene().light_groups)});
}

Kernel PathTracer::make_scattering_kernel(const char* shader) const {
    return Kernel(tracer_.device(), {.shader = shader,
                                     .constants = add_light_layers(
                                         lights_.add_choice(tracer_.device_scene().add_layers({kGroupSize})),
                                         light_layers_, tracer_.scene().light_groups)});
}

void PathTracer::make_buffers() {
    const Device& device = tracer_.device();
    // Rasterised first hits reuse buffers that only shading needs.
    const bool is_lent = settings_.experiment.method == RenderMethod::hybrid;
    paths_ = make_buffer<scalar::PathData>(device, "paths", capacity_);
    const uint64_t least_point_bytes = std::max<uint64_t>(is_lent ? RasterBuffers::kLeastVertexBytes : 0,
                                                          find_point_bytes(tracer_.scene(), capacity_));
    points_ = make_buffer<scalar::SurfacePointData>(device, "surface_points", capacity_, least_point_bytes);
    film_sums_ = make_buffer<std::byte>(
        device, "film_sums", find_first_hits(0) + (notes_first_hits_ ? kFirstHitBytes : 0) * capacity_);
    if (device.is_cpu())
        whole_sums_ = make_buffer<std::byte>(
            device, "whole_film_sums", find_light_sums() + capacity_ * light_layers_.count() * sizeof(Vec3f));
    path_list_ = make_buffer<uint32_t>(device, "path_list", capacity_);
    next_path_list_ = make_buffer<uint32_t>(device, "next_path_list", capacity_,
                                            is_lent ? capacity_ * RasterBuffers::kNearestBytes : 0);
    shadow_list_ =
        make_buffer<uint32_t>(device, "shadow_list", capacity_, is_lent ? RasterBuffers::kLeastItemBytes : 0);
    pixel_list_ = make_buffer<uint32_t>(device, "pixel_list", capacity_);
    BindingTable& bindings = tracer_.bindings();
    lights_.bind(bindings);
    bindings.bind(scalar::kBindPaths, paths_);
    bindings.bind(scalar::kBindPoints, points_);
    bindings.bind(scalar::kBindFilm, film_sums_);
    bindings.bind(scalar::kBindPathList, path_list_);
    bindings.bind(scalar::kBindNextPathList, next_path_list_);
    bindings.bind(scalar::kBindShadowList, shadow_list_);
}

void PathTracer::trace_samples(Film& film, std::span<const PixelRange> pixels, SampleRange samples,
                               const std::function<void(uint64_t)>& on_samples) {
    DCHECK(!pixels.empty() && (!rasteriser_ || pixels.size() == 1));
    std::vector<uint32_t> listed = list_pixels(pixels);
    DCHECK(listed.size() <= capacity_);
    drawn_ = pixels.front();
    if (listed != pixels_) {
        pixel_list_.upload(listed);
        pixels_ = std::move(listed);
    }
    for (int k = 0; k < samples.count; k += kSamplesPerLaunch)
        trace_batch(film, {samples.first + k, std::min(kSamplesPerLaunch, samples.count - k)}, on_samples);
}

void PathTracer::trace_batch(Film& film, SampleRange samples,
                             const std::function<void(uint64_t)>& on_samples) {
    Commands& commands = tracer_.commands();
    const uint64_t sum_bytes = pixels_.size() * sizeof(scalar::FilmSumsData);
    const uint64_t light_bytes = pixels_.size() * light_layers_.count() * sizeof(Vec3f);
    batch_casts_.clear();
    BatchSums sums{&film_sums_};
    int done = 0;
    try {
        clear_sums(samples.count);
        for (; done < samples.count; ++done) {
            trace_sample(uint32_t(samples.first + done), done);
            // A sample takes a CPU device seconds, and begins to add to the sums before it is whole.
            if (whole_sums_) commands.copy(film_sums_, 0, whole_sums_, 0, sum_bytes);
            if (whole_sums_ && light_bytes > 0)
                commands.copy(film_sums_, find_light_sums(), whole_sums_, find_light_sums(), light_bytes);
            const bool is_last = done + 1 == samples.count;
            if (is_last && !whole_sums_)
                sums = film_reader_.pack(commands, film, film_sums_, points_, uint32_t(pixels_.size()));
            if (whole_sums_ || is_last) commands.run();
            if (whole_sums_) on_samples(pixels_.size());
        }
    } catch (const StopRequest&) {
        if (whole_sums_ && done > 0) add_to_film(film, whole_sums_, {&whole_sums_}, done);
        throw;
    } catch (...) {
        batch_casts_.clear(); // the batch is traced again, and its rays must count once
        throw;
    }
    add_to_film(film, film_sums_, sums, samples.count);
    if (!whole_sums_) on_samples(pixels_.size() * uint64_t(samples.count));
}

scalar::PathPush PathTracer::make_push(uint32_t sample_index) const {
    scalar::PathPush push{};
    lights_.describe(push);
    push.has_background = settings_.image.background ? 1 : 0;
    push.background = settings_.image.background.value_or(Vec3f{});
    push.capacity = capacity_;
    push.last_depth = scalar::find_last_depth(uint32_t(settings_.image.bounces));
    push.clamp_indirect = settings_.image.clamp_indirect;
    push.sample_index = sample_index;
    push.bounce_lod = make_bounce_lod(tracer_.scene(), settings_);
    return push;
}

/// Byte of the film's buffer, as light_sums.glsl has it.
uint64_t PathTracer::find_light_sums() const { return capacity_ * sizeof(scalar::FilmSumsData); }

/// Byte of the film's buffer; those of all paths of a sample lie together.
uint64_t PathTracer::find_first_hits(int place) const {
    const uint64_t path_bytes = light_layers_.count() > 0 ? light_layers_.count() * sizeof(Vec3f) +
                                                                scalar::kPathLightWords * sizeof(uint32_t)
                                                          : 0;
    return find_light_sums() + capacity_ * path_bytes + uint64_t(place) * pixels_.size() * sizeof(uint32_t);
}

/// Of the pixels of a batch.
void PathTracer::clear_sums(int sample_count) {
    Commands& commands = tracer_.commands();
    commands.begin_stage(Stage::film);
    commands.fill(film_sums_, 0, pixels_.size() * sizeof(scalar::FilmSumsData), 0);
    if (light_layers_.count() > 0)
        commands.fill(film_sums_, find_light_sums(), pixels_.size() * light_layers_.count() * sizeof(Vec3f),
                      0);
    if (notes_first_hits_)
        commands.fill(film_sums_, find_first_hits(0), find_first_hits(sample_count) - find_first_hits(0), 0);
}

void PathTracer::trace_sample(uint32_t sample_index, int place) {
    Commands& commands = tracer_.commands();
    const uint32_t pixel_count = uint32_t(pixels_.size());
    const Window& window = drawn_.window;
    const scalar::CameraPush camera{camera_,
                                    uint32_t(window.x0),
                                    uint32_t(window.y0),
                                    uint32_t(window.x1 - window.x0),
                                    uint32_t(window.y1 - window.y0),
                                    uint32_t(drawn_.first),
                                    pixel_count,
                                    sample_index,
                                    settings_.image.seed};
    commands.begin_stage(Stage::shade);
    commands.copy(pixel_list_, 0, shadow_list_, 0, uint64_t(pixel_count) * sizeof(uint32_t));
    commands.dispatch(camera_kernel_, pixel_count, camera);
    scalar::PathPush push = make_push(sample_index);
    push.count = pixel_count;
    if (notes_first_hits_) push.first_hit_offset = uint32_t(find_first_hits(place) / sizeof(uint32_t));
    for (; push.count > 0; ++push.depth) {
        CastStatistics cast = push.depth > 0 ? trace_bounces(push)
                              : rasteriser_  ? rasteriser_->first_hits(camera)
                                             : tracer_.closest_hits(path_list_, push.count);
        if (cut_outs_) pass_cut_outs(push, false, cast);
        cast.depth = int(push.depth);
        add_cast(batch_casts_, cast);
        const NextRays next = shade_depth(push);
        trace_shadow_rays(push, next.shadow_count);
        push.count = next.path_count;
        if (push.count > 0)
            commands.copy(next_path_list_, 0, path_list_, 0, uint64_t(push.count) * sizeof(uint32_t));
    }
    commands.begin_stage(Stage::film);
    push.count = pixel_count;
    commands.dispatch(film_, pixel_count, push);
}

/// Both parts of bounce rays, as cpu/bounce_rays.h; shadow and next-depth lists are free until shade_depth.
CastStatistics PathTracer::trace_bounces(scalar::PathPush push) {
    CastStatistics cast = tracer_.closest_hits(path_list_, push.count);
    if (push.bounce_lod.cell_angle == 0) return cast;
    const auto trace_further = [&](const Buffer& list, uint32_t count) {
        add_cast_work(cast, tracer_.closest_hits(list, count));
    };
    push.count = list_rays(far_rays_, push).shadow_count;
    if (push.count == 0) return cast;
    trace_further(shadow_list_, push.count);
    push.count = list_rays(inner_hits_, push).path_count;
    if (push.count > 0) trace_further(next_path_list_, push.count);
    return cast;
}

/// Rays go on until they meet what they do not pass. Only the list that they come from is kept.
void PathTracer::pass_cut_outs(scalar::PathPush push, bool is_shadow, CastStatistics& cast) {
    Commands& commands = tracer_.commands();
    const Buffer& list = is_shadow ? shadow_list_ : path_list_;
    const Buffer& passed = is_shadow ? path_list_ : next_path_list_;
    const uint64_t bytes = uint64_t(push.count) * sizeof(uint32_t);
    scalar::CutOutPush cut_out{.count = push.count,
                               .capacity = capacity_,
                               .depth = push.depth,
                               .is_shadow = is_shadow ? 1u : 0u,
                               .sample_index = push.sample_index,
                               .round = 0,
                               .source_count = push.source_count,
                               .first_light_node = push.first_light_node,
                               .clamp_indirect = push.clamp_indirect};
    commands.begin_stage(Stage::shade);
    commands.copy(list, 0, saved_list_, 0, bytes);
    for (;; ++cut_out.round) {
        commands.begin_stage(Stage::shade);
        clear_lists();
        commands.dispatch(*cut_outs_, cut_out.count, cut_out);
        push.count = cut_out.count = read_lists().path_count;
        if (push.count == 0) break;
        commands.copy(passed, 0, list, 0, uint64_t(push.count) * sizeof(uint32_t));
        const bool is_bounce = !is_shadow && push.depth > 0;
        add_cast_work(cast, is_bounce ? trace_bounces(push) : tracer_.closest_hits(list, push.count));
    }
    commands.begin_stage(Stage::shade);
    commands.copy(saved_list_, 0, list, 0, bytes);
}

/// Runs a kernel that appends rays to lists.
PathTracer::NextRays PathTracer::list_rays(const Kernel& kernel, const scalar::PathPush& push) {
    Commands& commands = tracer_.commands();
    commands.begin_stage(Stage::shade);
    clear_lists();
    commands.dispatch(kernel, push.count, push);
    return read_lists();
}

void PathTracer::clear_lists() {
    tracer_.commands().fill(tracer_.counter_buffer(), offsetof(scalar::CounterData, path_count),
                            2 * sizeof(uint32_t), 0);
}

PathTracer::NextRays PathTracer::read_lists() {
    const scalar::CounterData& counters = tracer_.read_counters();
    return {counters.path_count, counters.shadow_count};
}

/// Emission seen by rays, surface points, light and BSDF sampling.
PathTracer::NextRays PathTracer::shade_depth(const scalar::PathPush& push) {
    Commands& commands = tracer_.commands();
    commands.begin_stage(Stage::shade);
    clear_lists();
    commands.dispatch(background_, push.count, push);
    const bool is_last = push.depth > uint32_t(settings_.image.bounces);
    if (is_last && push.emitter_count == 0) return {0, 0};
    commands.dispatch(surface_point_, push.count, push);
    commands.dispatch(shading_normal_, push.count, push);
    commands.dispatch(meet_surface_, push.count, push);
    // The last rays look for light alone.
    const bool draws_light = (push.depth == 0 || push.depth != push.last_depth) &&
                             (push.source_count > 0 || push.first_light_node != 0);
    if (draws_light) commands.dispatch(light_sample_, push.count, push);
    if (push.depth < push.last_depth) commands.dispatch(bounce_, push.count, push);
    return read_lists();
}

/// Shadow rays that start above their triangles bring nothing where something is in the way up there. The
/// path list is free until the next depth.
CastStatistics PathTracer::lift_shadow_rays(scalar::PathPush push, uint32_t shadow_count) {
    if (!lifted_rays_) return {};
    push.count = shadow_count;
    push.count = list_rays(*lifted_rays_, push).path_count;
    if (push.count == 0) return {};
    const CastStatistics cast = tracer_.any_hits(path_list_, push.count);
    Commands& commands = tracer_.commands();
    commands.begin_stage(Stage::shade);
    commands.dispatch(*lift_rays_, push.count, push);
    return cast;
}

void PathTracer::trace_shadow_rays(scalar::PathPush push, uint32_t shadow_count) {
    if (shadow_count == 0) return;
    const CastStatistics lifted = lift_shadow_rays(push, shadow_count);
    CastStatistics cast;
    if (cut_outs_) {
        cast = tracer_.closest_hits(shadow_list_, shadow_count);
        push.count = shadow_count;
        pass_cut_outs(push, true, cast);
        cast.is_shadow = true;
    } else {
        cast = tracer_.any_hits(shadow_list_, shadow_count);
    }
    add_cast_work(cast, lifted);
    cast.depth = int(push.depth);
    add_cast(batch_casts_, cast);
    Commands& commands = tracer_.commands();
    commands.begin_stage(Stage::shade);
    push.count = shadow_count;
    commands.dispatch(shadow_light_, shadow_count, push);
}

/// `light_sums`: the buffer behind whose sums those of light lie.
void PathTracer::add_to_film(Film& film, const Buffer& light_sums, const BatchSums& sums, int sample_count) {
    const Timer timer;
    DCHECK(notes_first_hits_ || !film.needs_hit_ids());
    const size_t light_count = light_layers_.count();
    DCHECK(light_count == film.light_layers().count());
    const std::vector<uint32_t> first_hits = download_first_hits(sample_count);
    const std::vector<Vec3f> lights =
        light_count == 0 ? std::vector<Vec3f>()
                         : light_sums.download<Vec3f>(pixels_.size() * light_count, find_light_sums());
    FilmReader::add(film, sums, {pixels_, sample_count, first_hits, lights});
    film_s_ += timer.seconds();
    for (const CastStatistics& cast : batch_casts_) add_cast(casts_, cast);
    batch_casts_.clear();
}

/// Sample by sample, a word a pixel; nothing where they are not noted.
std::vector<uint32_t> PathTracer::download_first_hits(int sample_count) const {
    if (!notes_first_hits_) return {};
    return film_sums_.download<uint32_t>(pixels_.size() * size_t(sample_count), find_first_hits(0));
}

void PathTracer::add_statistics(Statistics& statistics) const {
    Statistics work;
    work.film_s = film_s_;
    work.casts = casts_;
    for (const CastStatistics& cast : batch_casts_) add_cast(work.casts, cast);
    for (const CastStatistics& cast : work.casts) {
        if (cast.is_shadow)
            work.shadow_rays += cast.rays;
        else
            (cast.depth == 0 ? work.camera_rays : work.bounce_rays) += cast.rays;
    }
    add_work(statistics, work);
}

} // namespace relief::vulkan
