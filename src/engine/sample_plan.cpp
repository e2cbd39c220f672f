#include "engine/sample_plan.h"

#include <algorithm>
#include <limits>

#include "base/parallel.h"
#include "engine/picture_windows.h"

namespace relief {

namespace {

constexpr int kLongestPass = 16; ///< samples a pixel
/// Standard errors that ImageSettings::noise is compared with: 95 of 100 values of a normal distribution lie
/// within 1.96, so that 95 of 100 pixels of a block are closer than 1.25 times the noise to their mean.
constexpr double kDeviations = 1.96 / 1.25;
/// Blocks beside a noisy one go on while they have this share of its noise: neither edges of blocks nor
/// features that cross them show.
constexpr double kNeighbourShare = 0.5;

int find_next_end(int samples) {
    return samples < kLongestPass ? std::clamp(4 * samples, 1, kLongestPass)
                                  : samples / kLongestPass * kLongestPass + kLongestPass;
}

/// Ends of passes: elsewhere a render ended that had fewer samples.
bool is_end(int samples) {
    return samples >= kLongestPass ? samples % kLongestPass == 0 : samples == 1 || samples == 4;
}

} // namespace

SamplePlan::SamplePlan(Film& film, const ImageSettings& image)
    : film_(film), image_(image), blocks_(cut_into_windows(film.window(), kBlockEdge)) {
    const Window& window = film.window();
    columns_ = size_t((window.x1 - 1) / kBlockEdge - window.x0 / kBlockEdge + 1);
    film_.passes.is_active.resize(blocks_.size(), 1);
    film_.passes.target = std::min(target(), image.spp); // of a film that was to have more
}

int SamplePlan::count_of(size_t block) const {
    return int(film_.sample_count(blocks_[block].x0, blocks_[block].y0));
}

bool SamplePlan::lacks_samples(size_t block) const {
    return film_.passes.is_active[block] && count_of(block) < target();
}

bool SamplePlan::start_pass() {
    const auto is_lacking = [this] {
        for (size_t block = 0; block < blocks_.size(); ++block)
            if (lacks_samples(block)) return true;
        return false;
    };
    while (!is_lacking()) {
        if (target() >= image_.spp) return false;
        if (image_.noise > 0 && target() >= ImageSettings::kLeastNoiseSamples && is_end(target()))
            choose_blocks();
        film_.passes.target = std::min(find_next_end(target()), image_.spp);
    }
    return true;
}

/// By the sums at the end of a pass alone, so that the choice depends on no order and no interruption.
void SamplePlan::choose_blocks() {
    std::vector<double> errors(blocks_.size());
    parallel_for("estimate_noise", blocks_.size(), 64, [&](size_t begin, size_t end) {
        for (size_t block = begin; block < end; ++block)
            errors[block] = kDeviations * film_.estimate_error(blocks_[block]);
    });
    const size_t rows = blocks_.size() / columns_;
    for (size_t row = 0; row < rows; ++row)
        for (size_t column = 0; column < columns_; ++column) {
            double error = errors[row * columns_ + column];
            for (size_t y = row - (row > 0); y <= std::min(row + 1, rows - 1); ++y)
                for (size_t x = column - (column > 0); x <= std::min(column + 1, columns_ - 1); ++x)
                    error = std::max(error, kNeighbourShare * errors[y * columns_ + x]);
            film_.passes.is_active[row * columns_ + column] = error > double(image_.noise);
        }
}

std::vector<SampleTask> SamplePlan::list_tasks(int edge) const {
    std::vector<SampleTask> tasks;
    const Window& whole = film_.window();
    const auto find_block = [&](const Window& window) {
        return size_t(window.y0 / kBlockEdge - whole.y0 / kBlockEdge) * columns_ +
               size_t(window.x0 / kBlockEdge - whole.x0 / kBlockEdge);
    };
    for (const Window& tile : cut_into_windows(whole, edge)) {
        const size_t before = tasks.size();
        bool is_uniform = true;
        for (const Window& window : cut_into_windows(tile, kBlockEdge)) {
            const size_t block = find_block(window);
            const int first = count_of(block);
            is_uniform &= lacks_samples(block) && (tasks.size() == before || first == tasks[before].first);
            if (!lacks_samples(block)) continue;
            // Rays of neighbours are traced together; those of blocks apart would be in each other's way.
            SampleTask* const left = tasks.size() == before ? nullptr : &tasks.back();
            if (left && left->first == first && left->window.x1 == window.x0 && left->window.y0 == window.y0)
                left->window.x1 = window.x1;
            else
                tasks.push_back(
                    {window, first,
                     std::min(target(), first / kLongestPass * kLongestPass + kLongestPass) - first});
        }
        if (is_uniform) tasks.resize(before + 1), tasks.back().window = tile;
    }
    return tasks;
}

double SamplePlan::fraction() const {
    double there = 0;
    for (size_t block = 0; block < blocks_.size(); ++block) {
        const int samples =
            film_.passes.is_active[block] ? std::min(count_of(block), image_.spp) : image_.spp;
        there += double(count_pixels(blocks_[block])) * samples;
    }
    return there / (double(count_pixels(film_.window())) * image_.spp);
}

} // namespace relief
