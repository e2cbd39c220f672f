// From a scene to a finished picture. One call; progress and cancellation through an observer.
#pragma once

#include <cstdint>
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
enum class EngineKind { cpu, vulkan };
/// How the Vulkan engine builds and walks patch trees: one kernel that keeps groups resident and takes jobs
/// from a queue (Harada 2015), or a build kernel and then one invocation per pair of patch and ray.
enum class BottomForm { automatic, fused, split };
/// What of a device finds hits (GRAPP 2019, section 3.3): compute kernels; fragment shaders over the
/// full screen; or compute kernels after the first hits have been found by drawing the surfaces.
enum class RenderMethod { compute, fragment, hybrid };
enum class Isa { best, avx512, avx2, sse4, neon, scalar };

inline constexpr int kAutoLevel = -1;
inline constexpr int kMaxLevel = 12;

struct Window {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0; ///< half open, pixels; all zero: the whole picture
    friend bool operator==(const Window&, const Window&) = default;
};

/// How displaced surfaces are represented, and how finely.
struct SurfaceSettings {
    SurfaceMode mode = SurfaceMode::direct;
    int level = kAutoLevel; ///< kAutoLevel, or fixed 2^level cells a side, [0, kMaxLevel]
    float pixel_error = 1;  ///< auto level: cell size aimed at, pixels, (0, 1e6]
    LodRule lod = LodRule::field;
    LeafKind leaf = LeafKind::exact;
    size_t cache_bytes = size_t(176) << 20; ///< cap of the patch tree cache; 0 turns it off
};

/// What computes, and with how much of the machine.
struct DeviceSettings {
    EngineKind engine = EngineKind::cpu;
    int index = -1;             ///< Vulkan: index of vulkan_devices() (relief/devices.h); -1: the best one
    std::string pipeline_cache; ///< Vulkan: file that keeps compiled kernels between runs; empty: none
    int threads = 0;            ///< [0, kMaxThreads]; 0: all cores
    Isa isa = Isa::best;        ///< of the CPU engine
};

/// The picture, and how its pixels are sampled.
struct ImageSettings {
    int width = 1280, height = 720; ///< pixels, [1, kMaxPictureSize] each
    int spp = 64;                   ///< samples a pixel, [1, kMaxSamples]
    int bounces = 4;                ///< path length, [0, kMaxBounces]; 0: primary ray and direct light only
    uint32_t seed = 0;
    Window crop;                     ///< part of the picture to render
    int first_sample = 0;            ///< samples [first_sample, first_sample + spp) of each pixel, [0, 2^30]
    std::vector<std::string> layers; ///< depth N Ng P albedo uv id samples variance cost
};

/// Other structures, traversals and methods than the engines' own, to compare with. All give the same hits.
struct ExperimentSettings {
    StructureKind structure = StructureKind::bvh;
    TraversalKind traversal = TraversalKind::automatic; ///< one of available_traversals()
    /// Of the trees of structure kdtree, or of bvh for a traversal other than the engine's default: a bvh is
    /// then built by a full sweep, and its leaves hold up to 8 polygons. None: what each structure has of
    /// itself.
    std::optional<SahCosts> sah_costs;
    RenderMethod method = RenderMethod::compute; ///< of the Vulkan engine; all give the same bits
    BottomForm bottom = BottomForm::automatic;   ///< of the Vulkan engine
};

struct RenderSettings {
    SurfaceSettings surface;
    DeviceSettings device;
    ImageSettings image;
    ExperimentSettings experiment;
};

/// Rays of one kind at one depth of their paths, and what casting them took, in seconds of the whole machine
/// (Vulkan) or summed over threads (CPU). The top of camera rays includes aiming them, that of all the making
/// of hits from what was met.
struct CastStatistics {
    int depth = 0;          ///< 0: camera rays and their shadow rays
    bool is_shadow = false; ///< towards lights
    uint64_t rays = 0, pairs = 0;
    double top_traversal_s = 0, sort_s = 0, bottom_build_s = 0, bottom_traversal_s = 0;
};

/// Numbers of one render; names follow the keys of `--stats`.
struct Statistics {
    std::string engine, device, isa;
    int threads = 0;
    uint64_t meshes = 0, instances = 0, patches = 0, triangles = 0, displacement_texels = 0;
    double load_s = 0, prepare_s = 0, first_image_s = 0, render_s = 0, write_s = 0, total_s = 0;
    double top_traversal_s = 0, sort_s = 0, bottom_build_s = 0, bottom_traversal_s = 0, shade_s = 0,
           film_s = 0;
    uint64_t camera_rays = 0, shadow_rays = 0, bounce_rays = 0;
    uint64_t pairs_emitted = 0, pairs_with_hit = 0;
    /// Of the CPU engine's own walk over displaced surfaces: nodes above the patches and within them, each
    /// once for all the rays that visit it together, and blocks of triangles, once a ray. For any number of
    /// threads and any cache the same.
    uint64_t upper_nodes = 0, patch_nodes = 0, blocks = 0;
    uint64_t bottom_built = 0, bottom_reused = 0;
    std::vector<uint64_t> bottom_levels; ///< trees built at level 0, 1, 2, ...
    uint64_t geometry_bytes = 0, structures_bytes = 0, displacement_bytes = 0, bottom_cache_bytes = 0;
    uint64_t ray_buffers_bytes = 0, peak_resident_bytes = 0;
    std::vector<CastStatistics> casts; ///< by depth, camera and bounce rays before shadow rays
    std::vector<std::string> warnings;
};

struct Progress {
    double fraction = 0;  ///< [0, 1] of all samples
    int samples_done = 0; ///< whole passes over the picture
    int samples_total = 0;
    uint64_t rays = 0;    ///< traced so far
    double elapsed_s = 0; ///< since rendering started
};

/// Called from one thread at a time, a few times a second.
class RenderObserver {
  public:
    virtual ~RenderObserver() = default;
    virtual void on_progress(const Progress& progress) = 0;
    /// True asks for an early, orderly end: the picture so far is returned and is valid.
    virtual bool is_cancelled() const = 0;
};

struct RenderResult {
    Image image; ///< R G B A and the layers asked for; linear, data window = crop
    Statistics statistics;
    bool is_complete = true; ///< false after a cancellation; "samples.Y" then tells how far each pixel came
};

/// Renders `scene`. The scene's polygons are released as soon as patches are made from them.
/// Throws Error (bad_input, device_missing, out_of_memory). Safe to call from several threads at once.
RenderResult render(Scene scene, const RenderSettings& settings, RenderObserver* observer = nullptr);

/// What an engine can walk a structure by, the default first.
std::vector<TraversalKind> available_traversals(EngineKind engine, StructureKind structure);

/// Names of the instruction sets that this machine can run, best first; "scalar" is always there.
std::vector<std::string> available_isas();

} // namespace relief
