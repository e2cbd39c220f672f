// The prepared scene in device memory, in the layout of vulkan/layout/device_scene.h.
#pragma once

#include <map>
#include <vector>

#include "formulas/constants.h"
#include "prepare/prepared_scene.h"
#include "vulkan/device/buffer.h"
#include "vulkan/device/kernel.h"
#include "vulkan/layout/device_scene.h"
#include "vulkan/scene_walk.h"

namespace relief::vulkan {

/// Surfaces and textures on the device, immutable. Throws Error{out_of_memory} with the byte count.
class DeviceScene {
  public:
    /// `walk`, unless null, replaces the engine's own trees. Read during construction only.
    DeviceScene(const Device& device, const PreparedScene& scene, const SceneWalk* walk = nullptr);

    void bind(BindingTable& bindings) const;

    /// Root of the tree of instances; scalar::kNone for an empty scene.
    uint32_t root() const { return root_; }
    /// First patch of a surface among all patches; trees of tiles count from patch_count() on.
    uint32_t first_patch(uint32_t surface) const { return tables_.surfaces[surface].first_quad; }
    uint32_t patch_count() const { return patch_count_; }
    /// The scene traversal kernel, and the stack entries that it needs.
    const TraversalKernel& traversal_kernel() const { return traversal_kernel_; }
    uint32_t stack_size() const { return stack_size_; }
    /// Bit k: there are patches, or tiles of finer patches, of level k.
    uint32_t tree_levels() const { return tree_levels_; }
    /// Of the trees of all patches at their levels; of a patch of a finer one, of all its tiles.
    uint64_t tree_bytes() const { return tree_bytes_; }
    uint32_t node_count() const { return uint32_t(node_count_); }
    const Buffer& nodes() const { return nodes_; }
    /// Index into the table of textures; scalar::kNone for null.
    uint32_t texture_index(const Texture* texture) const;
    /// InputTextureData::uv_set of a number of a set; scalar::kNone: no surface has it beside its own.
    uint32_t uv_set_index(int number) const;
    /// Constants of a kernel that reads maps or textures, or adds to the film, with scalar::kSmoothConstant,
    /// kTileBordersConstant and kShadowCatchersConstant where the scene needs them.
    std::vector<uint32_t> add_filter(std::vector<uint32_t> constants) const;
    /// Constants of a kernel that walks the scene trees, with scalar::kPolygonsConstant, kTilesConstant and
    /// kRayLodConstant.
    std::vector<uint32_t> add_contents(std::vector<uint32_t> constants, LodRule lod) const;
    /// The same with scalar::kCollectsConstant.
    static std::vector<uint32_t> add_collecting(std::vector<uint32_t> constants);
    /// The same as add_filter, and scalar::kNormalMapsConstant, kVertexNumbersConstant,
    /// kPlacedTexturesConstant, kUvSetsConstant and kAnisotropyConstant, for the kernel that finds shading
    /// normals.
    std::vector<uint32_t> add_normal_maps(std::vector<uint32_t> constants) const;
    /// That of add_filter, and scalar::kLayersConstant, kGlassConstant, kTerminatorsConstant,
    /// kVertexNumbersConstant, kPlacedTexturesConstant, kUvSetsConstant and kAnisotropyConstant, for a kernel
    /// that knows what scatters.
    std::vector<uint32_t> add_layers(std::vector<uint32_t> constants) const;

  private:
    struct Tables {
        std::vector<scalar::InstanceData> instances;
        std::vector<scalar::SurfaceData> surfaces;
        std::vector<scalar::MapData> maps;
        std::vector<scalar::TextureData> textures;
    };
    struct Arrays;
    void add_textures(const Device& device, const PreparedScene& scene);
    void add_map(const Surface& surface, Arrays& arrays);
    void add_surfaces(const PreparedScene& scene, Arrays& arrays);
    /// Returns SurfaceData::first_uv_set.
    uint32_t add_uv_sets(const Surface& surface, Arrays& arrays) const;
    void add_instances(const PreparedScene& scene, Arrays& arrays);
    void add_tree_levels(const PreparedScene& scene);
    void add_trees(const PreparedScene& scene, Arrays& arrays);
    void add_walk(const SceneWalk& walk, Arrays& arrays);
    void upload(const Device& device, Arrays& arrays);

    Tables tables_;
    std::map<const Texture*, uint32_t> texture_indices_;
    std::vector<int> uv_sets_; ///< numbers of the further sets of all surfaces
    TraversalKernel traversal_kernel_{"scene_traversal", {}, {}};
    uint32_t root_ = scalar::kNone, patch_count_ = 0, stack_size_ = 0, tree_levels_ = 0;
    uint64_t tree_bytes_ = 0;
    size_t node_count_ = 0;
    bool has_smooth_ = false, has_layers_ = false, has_normal_maps_ = false, has_glass_ = false;
    bool has_catchers_ = false, has_bicubic_ = false, has_polygons_ = false, has_tiles_ = false;
    bool has_tile_borders_ = false;
    Terminators terminators_ = Terminators::none;
    bool has_vertex_numbers_ = false, has_placed_textures_ = false, has_anisotropy_ = false;
    struct Binding {
        uint32_t number;
        Buffer buffer;
    };
    std::vector<Binding> buffers_;
    Buffer nodes_;
};

} // namespace relief::vulkan
