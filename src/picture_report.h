// What every picture says of itself, whoever made it.
#pragma once

#include "engine/prepared_scene.h"
#include "relief/render.h"

namespace relief {

/// Adds what the scene holds: meshes, patches, texels and their bytes.
void count_scene(const PreparedScene& scene, Statistics& statistics);

/// Writes version, seed, samples and the scene's hash into the header.
void add_metadata(const RenderSettings& settings, uint64_t scene_hash, Image& image);

} // namespace relief
