// Which samples of which pixels come next. Passes over the picture end at 1, 4, 16, 32, 48, ... samples
// a pixel; with ImageSettings::noise a block of pixels takes no part in a pass when its noise is low enough
// at the end of the one before.
#pragma once

#include <vector>

#include "engine/block_noise.h"
#include "engine/pass_pace.h"
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
    static constexpr int kBlockEdge = kNoiseBlockEdge;

    /// Both outlive the plan.
    SamplePlan(Film& film, const ImageSettings& image);

    /// Chooses the next pass, unless the current one lacks something. False: all samples are there.
    bool start_pass();
    /// What the current pass lacks up to `end` samples a pixel, in windows of at most `edge` pixels a side, a
    /// multiple of kBlockEdge, in a scattered order, and of at most 16 samples, up to a multiple of 16: what
    /// blocks that come back lack besides is listed when these are done.
    std::vector<SampleTask> list_tasks(int edge, int end);
    std::vector<SampleTask> list_tasks(int edge) { return list_tasks(edge, target()); }
    /// What the current pass lacks in all.
    PassRest find_rest() const;
    /// Samples of each pixel that takes part, at the end of the current pass.
    int target() const { return film_.passes.target; }
    /// Of all samples that pixels might get, the share that they have or will not need.
    double fraction() const;

  private:
    bool lacks_samples(size_t block, int end) const;
    int count_of(size_t block) const;
    void choose_blocks();

    Film& film_;
    const ImageSettings& image_;
    std::vector<Window> blocks_; ///< row by row
    size_t columns_;
    std::vector<Window> tiles_; ///< of the last list of tasks, in their order
    int tile_edge_ = 0;
};

/// Whether a render that has ended lacks samples: a time limit ended it.
bool lacks_samples(Film& film, const ImageSettings& image);

} // namespace relief
