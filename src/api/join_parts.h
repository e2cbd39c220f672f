// A picture from the sums that other renders took of its parts.
#pragma once

#include <vector>

#include "film/film.h"
#include "relief/render.h"

namespace relief {

/// Adds the samples of all parts to the film of the picture, lower ones first; as Checkpoints::parts says.
void join_parts(const std::vector<FilmPart>& parts, const RenderSettings& settings, const Scene& scene,
                Film& film);

} // namespace relief
