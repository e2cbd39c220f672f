// The suite `characters` renders these inputs: generated scenes and mesh files, in folders that all programs
// read.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lab/scenes/character_scenes.h"
#include "relief/io.h"
#include "relief/scene.h"

namespace relief::bench {

/// A mesh of the user, and the displacement map and its convention.
struct CharacterFile {
    std::filesystem::path mesh;
    MeshSceneOptions options;
};

/// A scene as the programs find it, and how it changes in a session.
struct CharacterInput {
    std::string name;
    std::filesystem::path scene;       ///< scene.json
    std::filesystem::path changed_map; ///< another map of the first object; empty: it has none
    Vec3f move;                        ///< of the first object
};

/// Name of a file's scene: that of the mesh file without its folder.
std::string name_character(const CharacterFile& file);

/// Writes a generated scene below `folder`. Throws as save_scene.
CharacterInput write_character(const std::string& name, CharacterDetail detail,
                               const std::filesystem::path& folder);

/// Writes the mesh as a Catmull-Clark surface, white and lit by the sky of the generated scenes. Throws as
/// load_mesh_scene.
CharacterInput write_character(const CharacterFile& file, const std::filesystem::path& folder);

} // namespace relief::bench
