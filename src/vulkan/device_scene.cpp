#include "vulkan/device_scene.h"

#include <algorithm>
#include <cstring>
#include <set>
#include <span>
#include <utility>

#include "base/check.h"
#include "bvh/wide_bvh.h"
#include "formulas/levels.h"
#include "formulas/mips.h"
#include "formulas/patch_tree.h"
#include "prepare/scene_trees.h"
#include "surface/map/mip_chain.h"
#include "vulkan/layout/bindings.h"
#include "vulkan/layout/device_scene.h"
#include "vulkan/texel_store.h"

namespace relief::vulkan {

namespace {

using scalar::kNone;

scalar::AffineData make_affine_data(const Affine& m) {
    return {m.rows[0], m.rows[1], m.rows[2], m.translation};
}

template <class T, class U> uint32_t append(std::vector<T>& target, const std::vector<U>& values) {
    if (values.empty()) return kNone;
    const uint32_t first = uint32_t(target.size());
    target.insert(target.end(), values.begin(), values.end());
    return first;
}

/// Those that are 0 need not be told.
void set_constant(std::vector<uint32_t>& constants, uint32_t number, uint32_t value) {
    if (value == 0) return;
    constants.resize(std::max<size_t>(constants.size(), number + 1));
    constants[number] = value;
}

bool has_placed_textures(const TexturedMaterial& material) {
    return std::ranges::any_of(material.textures, [](const PlacedTexture& texture) {
        return texture.is_udim || texture.wrap != WrapMode::repeat;
    });
}

static_assert(sizeof(WideNode) == scalar::kWideNodeUnits * sizeof(NodeTexels));
static_assert(WideNode::kLeafFlag == scalar::kLeafFlag && WideNode::kMaxLeafFirst == scalar::kLeafFirstMask);

/// Nodes on the longest way down; children lie behind their parents.
uint32_t compute_depth(const WideBvh& tree) {
    std::vector<uint32_t> depths(tree.nodes.size(), 1);
    for (size_t k = 0; k < tree.nodes.size(); ++k)
        for (const uint32_t child : std::span(tree.nodes[k].child, tree.nodes[k].child_count))
            if (!WideNode::is_leaf(child)) {
                DCHECK(child > k);
                depths[child] = depths[k] + 1;
            }
    return depths.empty() ? 0 : *std::ranges::max_element(depths);
}

} // namespace

/// Host copies of the texel buffers.
struct DeviceScene::Arrays {
    std::vector<Vec3f> positions;
    std::vector<Vec2f> uvs;
    std::vector<PackedFrame> frames;
    std::vector<std::array<uint32_t, 4>> quads, overrides;
    std::vector<uint32_t> dominants, levels, primitive_ids, override_bits;
    std::vector<TileIndex> vertex_tiles;
    std::vector<NodeTexels> nodes;
    std::vector<Box> surface_boxes;
    std::vector<uint32_t> surface_roots;

    void add_quads(const Surface& surface, scalar::SurfaceData& data) {
        data.first_quad_texel = uint32_t(quads.size());
        data.has_wide_quads = surface.vertex_count() > 0x10000 ? 1 : 0;
        uint32_t patch = 0;
        for (const Quad quad : surface.quads) {
            const auto& v = quad.vertex;
            const std::array<uint32_t, 2> narrow{v[0] | v[1] << 16, v[2] | v[3] << 16};
            if (data.has_wide_quads)
                quads.push_back(v);
            else if (patch++ % 2 == 0)
                quads.push_back({narrow[0], narrow[1], 0, 0});
            else
                quads.back()[2] = narrow[0], quads.back()[3] = narrow[1];
        }
    }

