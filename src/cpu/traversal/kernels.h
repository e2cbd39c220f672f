// The interface of the SIMD kernels: a dispatch table for each instruction set that they were compiled for.
#pragma once

#include <cstddef>
#include <vector>

#include "bvh/wide_bvh.h"
#include "cpu/patch_trees/patch_tree_cache.h"
#include "cpu/patch_trees/polygon_tree.h"
#include "cpu/tracer.h"
#include "formulas/camera.h"

namespace relief::cpu {

/// What the kernels read: borrowed views, constant while rays are traced.
struct SceneView {
    const Instance* instances = nullptr;
    const Surface* surfaces = nullptr;
    uint32_t instance_count = 0;
    const WideBvh* surface_trees = nullptr; ///< these three are those of SceneTrees
    const WideBvh* instance_tree = nullptr;
    const PolygonTree* polygon_trees = nullptr; ///< one a surface; empty with displacement
    PatchTreeCache* cache = nullptr;
    LeafKind leaf = LeafKind::exact;
    LodRule lod = LodRule::field;
    float narrow = 0; ///< width of a beam of rays in any order that is narrow beside the displaced objects
    float pixel_angle = 0; ///< size of `pixel_error` pixels at distance 1; LodRule::ray only
    uint32_t visibility_mask = kVisibleToAll; ///< of the rays; an only instance has it tested beforehand

    bool is_visible(uint32_t instance) const {
        return (instances[instance].visibility_mask & visibility_mask) != 0;
    }
};

/// A polygon or displaced patch of an instance: whether it is hit. closest: a nearer hit replaces `best`.
struct PrimitiveKernels {
    using Function = bool (*)(const SceneView&, TraceContext&, const TraceRay& world, uint32_t instance,
                              uint32_t patch, TraceHit& best);
    Function closest, any;
};

/// A displaced patch whose box a ray enters, at distance `entry`.
struct PatchEntry {
    float entry;
    uint32_t ray, instance, patch;
};

/// Cells [cell_x, + cell_count) x [cell_y, + cell_count) of a patch, at most 2^kTileLevel a side.
struct PatchCells {
    uint32_t patch;
    PatchLevels levels;
    uint32_t cell_x, cell_y, cell_count;
};

/// Positions in the picture of a pinhole camera.
struct CameraPixels {
    const scalar::CameraFrame& camera;
    const Vec2f* positions;
    size_t count;
};

struct Kernels {
    const char* name;
    /// Nearest hits of `count` rays, traced as bundles in runs of 256, as packets in runs of 16.
    void (*closest_hits)(const SceneView&, TraceContext&, const TraceRay*, TraceHit*, size_t count);
    /// The same of the rays that scalar::make_pinhole_ray aims through each position; neighbours in runs of
    /// 256. They are written to `rays` unless it is null.
    void (*camera_hits)(const SceneView&, TraceContext&, const CameraPixels&, TraceRay* rays, TraceHit*);
    void (*any_hits)(const SceneView&, TraceContext&, const TraceRay*, uint8_t*, size_t count);
    /// Appends the displaced patches that ray `index` of a batch may meet; `hit` becomes that of polygons.
    void (*list_patches)(const SceneView&, TraceContext&, const TraceRay&, uint32_t index, TraceHit& hit,
                         std::vector<PatchEntry>&);
    BuildTreeFunction build_tree;
    /// Holds a displaced patch at `level`, at most kTileLevel, and below, whatever the levels of its edges.
    Box (*find_box)(const Surface&, uint32_t patch, uint32_t level);
    /// Writes the (cell_count + 1)^2 vertices of displaced cells, object space; rows are `stride` apart.
    void (*evaluate_cells)(const Surface&, const PatchCells& cells, Vec3f* vertices, size_t stride);
    PrimitiveKernels primitive; ///< for walks of any other tree
};

/// Kernels for an instruction set, or nullptr where it was not compiled in or this machine lacks it.
const Kernels* find_kernels(Isa isa);

} // namespace relief::cpu
