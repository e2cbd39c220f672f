#include "engine/sample_plan.h"

#include <algorithm>
#include <limits>

#include "base/parallel.h"
#include "engine/picture_windows.h"
#include "engine/scattered_tiles.h"

namespace relief {

namespace {

constexpr int kLongestPass = 16; ///< samples a pixel
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

bool SamplePlan::lacks_samples(size_t block, int end) const {
    return film_.passes.is_active[block] && count_of(block) < end;
}

bool SamplePlan::start_pass() {
    const auto is_lacking = [this] {
        for (size_t block = 0; block < blocks_.size(); ++block)
            if (lacks_samples(block, target())) return true;
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
            errors[block] = estimate_block_noise(film_, blocks_[block]);
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

PassRest SamplePlan::find_rest() const {
    PassRest rest{target(), target()};
    for (size_t block = 0; block < blocks_.size(); ++block) {
        if (!film_.passes.is_active[block]) continue;
        const int count = count_of(block);
        const uint64_t pixels = count_pixels(blocks_[block]);
        rest.pixel_samples_ahead += pixels * uint64_t(std::max(image_.spp - count, 0));
        if (count >= target()) continue;
        rest.begin = std::min(rest.begin, count);
        rest.pixels += pixels;
    }
    return rest;
}

std::vector<SampleTask> SamplePlan::list_tasks(int edge, int end) {
    if (tile_edge_ != edge) tiles_ = cut_into_scattered_tiles(film_.window(), edge), tile_edge_ = edge;
    std::vector<SampleTask> tasks;
    const Window& whole = film_.window();
    const auto find_block = [&](const Window& window) {
        return size_t(window.y0 / kBlockEdge - whole.y0 / kBlockEdge) * columns_ +
               size_t(window.x0 / kBlockEdge - whole.x0 / kBlockEdge);
    };
    for (const Window& tile : tiles_) {
        const size_t before = tasks.size();
        bool is_uniform = true;
        for (const Window& window : cut_into_windows(tile, kBlockEdge)) {
            const size_t block = find_block(window);
            const int first = count_of(block);
            is_uniform &=
                lacks_samples(block, end) && (tasks.size() == before || first == tasks[before].first);
            if (!lacks_samples(block, end)) continue;
            // Rays of neighbours are traced together; those of blocks apart would be in each other's way.
            SampleTask* const left = tasks.size() == before ? nullptr : &tasks.back();
            if (left && left->first == first && left->window.x1 == window.x0 && left->window.y0 == window.y0)
                left->window.x1 = window.x1;
            else
                tasks.push_back({window, first,
                                 std::min(end, first / kLongestPass * kLongestPass + kLongestPass) - first});
        }
        if (is_uniform) tasks.resize(before + 1), tasks.back().window = tile;
    }
    return tasks;
}

bool lacks_samples(Film& film, const ImageSettings& image) { return SamplePlan(film, image).start_pass(); }

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
