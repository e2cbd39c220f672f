// Films of parts of a picture, added to that of the whole.
#include <algorithm>
#include <string>

#include <fmt/format.h>

#include "base/check.h"
#include "film/film.h"
#include "relief/error.h"

namespace relief {

void Film::join(const Film& part, uint32_t before) {
    DCHECK(part.stride_ == stride_ && part.layers_.size() == layers_.size());
    DCHECK(!batches_ || before % SampleBatches::kSizes.back() == 0);
    const Window& window = part.window_;
    size_t other = 0;
    for (int y = window.y0; y < window.y1; ++y)
        for (int x = window.x0; x < window.x1; ++x, ++other) {
            if (part.counts_[other] == 0) continue;
            const size_t pixel = pixel_index(x, y);
            if (counts_[pixel] != before)
                throw Error(ErrorKind::bad_input,
                            {fmt::format("its samples of pixel ({}, {}) begin with number {}, and the parts "
                                         "before it have {}",
                                         x, y, before, counts_[pixel]),
                             "", "give each tile and range of samples once, and all of them"});
            for (size_t k = 0; k < stride_; ++k)
                sums_[pixel * stride_ + k] += part.sums_[other * stride_ + k];
            counts_[pixel] += part.counts_[other];
            if (!hit_counts_.empty()) hit_counts_[pixel] += part.hit_counts_[other];
            if (!ids_.empty() && part.ids_[other] != 0)
                add_nearest(pixel, part.depths_[other], part.ids_[other]);
            if (objects_) objects_->join(pixel, *part.objects_, other);
            if (materials_) materials_->join(pixel, *part.materials_, other);
            if (batches_) batches_->join(pixel, *part.batches_, other);
        }
}

} // namespace relief
