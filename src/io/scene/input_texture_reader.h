// A texture of one input of a material in a scene file, as an object with its place on the uv plane.
#pragma once

#include "io/scene/asset_cache.h"
#include "io/scene/json_node.h"
#include "relief/scene.h"

namespace relief {

/// Adds the textures that `node`, a material, has as objects under the names of its inputs, or under keys
/// of their own. Throws bad_input.
void read_input_textures(const JsonNode& node, AssetCache& assets, Material& material);

/// The name of the picture that `node` has under "file", with the layer and part that it names.
std::string read_picture_file(const JsonNode& node, AssetCache& assets);

/// `auto` and none are the same.
std::string read_color_space(const JsonNode& node);

} // namespace relief