    /// Appends a tree, whose leaves count from `first_leaf` on; returns its root.
    uint32_t append_tree(const WideBvh& tree, uint32_t first_leaf) {
        if (tree.nodes.empty()) return kNone;
        const uint32_t root = uint32_t(nodes.size());
        nodes.resize(nodes.size() + tree.nodes.size() * scalar::kWideNodeUnits);
        for (size_t k = 0; k < tree.nodes.size(); ++k) {
            WideNode node = tree.nodes[k];
            for (uint32_t& child : std::span(node.child, node.child_count))
                child = WideNode::is_leaf(child) ? child + first_leaf : root + child * scalar::kWideNodeUnits;
            std::memcpy(&nodes[root + k * scalar::kWideNodeUnits], &node, sizeof node);
        }
        return root;
    }

    /// Three a position; returns SurfaceData::first_height.
    uint32_t append_heights(std::span<const float> heights) {
        if (heights.empty()) return kNone;
        const uint32_t first = 3 * uint32_t(positions.size());
        const auto height = [&](size_t k) { return k < heights.size() ? heights[k] : 0.0f; };
        for (size_t k = 0; k < heights.size(); k += 3)
            positions.push_back({height(k), height(k + 1), height(k + 2)});
        return first;
    }

    /// InstanceData::levels of a field that is not uniform.
    uint32_t append_levels(const LevelField& field, uint32_t patch_count) {
        const uint32_t first = uint32_t(levels.size()) | scalar::kManyLevels;
        const bool is_narrow = uint32_t(field.max_level()) <= scalar::kMaxNarrowLevel;
        for (uint32_t patch = 0; patch < patch_count; ++patch) {
            const uint32_t packed = field.packed_at(patch);
            if (!is_narrow)
                levels.push_back(packed);
            else if (patch % 2 == 0)
                levels.push_back(scalar::narrow_levels(packed));
            else
                levels.back() |= scalar::narrow_levels(packed) << 16;
        }
        check_primitive_count(levels.size(), scalar::kNarrowLevels, "list of the levels of all patches",
                              "ask for one level for all: surface.level");
        return is_narrow ? first | scalar::kNarrowLevels : first;
    }

