// Where the rays of each block of the picture have been: an edit keeps blocks whose rays came nowhere near.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "cpu/footprint.h"
#include "engine/sample_plan.h"
#include "math/box.h"
#include "relief/render.h"

namespace relief::cpu {

class PictureFootprints {
  public:
    /// Edge of a block, pixels; blocks lie at absolute multiples of it.
    static constexpr int kBlockEdge = SamplePlan::kBlockEdge;

    /// Of a picture's window and what can change in it; all blocks are stale. `bounds`: finite, not empty.
    PictureFootprints(const Window& window, const Box& bounds);

    /// The footprint of a pixel's block, for one thread at a time; different blocks at once.
    Footprint& at(int x, int y) { return footprints_[find_block(x, y)]; }

    /// What is in these boxes, or was, has changed: blocks with rays that have been there are stale. False
    /// where a box lies outside of what is kept track of: any block may be, and nothing can be kept any more.
    bool mark_stale(std::span<const Box> places);

    /// Windows of the stale blocks; their footprints are made empty.
    std::vector<Window> start_stale_windows();
    /// The stale windows have been traced.
    void finish();

    size_t byte_count() const;

  private:
    size_t find_block(int x, int y) const {
        return size_t(y / kBlockEdge - window_.y0 / kBlockEdge) * columns_ +
               size_t(x / kBlockEdge - window_.x0 / kBlockEdge);
    }

    Window window_;
    size_t columns_ = 0;
    std::unique_ptr<const VoxelGrid> grid_; ///< that the footprints point to
    std::vector<Footprint> footprints_;     ///< row by row
    std::vector<uint8_t> is_stale_;
};

} // namespace relief::cpu
