// The noise of a picture, in blocks: by it samples are chosen, and by it the result is judged.
#pragma once

#include "film/film.h"
#include "relief/render.h"

namespace relief {

/// Edge of a block, pixels; blocks lie at absolute multiples of it, and all pixels of one have the same
/// number of samples.
inline constexpr int kNoiseBlockEdge = 8;

/// What ImageSettings::noise is compared with; infinity where pixels have fewer than two samples. The film
/// has estimates of errors.
double estimate_block_noise(const Film& film, const Window& block);

/// Of a film whose render has ended.
NoiseReport measure_noise(const Film& film, double noise);

} // namespace relief
