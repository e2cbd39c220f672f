// Patches above level 5 are split into tiles of 32 x 32 cells. The host builds the tree over the tiles of a
// patch on first request by a ray, so that only tiles near rays are ever bounded.
#pragma once

#include <span>
#include <vector>

#include "formulas/patch_tree.h"
#include "vulkan/device/commands.h"
#include "vulkan/device_scene.h"
#include "vulkan/layout/device_rays.h"
#include "vulkan/layout/device_scene.h"

namespace relief::vulkan {

/// Not thread safe. Directories live as long as this object, which is unusable after an error.
class TileDirectories {
  public:
    TileDirectories(const Device& device, const PreparedScene& scene, const DeviceScene& device_scene);

    void bind(BindingTable& bindings) const;

    /// Builds the requested directories that do not exist yet and rebinds buffers that grew.
    void build(std::span<const scalar::RequestData> requests, Commands& commands, BindingTable& bindings);

    /// Number of tiles; their trees are numbered from DeviceScene::patch_count() on.
    uint32_t tile_count() const { return uint32_t(tiles_.size()); }
    /// Size of the hash table - 1.
    uint32_t directory_mask() const { return uint32_t(table_.size()) - 1; }
    /// Whether any patch may have tiles.
    bool is_needed() const { return finest_level_ > int(scalar::kTreeLevels); }
    /// Stack entries that a ray needs for the tiles of a patch.
    uint32_t stack_size() const {
        return is_needed() ? 2 * (uint32_t(finest_level_) - scalar::kTreeLevels) + 2 : 0;
    }

  private:
    struct Boxes;
    Boxes compute_boxes(const scalar::RequestData& request) const;
    uint32_t append_tree(const Boxes& boxes, uint32_t first_tree);
    void append_node(const Boxes& boxes, uint32_t place, uint32_t first_tree,
                     const std::array<uint32_t, 3>& square);
    void insert(const scalar::DirectoryData& directory);
    void place_in_table(const scalar::DirectoryData& directory);
    void upload_nodes(uint32_t first_node, Commands& commands);
    void upload_tiles(size_t first_tile);

    const Device& device_;
    const PreparedScene& scene_;
    const DeviceScene& device_scene_;
    int finest_level_ = 0;
    std::vector<scalar::TileRecord> tiles_;
    std::vector<scalar::DirectoryData> table_; ///< open addressing; the size is a power of two
    uint32_t directory_count_ = 0;
    std::vector<NodeTexels> new_nodes_; ///< built in this call
    uint32_t node_count_ = 0;           ///< on the device
    uint64_t node_capacity_ = 0;
    Buffer nodes_, tile_buffer_, table_buffer_;
};

} // namespace relief::vulkan
