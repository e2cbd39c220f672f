// Scene text to scene.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "relief/io.h"
#include "relief/scene.h"

namespace relief {

/// Reads scene text whose files are relative to `folder`; `name` is for messages. Throws bad_input.
Scene parse_scene(std::string_view text, const std::filesystem::path& folder,
                  const std::string& name = "scene", const MeshReaderSettings& reader = {});

} // namespace relief
