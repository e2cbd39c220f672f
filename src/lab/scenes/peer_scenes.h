// Scenes to compare renderers by: closed bodies under one rough map, white: the work is geometry.
#pragma once

#include <string>
#include <vector>

#include "relief/scene.h"

namespace relief {

/// rock (600 patches, framed), rocks (ten, 6,000 patches, none instanced), rock_close (fills the picture).
std::vector<std::string> peer_scene_names();

enum class PeerWorld { constant, sky };

/// One map of 1024 x 1024 texels in floats, object space, with overhangs; its longest vector times
/// `roughness` is about as long as an edge of a patch at 1 (a hard case), a third of that at 0.3 (a usual
/// one). Throws Error{usage} for an unknown name.
Scene make_peer_scene(const std::string& name, float roughness, PeerWorld world);

} // namespace relief
