// An animation of a glTF file at a time: where its nodes are, and how much of each morph target shows.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "io/mesh/gltf_file.h"
#include "relief/types.h"

namespace relief {

/// What an animation moves of a node; the rest is as the node says.
struct GltfPose {
    std::optional<Vec3f> translation, scale;
    std::optional<std::array<double, 4>> rotation; ///< x, y, z, w, of length 1
    std::optional<std::vector<float>> weights;     ///< of morph targets
};

/// The poses of nodes, by index, after so many seconds of an animation, which is named by its name or counted
/// from 0; before its first key and after its last it stands still (specification, 3.11 and appendix C).
/// Throws bad_input, also for an animation that is not there.
std::map<size_t, GltfPose> read_gltf_poses(GltfFile& file, const std::string& animation, double seconds);

} // namespace relief
