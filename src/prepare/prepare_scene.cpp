#include <map>
#include <set>
#include <string>
#include <tuple>
#include <utility>

#include "base/machine.h"
#include "base/parallel.h"
#include "formulas/mips.h"
#include "math/affine.h"
#include "prepare/camera_enclosure.h"
#include "prepare/editable_scene.h"
#include "prepare/local_origins.h"
#include "prepare/scene_levels.h"
#include "prepare/scene_warnings.h"
#include "prepare/space_warnings.h"
#include "prepare/tessellate.h"
#include "prepare/validate_settings.h"
#include "relief/error.h"
#include "surface/map/displacement_map.h"
#include "surface/mesh/corner_tangents.h"
#include "surface/patch/patch_mips.h"

namespace relief {

namespace {

/// Objects that share a surface: same mesh, same displacement, and for world-space maps the same transform.
using SurfaceKey = std::tuple<uint32_t, uint32_t, uint32_t>;

SurfaceKey make_key(const Scene& scene, uint32_t object_index) {
    const Object& object = scene.objects[object_index];
    const bool is_world = object.displacement != kNoIndex &&
                          scene.displacements[object.displacement].space == DisplacementSpace::world;
    return {object.mesh, object.displacement, is_world ? object_index : kNoIndex};
}

Instance make_instance(const Object& object, uint32_t surface, uint32_t default_material) {
    Instance instance;
    instance.surface = surface;
    instance.material = object.material == kNoIndex ? default_material : object.material;
    instance.visibility_mask = object.visibility_mask;
    instance.is_shadow_catcher = object.is_shadow_catcher;
    return instance;
}

/// So that pictures need not look at masks.
void check_visibility(const Scene& scene) {
    for (size_t k = 0; k < scene.objects.size(); ++k)
        if (scene.objects[k].visibility_mask == 0)
            throw Error(ErrorKind::bad_input, {"its visibility mask is 0, so that no ray can meet it",
                                               scene.objects[k].name.empty() ? "object " + std::to_string(k)
                                                                             : scene.objects[k].name,
                                               "leave the object out, or set a bit"});
}

std::vector<const Mesh*> list_meshes(const Scene& scene, uint32_t displacement) {
    std::set<uint32_t> meshes;
    for (const Object& object : scene.objects)
        if (object.displacement == displacement) meshes.insert(object.mesh);
    std::vector<const Mesh*> list;
    for (const uint32_t mesh : meshes) list.push_back(&scene.meshes[mesh]);
    return list;
}

/// Coefficients in place of texels, once for each form of an image. Keeps the images alive.
class SplineCache {
  public:
    std::shared_ptr<const Texture> get_or_make(const std::shared_ptr<const Texture>& texels,
                                               const SplineForm& form) {
        if (!texels || form.keeps_texels()) return texels;
        Entry& entry = entries_[{texels.get(), form}];
        if (!entry.coefficients) entry = {texels, make_spline(texels, form)};
        return entry.coefficients;
    }

