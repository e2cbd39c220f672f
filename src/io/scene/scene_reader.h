// Scene text to scene.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "io/scene/asset_cache.h"
#include "io/scene/json_node.h"
#include "relief/io.h"
#include "relief/scene.h"

namespace relief {

/// Reads scene text whose files are relative to `folder`, at its first frame, or 1; `name` is for messages.
/// Throws bad_input.
Scene parse_scene(std::string_view text, const std::filesystem::path& folder,
                  const std::string& name = "scene", const MeshReaderSettings& reader = {});

struct ReadScene {
    Scene scene;
    uint64_t content_hash = 0; ///< of its files
};

/// The scene of a document as evaluate_frame leaves it. Throws bad_input.
ReadScene read_scene(const Json& document, AssetCache& assets, const std::string& name,
                     const MeshReaderSettings& reader);

/// Scene::hash of a document with these files.
uint64_t hash_scene(const Json& document, uint64_t content_hash);

/// `render.frames`; empty: the file names none. Throws bad_input.
std::vector<int> read_frames(const Json& document, const std::string& name);

} // namespace relief
