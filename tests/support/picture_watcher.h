// An observer that keeps the pictures so far.
#pragma once

#include <utility>
#include <vector>

#include "relief/render.h"

namespace relief::test {

struct PictureWatcher final : RenderObserver {
    double interval_s = 0;
    size_t limit = size_t(-1); ///< of pictures, after which the render is cancelled
    std::vector<Image> pictures;

    void on_progress(const Progress&) override {}
    bool is_cancelled() const override { return pictures.size() >= limit; }
    double picture_interval_s() const override { return interval_s; }
    void on_picture(Image picture) override { pictures.push_back(std::move(picture)); }
};

/// The least and the greatest number of samples that pixels of a picture with the layer "samples" have.
inline std::pair<float, float> count_samples(const Image& image) {
    const size_t channel = image.find_channel("samples.Y").value();
    std::pair<float, float> ends{image.at(image.x0, image.y0, channel), 0};
    for (int y = image.y0; y < image.y0 + image.height; ++y)
        for (int x = image.x0; x < image.x0 + image.width; ++x) {
            const float count = image.at(x, y, channel);
            ends.first = count < ends.first ? count : ends.first;
            ends.second = count > ends.second ? count : ends.second;
        }
    return ends;
}

} // namespace relief::test
