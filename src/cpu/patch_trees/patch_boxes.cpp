#include "cpu/patch_trees/patch_boxes.h"

#include <algorithm>

#include "base/parallel.h"
#include "formulas/levels.h"
#include "prepare/scene_trees.h"

namespace relief::cpu {

namespace {

constexpr uint32_t kMostLevel = kTileLevel; ///< finer patches are not evaluated as a whole

constexpr uint32_t kSampleCount = 4096; ///< patches of a surface that are looked at, at most

/// Others are evaluated vertex by vertex, which takes too long.
bool is_evaluated_wide(const Surface& surface) {
    return surface.has_displacement && surface.map.wrap != WrapMode::black;
}

} // namespace

PatchBoxes::PatchBoxes(const PreparedScene& scene, const Kernels& kernels, BoxSource source)
    : scene_(scene), kernels_(kernels), source_(source), fields_(scene.surfaces.size()) {
    if (source == BoxSource::bounds) return;
    for (const Instance& instance : scene.instances) {
        std::vector<const LevelField*>& fields = fields_[instance.surface];
        // One level everywhere has one field for all.
        if (fields.empty() || !instance.levels->is_uniform() || !fields.back()->is_uniform())
            fields.push_back(instance.levels.get());
        else if (instance.levels->max_level() > fields.back()->max_level())
            fields.back() = instance.levels.get();
    }
}

/// The highest in any instance.
uint32_t PatchBoxes::find_level(uint32_t surface, uint32_t patch) const {
    uint32_t level = 0;
    for (const LevelField* field : fields_[surface])
        level = std::max(level, scalar::packed_patch_level(field->packed_at(patch)));
    return level;
}

Box PatchBoxes::find(uint32_t surface, uint32_t patch) const {
    if (source_ == BoxSource::vertices && is_evaluated_wide(scene_.surfaces[surface]))
        if (const uint32_t level = find_level(surface, patch); level <= kMostLevel)
            return kernels_.find_box(scene_.surfaces[surface], patch, level);
    return compute_patch_box(scene_.surfaces[surface], patch);
}

std::vector<Box> PatchBoxes::find_all(uint32_t surface) const {
    if (source_ == BoxSource::bounds) return compute_patch_boxes(scene_.surfaces[surface]);
    std::vector<Box> boxes(scene_.surfaces[surface].patch_count());
    parallel_for("patch_boxes", boxes.size(), 16, [&](size_t begin, size_t end) {
        for (size_t k = begin; k < end; ++k) boxes[k] = find(surface, uint32_t(k));
    });
    return boxes;
}

uint64_t PatchBoxes::count_vertices() const {
    uint64_t count = 0;
    for (uint32_t surface = 0; surface < scene_.surfaces.size(); ++surface) {
        if (source_ == BoxSource::bounds || !is_evaluated_wide(scene_.surfaces[surface])) continue;
        const uint32_t patch_count = scene_.surfaces[surface].patch_count();
        const uint32_t step = std::max(1u, (patch_count + kSampleCount - 1) / kSampleCount);
        for (uint32_t patch = 0; patch < patch_count; patch += step) {
            const uint32_t level = find_level(surface, patch);
            if (level <= kMostLevel) count += uint64_t(step) * ((1u << level) + 1) * ((1u << level) + 1);
        }
    }
    return count;
}

} // namespace relief::cpu
