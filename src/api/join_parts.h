// A picture from the sums that other renders took of its parts.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "film/film.h"
#include "relief/render.h"

namespace relief {

/// Takes the samples of Checkpoints::resume, if it is there; `identity`: describe_samples().
void resume_film(const Checkpoints& checkpoints, const std::string& identity, Film& film);

/// Adds the samples of all parts to the film of the picture, lower ones first; as Checkpoints::parts says.
/// `scene_hash`, `mattes`: of the picture.
void join_parts(const std::vector<FilmPart>& parts, const RenderSettings& settings, uint64_t scene_hash,
                const std::shared_ptr<const InstanceMattes>& mattes, Film& film);

} // namespace relief
