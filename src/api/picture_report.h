// What every picture says of itself, whoever made it.
#pragma once

#include "prepare/prepared_scene.h"
#include "relief/render.h"

namespace relief {

/// Adds what the scene holds: meshes, patches, texels and their bytes.
void count_scene(const PreparedScene& scene, Statistics& statistics);

/// Writes version, seed, samples, the scene's hash and whether pixels lack some of the samples into the
/// header.
void add_metadata(const RenderSettings& settings, uint64_t scene_hash, bool is_complete, Image& image);

} // namespace relief
