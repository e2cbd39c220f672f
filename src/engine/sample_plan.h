// Which samples of which pixels come next. Passes over the picture end at 1, 4, 16, 32, 48, ... samples
// a pixel; with ImageSettings::noise a block of pixels takes no part in a pass when its noise is low enough
// at the end of the one before.
#pragma once

#include <vector>

#include "film/film.h"
#include "relief/render.h"

namespace relief {

/// Samples [first, first + count), of all samples of a pixel, for each pixel of a window.
struct SampleTask {
    Window window;
    int first = 0, count = 1;
};

/// What a film lacks: found in the film itself, so that a film of some samples goes on where it ended.
class SamplePlan {
  public:
    /// Edge of a block, pixels; blocks lie at absolute multiples of it, and all pixels of one have the same
    /// number of samples.
    static constexpr int kBlockEdge = 8;

    /// Both outlive the plan.
    SamplePlan(Film& film, const ImageSettings& image);

    /// Chooses the next pass, unless the current one lacks something. False: all samples are there.
    bool start_pass();
    /// What the current pass lacks, in windows of at most `edge` pixels a side, a multiple of kBlockEdge, and
    /// of at most 16 samples, up to a multiple of 16: what blocks that come back lack besides is listed when
    /// these are done.
    std::vector<SampleTask> list_tasks(int edge) const;
    /// Samples of each pixel that takes part, at the end of the current pass.
    int target() const { return film_.passes.target; }
    /// Of all samples that pixels might get, the share that they have or will not need.
    double fraction() const;

  private:
    bool lacks_samples(size_t block) const;
    int count_of(size_t block) const;
    void choose_blocks();

    Film& film_;
    const ImageSettings& image_;
    std::vector<Window> blocks_; ///< row by row
    size_t columns_;
};

} // namespace relief