  private:
    struct Entry {
        std::shared_ptr<const Texture> texels, coefficients;
    };
    std::map<std::pair<const Texture*, SplineForm>, Entry> entries_;
};

/// Textures of materials with a smooth filter become coefficients.
void prepare_textures(std::vector<Material>& materials) {
    SplineCache splines;
    for (Material& material : materials) {
        for (InputTexture& placed : material.textures) {
            SplineForm form = make_spline_form(placed.filter);
            form.wrap = placed.is_udim ? WrapMode::clamp : placed.wrap;
            for (MapTile& tile : placed.tiles) tile.texture = splines.get_or_make(tile.texture, form);
            if (is_smooth(placed.filter)) placed.filter = MapFilter::bspline;
        }
        visit_own_textures(material, [&](const char*, auto& texture, MapFilter& filter) {
            if (!is_smooth(filter)) return;
            texture = splines.get_or_make(texture, make_spline_form(filter));
            filter = MapFilter::bspline;
        });
    }
}

/// Lists the maps and their smaller copies, dilated, smooth ones as coefficients: in copies, since textures
/// of the scene may be shared.
void prepare_maps(Scene& scene, EditableScene& prepared) {
    SplineCache splines;
    for (uint32_t k = 0; k < scene.displacements.size(); ++k) {
        Displacement& displacement = scene.displacements[k];
        const std::vector<const Mesh*> meshes = list_meshes(scene, k);
        for (MapTile& tile : displacement.tiles) {
            const void* source = tile.texture.get();
            GutterFill gutter;
            if (displacement.dilate && !meshes.empty()) gutter = find_gutter(displacement, tile, meshes);
            if (!gutter.copies.empty()) {
                auto filled = std::make_shared<Texture>(*tile.texture);
                gutter.apply(*filled);
                tile.texture = std::move(filled);
            }
            std::shared_ptr<MipChain> mips;
            if (displacement.filter == MapFilter::mip && !meshes.empty()) {
                const TexelRectangle all{0, 0, tile.texture->width - 1, tile.texture->height - 1};
                if (!find_texel_range(*tile.texture, all)) refuse_bad_texel(*tile.texture, all);
                OutsideTexels outside;
                if (displacement.dilate) outside = find_outside_texels(displacement, tile, meshes);
                mips = std::make_shared<MipChain>(*tile.texture, std::move(outside), displacement.wrap);
            }
            PreparedMap map;
            map.displacement = displacement.name, map.udim = tile.udim;
            map.texture = tile.texture, map.gutter = std::move(gutter), map.mips = mips;
            map.form = make_spline_form(displacement);
            map.source = source;
            if (!map.form.keeps_texels() && !meshes.empty())
                tile.texture = map.coefficients = splines.get_or_make(tile.texture, map.form);
            prepared.scene->maps.push_back(std::move(map));
            prepared.mips.push_back(std::move(mips));
        }
        // What the surfaces get are coefficients now.
        if (is_smooth(displacement.filter) && !meshes.empty())
            displacement.filter = MapFilter::bspline, displacement.dequantize = false;
    }
}

/// Hands the copies of maps to the surfaces of their displacements.
void share_mips(const Scene& scene, const std::map<SurfaceKey, uint32_t>& surface_of_key,
                PreparedScene& prepared) {
    std::vector<size_t> first_map(scene.displacements.size(), 0);
    for (size_t k = 1; k < first_map.size(); ++k)
        first_map[k] = first_map[k - 1] + scene.displacements[k - 1].tiles.size();
    for (const auto& [key, surface] : surface_of_key) {
        const uint32_t displacement = std::get<1>(key);
        if (displacement == kNoIndex) continue;
        std::vector<DisplacementMap::Tile>& tiles = prepared.surfaces[surface].map.tiles;
        for (size_t k = 0; k < tiles.size(); ++k)
            tiles[k].mips = prepared.maps[first_map[displacement] + k].mips;
    }
}

/// Normals at vertices cannot hold what is finer than the cells between them.
void drop_detail(PreparedScene& scene) {
    for (Surface& surface : scene.surfaces)
        for (uint32_t& word : surface.mips) word &= (1u << scalar::kDetailShift) - 1;
}

/// Frees the polygons of meshes that no later surface needs.
void release_mesh(Scene& scene, uint32_t mesh) {
    Mesh empty;
    empty.name = std::move(scene.meshes[mesh].name);
    scene.meshes[mesh] = std::move(empty);
}

/// One surface a key, in the order of first use, mesh by mesh, so that polygons can be freed.
void make_surfaces(Scene& scene, const std::map<SurfaceKey, uint32_t>& surface_of_key,
                   const std::vector<uint32_t>& first_object, std::vector<Surface>& surfaces) {
    std::vector<std::vector<uint32_t>> surfaces_of_mesh(scene.meshes.size());
    for (const auto& [key, surface] : surface_of_key) surfaces_of_mesh[std::get<0>(key)].push_back(surface);
    PyramidCache pyramids;
    surfaces.resize(surface_of_key.size());
    parallel_for("make_surfaces", scene.meshes.size(), 1, [&](size_t begin, size_t end) {
        for (size_t mesh = begin; mesh < end; ++mesh) {
            for (const uint32_t surface : surfaces_of_mesh[mesh]) {
                const Object& object = scene.objects[first_object[surface]];
                const Displacement* displacement =
                    object.displacement == kNoIndex ? nullptr : &scene.displacements[object.displacement];
                surfaces[surface] = make_surface(scene.meshes[mesh], displacement,
                                                 *invert(object.world_from_object), &pyramids);
            }
            release_mesh(scene, uint32_t(mesh));
        }
    });
}

/// Of the surfaces that some normal map or material with a direction lies on.
void add_tangents(PreparedScene& prepared) {
    std::set<uint32_t> mapped;
    for (const Instance& instance : prepared.instances)
        if (const Material& material = prepared.materials[instance.material];
            has_normal_map(material) || is_anisotropic(material))
            mapped.insert(instance.surface);
    const std::vector<uint32_t> list(mapped.begin(), mapped.end());
    parallel_for("tangents", list.size(), 1, [&](size_t begin, size_t end) {
        for (size_t k = begin; k < end; ++k) {
            Surface& surface = prepared.surfaces[list[k]];
            surface.corner_tangents = make_corner_tangents(surface);
        }
    });
}

/// Of surfaces that are not tessellated yet.
Terminators find_terminators(const PreparedScene& scene) {
    const auto has = [&](bool has_displacement) {
        return std::ranges::any_of(scene.surfaces, [&](const Surface& surface) {
            return surface.has_displacement == has_displacement && !surface.frames.empty();
        });
    };
    if (scene.levels.fixed_level >= 0 && has(true)) return Terminators::all;
    return has(false) ? Terminators::polygons : Terminators::none;
}

} // namespace

std::vector<uint32_t> choose_scene_mips(const PreparedScene& scene, uint32_t surface) {
    std::vector<const LevelField*> levels;
    for (const Instance& instance : scene.instances)
        if (instance.surface == surface) levels.push_back(instance.levels.get());
    return choose_mips(scene.surfaces[surface], levels);
}

EditableScene prepare_editable_scene(Scene scene, const RenderSettings& settings, SceneOrigin origin) {
    validate_scene(scene);
    check_visibility(scene);
    auto prepared = std::make_shared<PreparedScene>();
    EditableScene editable{prepared, {}};
    prepared->warnings = std::move(scene.warnings);
    // Before anything else is moved out of the scene.
    for (std::string& warning : find_scene_warnings(scene)) prepared->warnings.push_back(std::move(warning));
    prepared->materials = std::move(scene.materials);
    prepare_textures(prepared->materials);
    prepared->materials.emplace_back();
    for (Material& material : prepared->materials)
        material.base_color = material.base_color * std::exchange(material.base_weight, 1.0f);
    prepared->has_cut_outs = std::ranges::any_of(
        prepared->materials, [](const Material& m) { return is_cut_out(m) || is_clear_wall(m); });
    prepared->has_normal_maps = std::ranges::any_of(prepared->materials, has_normal_map);
    prepared->has_anisotropy = std::ranges::any_of(prepared->materials, is_anisotropic);
    prepared->textured = make_textured_materials(prepared->materials);
    prepared->layers = make_material_layers(prepared->materials, prepared->textured);
    prepared->glass = make_material_glass(prepared->materials);
    prepared->links = make_light_links(scene);
    prepared->lights = std::move(scene.lights);
    prepared->environment = std::move(scene.environment);
    prepared->light_groups = make_light_groups(
        {prepared->materials, prepared->lights, prepared->environment ? &*prepared->environment : nullptr},
        settings.image.layers);
    prepared->camera = scene.camera;
    prepared->mesh_count = uint32_t(scene.meshes.size());
    prepared->width = settings.image.width, prepared->height = settings.image.height;

    std::map<SurfaceKey, uint32_t> surface_of_key;
    std::vector<uint32_t> first_object;
    const uint32_t default_material = uint32_t(prepared->materials.size()) - 1;
    for (uint32_t k = 0; k < scene.objects.size(); ++k) {
        const auto [place, is_new] =
            surface_of_key.try_emplace(make_key(scene, k), uint32_t(first_object.size()));
        if (is_new) first_object.push_back(k);
        prepared->instances.push_back(make_instance(scene.objects[k], place->second, default_material));
    }
    prepared->has_shadow_catchers = has_shadow_catchers(scene);
    const std::vector<Vec3f> taken_off = move_meshes_to_origin(scene);
    prepare_maps(scene, editable);
    make_surfaces(scene, surface_of_key, first_object, prepared->surfaces);
    share_mips(scene, surface_of_key, *prepared);
    add_tangents(*prepared);
    place_instances(scene, taken_off, origin, *prepared);

    update_scene_levels(*prepared, settings);
    for (uint32_t surface = 0; surface < prepared->surfaces.size(); ++surface)
        prepared->surfaces[surface].mips = choose_scene_mips(*prepared, surface);
    prepared->may_enclose_camera = may_enclose_camera(*prepared);
    prepared->terminators = find_terminators(*prepared);
    if (settings.surface.mode == SurfaceMode::tessellated) drop_detail(*prepared);
    if (settings.surface.mode == SurfaceMode::tessellated)
        tessellate_scene(*prepared, available_memory_bytes());
    for (std::string& warning : find_space_warnings(*prepared))
        prepared->warnings.push_back(std::move(warning));
    return editable;
}

std::shared_ptr<const PreparedScene> prepare_scene(Scene scene, const RenderSettings& settings,
                                                   SceneOrigin origin) {
    const std::shared_ptr<PreparedScene> prepared =
        prepare_editable_scene(std::move(scene), settings, origin).scene;
    for (PreparedMap& map : prepared->maps)
        if (map.coefficients) map.texture = nullptr;
    return prepared;
}

} // namespace relief
