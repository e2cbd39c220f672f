// The sections of a scene file, one reader each. All throw bad_input with file and path.
#pragma once

#include <vector>

#include "io/scene/asset_cache.h"
#include "io/scene/json_node.h"
#include "relief/scene.h"

namespace relief {

/// A list of frames, as parse_frames takes it.
std::vector<int> parse_frames_at(const JsonNode& node);
PictureDefaults read_picture(const JsonNode& node);
Camera read_camera(const JsonNode& node);
Affine read_transform(const JsonNode& node);
Light read_light(const JsonNode& node, AssetCache& assets);
Environment read_environment(const JsonNode& node, AssetCache& assets);
Material read_material(const JsonNode& node, const std::string& name, AssetCache& assets);
Displacement read_displacement(const JsonNode& node, const std::string& name, AssetCache& assets);

} // namespace relief
