#include "cpu/picture_footprints.h"

#include <algorithm>

#include "engine/picture_windows.h"

namespace relief::cpu {

namespace {

constexpr size_t kMostBits = size_t(1) << 29; ///< of all blocks
constexpr size_t kMostVoxels = 20000, kLeastVoxels = 64;

/// With room for what edits add.
Box widen(const Box& box) {
    const Vec3f extent = box.extent();
    const float margin = 0.0625f * std::max({extent.x, extent.y, extent.z});
    return {box.lower - Vec3f{margin, margin, margin}, box.upper + Vec3f{margin, margin, margin}};
}

} // namespace

PictureFootprints::PictureFootprints(const Window& window, const Box& bounds) : window_(window) {
    const size_t count = cut_into_windows(window, kBlockEdge).size();
    columns_ = size_t((window.x1 - 1) / kBlockEdge - window.x0 / kBlockEdge + 1);
    grid_ = std::make_unique<const VoxelGrid>(widen(bounds),
                                              std::clamp(kMostBits / count, kLeastVoxels, kMostVoxels));
    footprints_.assign(count, Footprint(*grid_));
    is_stale_.assign(count, 1);
}

bool PictureFootprints::mark_stale(std::span<const Box> places) {
    Footprint changed(*grid_);
    for (const Box& place : places)
        if (!changed.add_box(place)) return false;
    const std::vector<uint32_t> words = changed.find_used_words();
    for (size_t block = 0; block < footprints_.size(); ++block)
        if (footprints_[block].meets(changed, words)) is_stale_[block] = 1;
    return true;
}

std::vector<Window> PictureFootprints::start_stale_windows() {
    std::vector<Window> blocks = cut_into_windows(window_, kBlockEdge);
    std::erase_if(blocks, [&](const Window& block) { return !is_stale_[find_block(block.x0, block.y0)]; });
    for (const Window& block : blocks) at(block.x0, block.y0).clear();
    return blocks;
}

void PictureFootprints::finish() { std::fill(is_stale_.begin(), is_stale_.end(), uint8_t(0)); }

size_t PictureFootprints::byte_count() const {
    size_t bytes = is_stale_.size();
    for (const Footprint& footprint : footprints_) bytes += sizeof(Footprint) + footprint.byte_count();
    return bytes;
}

} // namespace relief::cpu
