// Statistics and metadata common to all pictures.
#pragma once

#include "engine/engine.h"
#include "prepare/prepared_scene.h"
#include "relief/render.h"

namespace relief {

/// Adds counts and bytes of the scene: meshes, patches, texels.
void count_scene(const PreparedScene& scene, Statistics& statistics);

/// Adds what the engine, its film and the scene count; `prepare_s` is there before.
void collect_statistics(const Engine& engine, const Film& film, const PreparedScene& scene,
                        Statistics& statistics);

/// Writes version, seed, sample range, scene hash and whether pixels lack samples into the metadata.
void add_metadata(const RenderSettings& settings, uint64_t scene_hash, bool is_complete, Image& image);

} // namespace relief
