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

/// What a session's engines have counted.
struct SessionCounts {
    Statistics before;   ///< for the pictures before this one
    Statistics replaced; ///< by engines that others have taken the place of
};

/// Keeps what an engine has counted that is about to be replaced in the middle of a picture.
void keep_counts(const Engine& engine, SessionCounts& counts);

/// Adds what the engine, its film and the scene count; `prepare_s` and `render_s` are there before. The
/// picture is then one of those before.
void collect_statistics(const Engine& engine, const Film& film, const PreparedScene& scene,
                        Statistics& statistics, SessionCounts& counts);

/// An empty film for a picture. `mattes`: null without Cryptomatte layers.
Film make_film(const ImageSettings& image, std::shared_ptr<const InstanceMattes> mattes);

PictureSpace make_picture_space(const PreparedScene& scene);

/// All that the samples of a picture depend on, as text: films of another are not to be gone on with.
std::string describe_samples(const RenderSettings& settings, uint64_t scene_hash);

/// Says in the result of a render how far its film came. It adds no samples afterwards.
void note_ends(const ImageSettings& image, Film& film, RenderResult& result);

/// Writes version, seed, sample range, scene hash and whether pixels lack samples into the metadata.
void add_metadata(const RenderSettings& settings, uint64_t scene_hash, bool is_complete, const Film& film,
                  Image& image);

/// Has the observer of `control`, if it wants any, shown the picture so far; the film outlives the render.
void show_pictures(const Film& film, const PictureSpace& space, RenderControl& control);

} // namespace relief
