// Statistics and metadata common to all pictures.
#pragma once

#include <memory>
#include <string>

#include "engine/engine.h"
#include "prepare/prepared_scene.h"
#include "relief/render.h"

namespace relief {

/// Adds counts and bytes of the scene: meshes, patches, texels.
void count_scene(const PreparedScene& scene, Statistics& statistics);

/// Adds what the engine, its film and the scene count; `prepare_s` and `render_s` are there before.
/// `counted`: what the engine had counted for the pictures before this one; becomes what it has counted now.
void collect_statistics(const Engine& engine, const Film& film, const PreparedScene& scene,
                        Statistics& statistics, Statistics& counted);

/// An empty film for a picture. `mattes`: null without Cryptomatte layers.
Film make_film(const ImageSettings& image, std::shared_ptr<const InstanceMattes> mattes);

PictureSpace make_picture_space(const PreparedScene& scene);

/// All that the samples of a picture depend on, as text: films of another are not to be gone on with.
std::string describe_samples(const RenderSettings& settings, uint64_t scene_hash);

/// Writes version, seed, sample range, scene hash and whether pixels lack samples into the metadata.
void add_metadata(const RenderSettings& settings, uint64_t scene_hash, bool is_complete, const Film& film,
                  Image& image);

/// Has the observer of `control`, if it wants any, shown the picture so far; the film outlives the render.
void show_pictures(const Film& film, const PictureSpace& space, RenderControl& control);

} // namespace relief
