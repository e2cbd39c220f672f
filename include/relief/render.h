// Renders a scene to an image in one call, with progress and cancellation through an observer.
#pragma once

#include <cstdint>
#include <functional>
#include <iosfwd>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "relief/image.h"
#include "relief/scene.h"
#include "relief/traversal.h"

namespace relief {

enum class SurfaceMode { direct, tessellated };
enum class LeafKind { exact, box };
enum class LodRule { field, ray };
/// Levels that bounce rays see: `automatic`: those of the camera near the vertex that a ray leaves, and, with
/// automatic levels, coarser ones beyond; `camera`: those of the camera everywhere.
enum class BounceLevels { automatic, camera };
enum class EngineKind { cpu, vulkan };
/// How the Vulkan engine builds and traverses patch trees: `fused` is one kernel of persistent work groups
/// that take jobs from a queue (Harada 2015); `split` is a build kernel, then one invocation per pair of
/// patch and ray.
enum class BottomForm { automatic, fused, split };
/// How a device finds hits (GRAPP 2019, section 3.3): compute kernels; full-screen fragment shaders; or
/// rasterised first hits, then compute kernels.
enum class RenderMethod { compute, fragment, hybrid };
enum class Isa { best, avx512, avx2, sse4, neon, scalar };

inline constexpr int kAutoLevel = -1;
inline constexpr int kMaxLevel = 12;

struct Window {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0; ///< half open, pixels; all zero: the whole picture
    friend bool operator==(const Window&, const Window&) = default;
};

inline constexpr size_t kDefaultCacheBytes = size_t(176) << 20;

/// Representation and resolution of displaced surfaces.
struct SurfaceSettings {
    SurfaceMode mode = SurfaceMode::direct;
    int level = kAutoLevel; ///< kAutoLevel, or fixed: 2^level cells per patch side, [0, kMaxLevel]
    float pixel_error = 1;  ///< automatic levels: target cell size, pixels, (0, 1e6]
    LodRule lod = LodRule::field;
    BounceLevels bounce_levels = BounceLevels::automatic;
    LeafKind leaf = LeafKind::exact;
    /// Limit of the patch tree cache; 0 disables it. Not given: kDefaultCacheBytes, and while trees have to
    /// be built again for want of room up to half of the memory that is available. On a GPU: from 512 MiB to
    /// 1 GiB, and then up to a quarter of what it has free.
    std::optional<size_t> cache_bytes;
};

/// Engine, device and threads.
struct DeviceSettings {
    EngineKind engine = EngineKind::cpu;
    int index = -1;             ///< Vulkan: index of vulkan_devices() (relief/devices.h); -1: the best one
    std::string pipeline_cache; ///< Vulkan: file that caches compiled kernels between runs; empty: none
    int threads = 0;            ///< [0, kMaxThreads]; 0: all cores
    Isa isa = Isa::best;        ///< of the CPU engine
};

/// Size and sampling of the image.
struct ImageSettings {
    int width = 1280, height = 720; ///< pixels, [1, kMaxPictureSize] each
    int spp = 64;                   ///< samples per pixel, at most, [1, kMaxSamples]
    /// Above 0, at most 1: pixels get no more samples once their error is below this share of their
    /// brightness; 95 of 100 are then within 1.25 times that of their mean. In blocks of 8 x 8, after 16
    /// samples each.
    float noise = 0;
    static constexpr int kLeastNoiseSamples = 16; ///< of a pixel, before noise is judged
    /// Above 0: the render ends after so many seconds, preparation included, but not before each pixel has a
    /// sample. Passes become smaller towards the limit, down to one sample a pixel, and one that would not
    /// end in time is not begun.
    double time_limit_s = 0;
    double time_reserved_s = 0; ///< of time_limit_s, for what the caller does before and after the render
    int bounces = 4;            ///< path length, [0, kMaxBounces]; 0: primary ray and direct light only
    /// Above 0: light that a path finds after its first bounce, by a ray towards a light or by chance, is
    /// scaled down to this mean of its components at most. This removes bright specks, and some light. 0
    /// keeps all light. Rule and default are those of Cycles.
    float clamp_indirect = 10;
    /// Rows of the picture that levels of detail are chosen for; 0: `height`. A coarse preview that gets the
    /// height of the picture after it has the same geometry, which is then prepared once.
    int detail_height = 0;
    uint32_t seed = 0;
    /// Linear colour that camera rays see where they leave the scene and meet no visible light; nullopt: the
    /// environment. Black makes films transparent: colours are then premultiplied by A. Bounces see the
    /// environment in any case.
    std::optional<Vec3f> background;
    Window crop;          ///< part of the picture to render
    int first_sample = 0; ///< samples [first_sample, first_sample + spp) of each pixel, [0, 2^30]
    /// Of a render that is a part of a picture: its window, and its samples a pixel. Kept in the header, so
    /// that find_gaps knows what is missing; empty and 0: not known.
    Window whole_window;
    int whole_samples = 0;
    /// Any of depth N N_camera Ng P albedo uv id samples variance cost; motion, of what is seen in the middle
    /// of a pixel at the time of the picture: pixels to the right and down from where it is when the shutter
    /// opens to where it is when it closes (Session::render_moving(), else 0); shadow, which pictures with a
    /// shadow catcher always have, as their alpha is made of it; guide_albedo guide_N, of what is seen in
    /// mirrors and clear glass (relief/denoise.h); diffuse_direct diffuse_indirect specular_direct
    /// specular_indirect transmission_direct transmission_indirect emission background, whose sum is the
    /// colour; direct, of these all that are not indirect; light_NAME, the part of it that a group of lights
    /// gives; CryptoObject CryptoMaterial, which are of Cryptomatte 1.2: six ranks of id and coverage a
    /// pixel, their names in the picture's metadata.
    std::vector<std::string> layers;
};

/// Alternative structures, traversals and methods, for comparison. All find the same hits.
struct ExperimentSettings {
    StructureKind structure = StructureKind::bvh;
    TraversalKind traversal = TraversalKind::automatic; ///< one of available_traversals()
    /// SAH costs of kd-trees, and of BVHs for a traversal other than the engine's default: such a BVH is
    /// built by a full sweep, with up to 8 polygons per leaf. nullopt: the defaults of each structure.
    std::optional<SahCosts> sah_costs;
    RenderMethod method = RenderMethod::compute; ///< of the Vulkan engine; all are bit-identical
    BottomForm bottom = BottomForm::automatic;   ///< of the Vulkan engine
};

struct RenderSettings {
    SurfaceSettings surface;
    DeviceSettings device;
    ImageSettings image;
    ExperimentSettings experiment;
};

/// Rays of one kind at one path depth and their cost, in seconds of wall-clock time (Vulkan) or summed over
/// threads (CPU). top_traversal_s includes creating the hit records, and for camera rays their generation.
struct CastStatistics {
    int depth = 0;          ///< 0: camera rays and their shadow rays
    bool is_shadow = false; ///< rays towards lights
    uint64_t rays = 0, pairs = 0;
    double top_traversal_s = 0, sort_s = 0, bottom_build_s = 0, bottom_traversal_s = 0;
};

/// Statistics of one render; names follow the keys of `--stats`. Sizes in bytes, times in seconds.
struct Statistics {
    std::string engine, device, isa;
    int threads = 0;
    uint64_t meshes = 0, instances = 0, patches = 0, triangles = 0, displacement_texels = 0;
    double load_s = 0, prepare_s = 0, first_image_s = 0, render_s = 0, denoise_s = 0, write_s = 0,
           total_s = 0;
    double top_traversal_s = 0, sort_s = 0, bottom_build_s = 0, bottom_traversal_s = 0, shade_s = 0,
           film_s = 0;
    uint64_t camera_rays = 0, shadow_rays = 0, bounce_rays = 0;
    uint64_t pairs_emitted = 0, pairs_with_hit = 0;
    /// Of the CPU engine's default traversal of displaced surfaces: nodes of scene trees and of patch trees,
    /// each counted once for all rays that visit it together, and blocks of triangles, counted per ray.
    /// Independent of the number of threads and of the cache.
    uint64_t upper_nodes = 0, patch_nodes = 0, blocks = 0;
    uint64_t bottom_built = 0, bottom_reused = 0;
    uint64_t bottom_rebuilt = 0; ///< of bottom_built, those that the CPU engine's cache had no room to keep
    std::vector<uint64_t> bottom_levels; ///< trees built at level 0, 1, 2, ...
    uint64_t geometry_bytes = 0, structures_bytes = 0, displacement_bytes = 0, bottom_cache_bytes = 0;
    uint64_t ray_buffers_bytes = 0, peak_resident_bytes = 0;
    std::vector<CastStatistics> casts; ///< by depth, camera and bounce rays before shadow rays
    std::vector<std::string> warnings;
};

struct Progress {
    double fraction = 0;  ///< [0, 1] of all samples
    int samples_done = 0; ///< completed passes over the picture
    int samples_total = 0;
    uint64_t rays = 0;    ///< rays traced so far
    double elapsed_s = 0; ///< since the render started
};

/// Receives progress and pictures so far, and requests cancellation. on_progress is called from one thread at
/// a time, a few times a second; is_cancelled from any thread, often, also at once; the others from the
/// thread that renders.
class RenderObserver {
  public:
    virtual ~RenderObserver() = default;
    virtual void on_progress(const Progress& progress) = 0;
    /// Returning true cancels the render: the image so far is returned, and is whole where
    /// RenderResult::whole_samples is above 0.
    virtual bool is_cancelled() const = 0;
    /// Called a few times a second, from one thread at a time, while the scene is prepared: the part of the
    /// faces of its meshes that is, in [0, 1].
    virtual void on_preparation(double fraction) { (void)fraction; }
    /// Called once, before the first ray, with all warnings (Statistics::warnings) known by then.
    virtual void on_warnings(const std::vector<std::string>& warnings) { (void)warnings; }
    /// Seconds between two calls of on_picture; infinity: it is never called. Asked once, before the first
    /// ray.
    virtual double picture_interval_s() const { return std::numeric_limits<double>::infinity(); }
    /// The picture so far, as RenderResult::image has it, without metadata: called as soon as every pixel has
    /// a sample, then every picture_interval_s() or a little later, while no sample is traced. All pixels
    /// have the same number of samples then, except those that low noise spares, and unless one pass over
    /// the picture takes more than two seconds. The CPU engine makes passes of a second or the interval,
    /// whichever is longer, as far as that is possible without making them slow.
    virtual void on_picture(Image picture) { (void)picture; }
};

/// The sums that Checkpoints::save of another render wrote: of a tile of the picture, of a range of its
/// samples, or of both.
struct FilmPart {
    std::string name;                                    ///< for messages: its file
    std::function<std::unique_ptr<std::istream>()> open; ///< a binary stream; null where it cannot be read
    Window window;                                       ///< ImageSettings::crop of that render
    int first_sample = 0;                                ///< ImageSettings::first_sample of that render
};

/// Keeps the sums of all samples, so that a render can go on from them.
struct Checkpoints {
    double interval_s = std::numeric_limits<double>::infinity(); ///< between two calls of `save`
    /// Called while no sample is traced, every interval_s seconds, up to the time that a tile takes, and at
    /// the end; `write` writes bytes that `resume` takes. May be empty.
    std::function<void(const std::function<void(std::ostream&)>& write)> save;
    /// What a render of the same picture wrote: its samples are not traced again, and the result is that of
    /// one render of all samples, bit for bit; on the Vulkan engine where each ended after 1, 4 or a
    /// multiple of 16 samples. Null: none. Throws Error{bad_input} for a stream that is damaged or of another
    /// picture or version; scenes with hash 0 (in memory) are told apart by nothing but these settings.
    std::istream* resume = nullptr;
    std::string resume_name; ///< place of errors in `resume`, such as a file
    /// What renders of parts of the same picture wrote, in any order: their samples are not traced again. Of
    /// one part, each pixel keeps its bits. Ranges of samples are added in double precision, which gives the
    /// bits of one render of all samples unless an addition had to round. Each pixel must have all samples
    /// before those of a part. Throws Error{bad_input}, whose place is FilmPart::name, for a part that is
    /// damaged, of another picture, or lacks samples before it, and with image.noise for samples after
    /// others.
    std::vector<FilmPart> parts;
};

/// Of a render with ImageSettings::noise: where it was reached. Noise is estimated in blocks of 8 x 8 pixels.
struct NoiseReport {
    double asked = 0;
    uint64_t pixels = 0, reached_pixels = 0;
    /// Of the pixels that have more noise than was asked for: what half of them are below, and the most;
    /// infinity where pixels have one sample, 0 where there are no such pixels.
    double median = 0, most = 0;
};

struct RenderResult {
    Image image; ///< R G B A and the requested layers; linear, data window = crop
    Statistics statistics;
    bool is_complete = true;     ///< false if cancelled; "samples.Y" then holds the number of samples of each
                                 ///< pixel, as it does where a time limit or low noise ended the render
    bool is_out_of_time = false; ///< the time limit ended the render before all samples were there
    std::optional<NoiseReport> noise; ///< with ImageSettings::noise, if every pixel has a sample
    /// Samples that every pixel has; 0 if cancelled before the first pass over the picture was whole: pixels
    /// without samples are then 0, and the image is not to be shown.
    int whole_samples = 0;
};

/// Renders `scene`, whose polygons are freed once patches have been built from them. `observer` may be null.
/// Throws Error (usage for settings out of range, bad_input, device_missing, out_of_memory). Thread safe.
RenderResult render(Scene scene, const RenderSettings& settings, RenderObserver* observer = nullptr,
                    const Checkpoints& checkpoints = {});

/// Header entry "relief:settings" of pictures: what the mean of a pixel depends on beside the scene, alike on
/// all engines and structures.
std::string describe_settings(const RenderSettings& settings);

/// Traversals of a structure that an engine supports, the default first; both support the same.
std::vector<TraversalKind> available_traversals(EngineKind engine, StructureKind structure);

/// Names of the instruction sets that this machine supports, best first; always includes "scalar".
std::vector<std::string> available_isas();

} // namespace relief
