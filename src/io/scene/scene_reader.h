// Scene text to scene.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "io/scene/asset_cache.h"
#include "io/scene/json_node.h"
#include "io/scene/scene_content.h"
#include "io/scene/scene_parts.h"
#include "relief/io.h"
#include "relief/scene.h"

namespace relief {

/// Reads scene text whose files are relative to `folder`, at its first frame, or 1; `name` is for messages.
/// Throws bad_input.
Scene parse_scene(std::string_view text, const std::filesystem::path& folder,
                  const std::string& name = "scene", const MeshReaderSettings& reader = {});

using NameIndex = std::unordered_map<std::string, uint32_t>;

/// Reads a document as evaluate_value leaves it, and then parts of it again. A copy goes on for itself.
class SceneReader {
  public:
    /// `name` is for messages.
    SceneReader(std::string name, MeshReaderSettings reader)
        : name_(std::move(name)), reader_(std::move(reader)) {}

    /// Reads and validates all of it, without Scene::hash. Throws bad_input.
    void read(const Json& document, AssetCache& assets);
    /// Reads a part again, as it is now. Throws bad_input, and the scene is of no use then.
    void read_part(const ScenePart& part, const Json& value, AssetCache& assets);

    Scene& scene() { return scene_; }
    const Scene& scene() const { return scene_; }
    /// The scene, of which meshes without faces stay behind.
    Scene take_scene();
    /// Of its files. Meshes that were taken are as they were.
    uint64_t hash_content();

  private:
    /// Objects of one element of the list: as many as it has instances.
    struct ObjectRange {
        size_t first = 0, count = 0;
        uint64_t points_hash = 0;
    };
    struct ObjectNames {
        NameIndex meshes, displacements, materials;
    };

    void read_root(const JsonNode& root, AssetCache& assets);
    Object read_object(const JsonNode& node) const;
    std::vector<Object> read_objects(const JsonNode& node, const AssetCache& assets,
                                     uint64_t& points_hash) const;
    void replace_objects(size_t index, std::vector<Object> objects);

    std::string name_;
    MeshReaderSettings reader_;
    Scene scene_;
    ObjectNames names_;
    std::vector<ObjectRange> ranges_;
    SceneContent content_;
};

} // namespace relief
