// Sections of a scene file that need no other files, as JSON.
#pragma once

#include "io/scene/json_node.h"
#include "relief/scene.h"

namespace relief {

/// The shortest decimals that read back as the same floats.
Json to_json(float value);
Json to_json(const Vec3f& v);

/// What is set of it; an empty object where nothing is.
Json write_picture(const PictureDefaults& picture);
/// 16 numbers, row after row.
Json write_matrix(const Affine& matrix);
Json write_camera(const Camera& camera);
Json write_light(const Light& light);
/// Writes the numbers, colours and flags of a material, except its emission: those that differ from their
/// defaults, and those that files always have.
void write_inputs(const Material& material, Json& node);
/// What a texture of Material::textures says beside its file and, unless it is one of normals, its factor.
Json write_placement(const InputTexture& texture);
/// What the emission of a material is multiplied by: into its keys, one of which may be a texture already.
void write_emission(const Material& material, Json& node);
/// Adds what the entry of the normal map, which is there already, says beside file and filter.
void write_normal_options(const Material& material, Json& node);
/// What the texels of a map of floats mean: all but its file, and what smooths texels of integers.
void write_map_convention(const Displacement& map, Json& node);
/// All but its picture.
void write_environment(const Environment& environment, Json& node);

} // namespace relief