    /// Entries of primitive_ids for a tree of polygons; returns the first.
    uint32_t append_ids(const WideBvh& tree, uint32_t count) {
        const uint32_t first = uint32_t(primitive_ids.size());
        check_primitive_count(uint64_t(first) + count, uint64_t(WideNode::kMaxLeafFirst) + 1,
                              "list of the polygons of all meshes", "split the scene, or use the CPU engine");
        for (uint32_t k = 0; k < count; ++k) primitive_ids.push_back(tree.primitive_at(k));
        return first;
    }
};

DeviceScene::DeviceScene(const Device& device, const PreparedScene& scene, const SceneWalk* walk) {
    Arrays arrays;
    add_textures(device, scene);
    add_surfaces(scene, arrays);
    if (walk)
        add_walk(*walk, arrays);
    else
        add_trees(scene, arrays);
    add_instances(scene, arrays);
    add_tree_levels(scene);
    upload(device, arrays);
}

void DeviceScene::bind(BindingTable& bindings) const {
    for (const Binding& binding : buffers_) bindings.bind(binding.number, binding.buffer);
    bindings.bind(scalar::kBindNodes, nodes_);
}

uint32_t DeviceScene::texture_index(const Texture* texture) const {
    return texture ? texture_indices_.at(texture) : kNone;
}

uint32_t DeviceScene::uv_set_index(int number) const {
    auto found = std::ranges::find(uv_sets_, number);
    if (found == uv_sets_.end()) found = std::ranges::find(uv_sets_, kOwnUvSet);
    return found == uv_sets_.end() ? kNone : uint32_t(found - uv_sets_.begin());
}

std::vector<uint32_t> DeviceScene::add_filter(std::vector<uint32_t> constants) const {
    set_constant(constants, scalar::kSmoothConstant, has_smooth_ ? 1 : 0);
    set_constant(constants, scalar::kTileBordersConstant, has_tile_borders_ ? 1 : 0);
    set_constant(constants, scalar::kBicubicConstant, has_bicubic_ ? 1 : 0);
    set_constant(constants, scalar::kShadowCatchersConstant, has_catchers_ ? 1 : 0);
    return constants;
}

std::vector<uint32_t> DeviceScene::add_contents(std::vector<uint32_t> constants, LodRule lod) const {
    set_constant(constants, scalar::kPolygonsConstant, has_polygons_ ? 1 : 0);
    set_constant(constants, scalar::kTilesConstant, has_tiles_ ? 1 : 0);
    set_constant(constants, scalar::kRayLodConstant, lod == LodRule::ray ? 1 : 0);
    return constants;
}

std::vector<uint32_t> DeviceScene::add_collecting(std::vector<uint32_t> constants) {
    set_constant(constants, scalar::kCollectsConstant, 1);
    return constants;
}

std::vector<uint32_t> DeviceScene::add_normal_maps(std::vector<uint32_t> constants) const {
    constants = add_filter(std::move(constants));
    set_constant(constants, scalar::kNormalMapsConstant, has_normal_maps_ ? 1 : 0);
    set_constant(constants, scalar::kVertexNumbersConstant, has_vertex_numbers_ ? 1 : 0);
    set_constant(constants, scalar::kPlacedTexturesConstant, has_placed_textures_ ? 1 : 0);
    set_constant(constants, scalar::kUvSetsConstant, uv_sets_.empty() ? 0 : 1);
    set_constant(constants, scalar::kAnisotropyConstant, has_anisotropy_ ? 1 : 0);
    return constants;
}

std::vector<uint32_t> DeviceScene::add_layers(std::vector<uint32_t> constants) const {
    constants = add_filter(std::move(constants));
    set_constant(constants, scalar::kLayersConstant, has_layers_ ? 1 : 0);
    set_constant(constants, scalar::kGlassConstant, has_glass_ ? 1 : 0);
    set_constant(constants, scalar::kTerminatorsConstant, uint32_t(terminators_));
    set_constant(constants, scalar::kVertexNumbersConstant, has_vertex_numbers_ ? 1 : 0);
    set_constant(constants, scalar::kPlacedTexturesConstant, has_placed_textures_ ? 1 : 0);
    set_constant(constants, scalar::kUvSetsConstant, uv_sets_.empty() ? 0 : 1);
    set_constant(constants, scalar::kAnisotropyConstant, has_anisotropy_ ? 1 : 0);
    return constants;
}

void DeviceScene::add_textures(const Device& device, const PreparedScene& scene) {
    TexelStore store;
    const auto add = [&](const std::shared_ptr<const Texture>& texture) {
        if (!texture || texture_indices_.contains(texture.get())) return;
        texture_indices_[texture.get()] = uint32_t(tables_.textures.size());
        tables_.textures.push_back(store.add(texture));
    };
    for (const Surface& surface : scene.surfaces)
        for (const DisplacementMap::Tile& tile : surface.map.tiles) {
            add(tile.texture);
            for (uint32_t mip = 1; tile.mips && mip <= tile.mips->count(); ++mip)
                add(tile.mips->copy(mip).texture);
        }
    for (const Material& material : scene.materials)
        visit_textures(material, [&](const char*, const auto& texture, MapFilter filter) {
            add(texture);
            has_smooth_ |= is_smooth(filter);
        });
    if (scene.environment) add(scene.environment->texture);
    for (const Light& light : scene.lights) add(light.color_texture);
    has_layers_ = !scene.layers.empty();
    has_normal_maps_ = scene.has_normal_maps;
    terminators_ = scene.terminators;
    has_catchers_ = scene.has_shadow_catchers;
    has_glass_ = !scene.glass.empty();
    has_vertex_numbers_ = scene.textured.has_vertex_numbers;
    has_placed_textures_ = std::ranges::any_of(scene.textured.list, has_placed_textures);
    has_anisotropy_ = scene.has_anisotropy;
    buffers_.push_back({scalar::kBindFloatTexels, store.make_float_buffer(device)});
    buffers_.push_back({scalar::kBindHalfTexels, store.make_half_buffer(device)});
}

void DeviceScene::add_map(const Surface& surface, Arrays& arrays) {
    const DisplacementMap& map = surface.map;
    scalar::MapData data{};
    data.row0 = map.matrix[0], data.row1 = map.matrix[1], data.row2 = map.matrix[2];
    data.midlevel = map.midlevel;
    data.wrap = uint32_t(map.wrap);
    data.flip_v = map.flip_v;
    data.is_tangent = map.is_tangent;
    data.is_smooth = map.is_smooth;
    has_smooth_ |= map.is_smooth;
    data.first_neighbour = map.neighbours.empty() ? kNone : uint32_t(arrays.override_bits.size());
    has_tile_borders_ |= !map.neighbours.empty();
    for (const TileNeighbours& beside : map.neighbours)
        for (size_t k = 0; k < beside.size(); k += 2)
            arrays.override_bits.push_back(uint32_t(beside[k]) | uint32_t(beside[k + 1]) << 16);
    // Tiles of a map must be consecutive, so tiles shared with another map are listed again.
    data.first_tile = uint32_t(tables_.textures.size());
    data.tile_count = uint32_t(map.tiles.size());
    for (uint32_t mip = 0; mip <= (map.is_filtered ? scalar::kMaxMip : 0); ++mip)
        for (size_t tile = 0; tile < map.tiles.size(); ++tile) {
            const Texture& image = map.image(TileIndex(tile), mip).texture;
            const scalar::TextureData texture = tables_.textures[texture_index(&image)];
            tables_.textures.push_back(texture);
        }
    tables_.maps.push_back(data);
}

uint32_t DeviceScene::add_uv_sets(const Surface& surface, Arrays& arrays) const {
    if (surface.further_uvs.empty()) return kNone;
    const uint32_t first = uint32_t(arrays.override_bits.size());
    for (const int number : uv_sets_) {
        const PatchUvs* set = surface.find_further_uvs(number);
        arrays.override_bits.push_back(set ? uint32_t(arrays.uvs.size()) : kNone);
        if (!set) continue;
        for (const std::array<Vec2f, 4>& corners : set->corners)
            arrays.uvs.insert(arrays.uvs.end(), corners.begin(), corners.end());
    }
    return first;
}

void DeviceScene::add_surfaces(const PreparedScene& scene, Arrays& arrays) {
    for (const Surface& surface : scene.surfaces)
        for (const PatchUvs& set : surface.further_uvs)
            if (std::ranges::find(uv_sets_, set.number) == uv_sets_.end()) uv_sets_.push_back(set.number);
    for (const Surface& surface : scene.surfaces) {
        scalar::SurfaceData data{};
        data.first_vertex = uint32_t(arrays.positions.size());
        data.dominant_count = uint32_t(surface.positions.size());
        append(arrays.positions, surface.positions);
        has_bicubic_ |= !surface.controls.empty();
        data.first_control = surface.controls.empty() ? kNone : uint32_t(arrays.positions.size());
        for (const InnerControls& controls : surface.controls)
            arrays.positions.insert(arrays.positions.end(), controls.begin(), controls.end());
        data.first_height = arrays.append_heights(surface.base_heights);
        data.first_derivative = surface.derivatives.empty() ? kNone : uint32_t(arrays.positions.size());
        for (const std::array<Vec3f, 2>& derivatives : surface.derivatives)
            arrays.positions.insert(arrays.positions.end(), derivatives.begin(), derivatives.end());
        data.first_uv = append(arrays.uvs, surface.uvs);
        data.first_frame = append(arrays.frames, surface.frames);
        data.first_dominant = surface.copies.empty() ? kNone : uint32_t(arrays.dominants.size());
        for (uint32_t v = data.dominant_count; v < surface.vertex_count(); ++v)
            arrays.dominants.push_back(surface.dominant(v));
        data.first_vertex_tile = append(arrays.vertex_tiles, surface.vertex_tiles);
        data.first_quad = patch_count_;
        arrays.add_quads(surface, data);
        patch_count_ += uint32_t(surface.quads.size());
        data.first_override = uint32_t(arrays.overrides.size());
        data.override_count = uint32_t(surface.overrides.size());
        for (const EdgeOverride& o : surface.overrides.list())
            arrays.overrides.push_back({o.patch_edge, o.first, o.second, 0});
        data.first_override_word = surface.overrides.empty() ? kNone : uint32_t(arrays.override_bits.size());
        for (const uint64_t word : surface.overrides.bits()) {
            arrays.override_bits.push_back(uint32_t(word));
            arrays.override_bits.push_back(uint32_t(word >> 32));
        }
        data.first_mip = append(arrays.override_bits, surface.mips);
        data.first_tangent = surface.corner_tangents.empty() ? kNone : uint32_t(arrays.override_bits.size());
        for (const std::array<uint32_t, 4>& tangents : surface.corner_tangents)
            arrays.override_bits.insert(arrays.override_bits.end(), tangents.begin(), tangents.end());
        data.first_uv_set = add_uv_sets(surface, arrays);
        data.has_bilinear_uvs = surface.has_bilinear_uvs ? 1 : 0;
        data.map = surface.has_displacement ? uint32_t(tables_.maps.size()) : kNone;
        if (surface.has_displacement) add_map(surface, arrays);
        has_polygons_ |= !surface.has_displacement;
        tables_.surfaces.push_back(data);
    }
}

void DeviceScene::add_trees(const PreparedScene& scene, Arrays& arrays) {
    uint32_t deepest_surface = 0;
    for (const Surface& surface : scene.surfaces) {
        const Bvh bvh = build_surface_bvh(surface, compute_patch_boxes(surface));
        const WideBvh tree = make_wide_bvh(bvh);
        deepest_surface = std::max(deepest_surface, compute_depth(tree));
        DCHECK(!surface.has_displacement || tree.primitive_ids.empty());
        const uint32_t first_leaf =
            surface.has_displacement ? 0 : arrays.append_ids(tree, uint32_t(surface.patch_count()));
        arrays.surface_roots.push_back(arrays.append_tree(tree, first_leaf));
        arrays.surface_boxes.push_back(bvh.nodes.empty() ? Box{} : bvh.nodes[0].box());
    }
    const WideBvh instances = make_wide_bvh(build_instance_bvh(scene, arrays.surface_boxes));
    DCHECK(instances.primitive_ids.empty());
    root_ = arrays.append_tree(instances, 0);
    stack_size_ = compute_depth(instances) + deepest_surface;
    node_count_ = arrays.nodes.size();
}

void DeviceScene::add_walk(const SceneWalk& walk, Arrays& arrays) {
    traversal_kernel_ = walk.kernel;
    arrays.nodes = walk.nodes, arrays.primitive_ids = walk.words;
    for (const uint8_t has_patches : walk.has_patches)
        arrays.surface_roots.push_back(has_patches ? 0 : kNone);
    root_ = walk.has_instances ? 0 : kNone;
    stack_size_ = 1; // these traversals have stacks of their own
    node_count_ = arrays.nodes.size();
}

/// Instances that share levels are looked at once.
void DeviceScene::add_tree_levels(const PreparedScene& scene) {
    constexpr uint8_t kNoTree = 0xff;
    std::vector<uint8_t> finest(patch_count_, kNoTree); // over the instances of a patch
    std::set<std::pair<uint32_t, const LevelField*>> seen;
    std::set<std::pair<uint32_t, uint32_t>> seen_uniform; // surface and packed levels
    for (const relief::Instance& instance : scene.instances) {
        const Surface& surface = scene.surfaces[instance.surface];
        const LevelField& levels = *instance.levels;
        if (!surface.has_displacement || surface.patch_count() == 0) continue;
        const bool is_new = levels.is_uniform()
                                ? seen_uniform.insert({instance.surface, levels.packed_at(0)}).second
                                : seen.insert({instance.surface, &levels}).second;
        for (uint32_t patch = 0; is_new && patch < surface.patch_count(); ++patch) {
            const auto level = uint8_t(scalar::packed_patch_level(levels.packed_at(patch)));
            uint8_t& known = finest[first_patch(instance.surface) + patch];
            if (known == kNoTree || known < level) known = level;
            tree_levels_ |= 1u << std::min<uint32_t>(level, scalar::kTreeLevels);
            has_tiles_ |= level > scalar::kTreeLevels;
        }
    }
    constexpr uint64_t unit_bytes = scalar::kPoolUnitWords * sizeof(uint32_t);
    for (const uint8_t level : finest) {
        if (level == kNoTree) continue;
        const uint32_t tree_level = std::min<uint32_t>(level, scalar::kTreeLevels);
        tree_bytes_ += (uint64_t(scalar::count_tree_units(tree_level)) * unit_bytes)
                       << 2 * (level - tree_level);
    }
}

void DeviceScene::add_instances(const PreparedScene& scene, Arrays& arrays) {
    for (const relief::Instance& instance : scene.instances) {
        const Surface& surface = scene.surfaces[instance.surface];
        scalar::InstanceData data{};
        data.object_from_origin = make_affine_data(instance.object_space.from_origin);
        data.origin = instance.object_space.origin;
        data.reach = instance.reach;
        data.world_from_object = make_affine_data(instance.world_from_object);
        data.surface = instance.surface;
        data.material = instance.material;
        data.root = arrays.surface_roots[instance.surface];
        data.visibility_mask = instance.visibility_mask;
        data.levels = 0;
        if (instance.levels->is_uniform()) {
            data.levels = surface.patch_count() > 0 ? instance.levels->packed_at(0) : 0;
        } else {
            data.levels = arrays.append_levels(*instance.levels, uint32_t(surface.patch_count()));
        }
        if (instance.is_mirrored) data.levels |= scalar::kMirrored;
        if (instance.is_shadow_catcher) data.levels |= scalar::kShadowCatcher;
        tables_.instances.push_back(data);
    }
}

void DeviceScene::upload(const Device& device, Arrays& arrays) {
    const auto add = [&](uint32_t number, const char* name, TexelFormat format, const auto& values,
                         Purpose purpose = Purpose::geometry) {
        const auto bytes = std::as_bytes(std::span(values));
        Buffer buffer(device, {name, bytes.size(), purpose, format});
        buffer.upload(bytes);
        buffers_.push_back({number, std::move(buffer)});
    };
    arrays.vertex_tiles.resize((arrays.vertex_tiles.size() + 1) / 2 * 2);
    add(scalar::kBindInstances, "instances", TexelFormat::none, tables_.instances);
    add(scalar::kBindSurfaces, "surfaces", TexelFormat::none, tables_.surfaces);
    add(scalar::kBindMaps, "maps", TexelFormat::none, tables_.maps);
    add(scalar::kBindTextures, "textures", TexelFormat::none, tables_.textures);
    add(scalar::kBindPositions, "positions", TexelFormat::r32_float, arrays.positions);
    add(scalar::kBindUvs, "uvs", TexelFormat::rg32_float, arrays.uvs);
    add(scalar::kBindFrames, "frames", TexelFormat::rg32_uint, arrays.frames);
    add(scalar::kBindQuads, "quads", TexelFormat::rgba32_uint, arrays.quads);
    add(scalar::kBindDominants, "dominant vertices", TexelFormat::r32_uint, arrays.dominants);
    add(scalar::kBindVertexTiles, "vertex tiles", TexelFormat::r32_uint, arrays.vertex_tiles);
    add(scalar::kBindOverrides, "edge overrides", TexelFormat::rgba32_uint, arrays.overrides);
    add(scalar::kBindOverrideBits, "override bits", TexelFormat::r32_uint, arrays.override_bits);
    add(scalar::kBindLevels, "levels", TexelFormat::r32_uint, arrays.levels);
    add(scalar::kBindPrimitiveIds, "primitive ids", TexelFormat::r32_uint, arrays.primitive_ids,
        Purpose::structures);
    nodes_ = Buffer(device, {"nodes", arrays.nodes.size() * sizeof(NodeTexels), Purpose::structures,
                             TexelFormat::rgba32_uint});
    nodes_.upload(arrays.nodes);
}

} // namespace relief::vulkan
