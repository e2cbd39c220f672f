#include "prepare/scene_surfaces.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

#include "base/parallel.h"
#include "base/progress.h"
#include "base/stop_request.h"
#include "math/affine.h"
#include "scene/uv_sets.h"
#include "surface/map/displacement_map.h"
#include "surface/map/spline_coefficients.h"

namespace relief {

namespace {

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

/// Frees the polygons of meshes that no later surface needs.
void release_mesh(Scene& scene, uint32_t mesh) {
    Mesh empty;
    empty.name = std::move(scene.meshes[mesh].name);
    scene.meshes[mesh] = std::move(empty);
}

bool has_same_tiles(const DisplacementMap& a, const DisplacementMap& b) {
    return std::ranges::equal(a.tiles, b.tiles, {}, &DisplacementMap::Tile::texture,
                              &DisplacementMap::Tile::texture);
}

/// Whether vertices come out the same.
bool is_same_map(const DisplacementMap& a, const DisplacementMap& b) {
    return has_same_tiles(a, b) && a.matrix == b.matrix && a.midlevel == b.midlevel && a.wrap == b.wrap &&
           a.flip_v == b.flip_v && a.is_tangent == b.is_tangent && a.is_filtered == b.is_filtered &&
           a.has_autobump == b.has_autobump && a.is_smooth == b.is_smooth;
}

/// Whether a surface has those of the mesh's further uvs that are asked for, and no others.
bool has_uv_sets(const Surface& surface, const Mesh& mesh, const std::vector<int>& uv_sets) {
    std::vector<int> wanted, found;
    for (const UvSet& set : mesh.further_uvs)
        if (std::ranges::find(uv_sets, set.number) != uv_sets.end()) wanted.push_back(set.number);
    if (std::ranges::find(uv_sets, kOwnUvSet) != uv_sets.end()) wanted.push_back(kOwnUvSet);
    for (const PatchUvs& set : surface.further_uvs) found.push_back(set.number);
    return wanted == found;
}

/// Whether surfaces of the object have uvs without the offsets of their tiles.
bool has_tiles(const Scene& scene, const Object& object) {
    return object.displacement != kNoIndex && scene.displacements[object.displacement].is_udim;
}

/// Adds what is not there yet.
void add_uv_sets(const std::vector<int>& numbers, std::vector<int>& list) {
    for (const int number : numbers)
        if (std::ranges::find(list, number) == list.end()) list.push_back(number);
}

SurfaceContext make_context(const SurfaceRecipe& recipe, PyramidCache& pyramids,
                            const SubdivisionMesh* limit = nullptr) {
    return {recipe.object_from_world, &pyramids, recipe.uv_sets, recipe.tolerance, limit};
}

/// The limit surface of the mesh for a surface that has to be made: one that is there, or that several
/// surfaces share.
const SubdivisionMesh* find_limit(const SurfaceRecipe& recipe, bool is_only, MeshLimits& limits) {
    if (!recipe.uv_sets.empty()) return nullptr;
    return is_only ? limits.find(recipe.mesh) : limits.find_or_make(recipe.mesh);
}

/// Makes the surfaces of one scene, of several meshes at once.
class SurfaceMaker {
  public:
    SurfaceMaker(const Scene& scene, const SameParts& same, SceneParts* before, const LevelFieldConfig& view,
                 MeshLimits& limits, std::vector<SurfaceRecipe>& recipes)
        : scene_(scene), same_(same), before_(before), view_(view), limits_(limits), recipes_(recipes) {
        if (!before) return;
        for (const Surface& surface : before->prepared.scene->surfaces)
            for (const DisplacementMap::Tile& tile : surface.map.tiles)
                pyramids_.keep(tile.texture, tile.pyramid);
    }

    /// `is_only`: no other surface is made of the mesh.
    Surface make(const SurfaceKey& key, bool is_only, SurfaceChange& change) {
        SurfaceRecipe& recipe = recipes_[change.surface];
        const Displacement* displacement =
            recipe.displacement == kNoIndex ? nullptr : &scene_.displacements[recipe.displacement];
        choose_tolerance(displacement, recipe);
        std::optional<Surface> kept = take(key, recipe);
        if (!kept) {
            change.is_replaced = true;
            return make_surface(scene_.meshes[recipe.mesh], displacement,
                                make_context(recipe, pyramids_, find_limit(recipe, is_only, limits_)));
        }
        kept->corner_tangents.clear();
        if (displacement) change_map(*displacement, recipe.object_from_world, *kept, change);
        return std::move(*kept);
    }

  private:
    /// The surface of a key before, if nothing but its map may differ.
    std::optional<Surface> take(const SurfaceKey& key, SurfaceRecipe& recipe) {
        const auto [mesh, displacement, object] = key;
        if (!before_ || !same_.meshes[mesh] || (displacement != kNoIndex && !same_.bases[displacement]))
            return std::nullopt;
        const auto found = before_->surfaces.find(same_.find_old(key));
        if (found == before_->surfaces.end()) return std::nullopt;
        Surface& surface = before_->prepared.scene->surfaces[found->second];
        if (surface.patch_count() == 0 || !has_uv_sets(surface, scene_.meshes[mesh], recipe.uv_sets))
            return std::nullopt;
        const BaseTolerance& made_with = before_->recipes[found->second].tolerance;
        if (!is_same_base(made_with, recipe.tolerance, surface.base_reserve)) return std::nullopt;
        // Faces are cut by what the map displaces them.
        if (is_subdivided_by_view(scene_.meshes[mesh]) && displacement != kNoIndex &&
            !is_same_map(make_displacement_map(scene_.displacements[displacement], recipe.object_from_world,
                                               pyramids_),
                         surface.map))
            return std::nullopt;
        recipe.tolerance = made_with;
        return std::exchange(surface, Surface{});
    }

    void choose_tolerance(const Displacement* displacement, SurfaceRecipe& recipe) {
        if (!is_subdivided_by_view(scene_.meshes[recipe.mesh])) return;
        if (displacement)
            recipe.reach = find_longest_displacement(
                make_displacement_map(*displacement, recipe.object_from_world, pyramids_));
        recipe.tolerance =
            choose_base_tolerance(scene_.meshes[recipe.mesh], recipe.places, recipe.reach, view_);
    }

    void change_map(const Displacement& displacement, const Affine& object_from_world, Surface& surface,
                    SurfaceChange& change) {
        DisplacementMap map = make_displacement_map(displacement, object_from_world, pyramids_);
        map.longest_axis = surface.map.longest_axis;
        map.neighbours = surface.map.neighbours;
        if (map.flip_v != surface.map.flip_v)
            for (TileNeighbours& beside : map.neighbours) std::swap(beside[2], beside[3]);
        if (!surface.derivatives.empty()) check_reach(displacement.name, map);
        if (!is_same_map(map, surface.map)) change.is_changed.assign(surface.patch_count(), 1);
        surface.map = std::move(map);
    }

    const Scene& scene_;
    const SameParts& same_;
    SceneParts* before_;
    const LevelFieldConfig& view_;
    MeshLimits& limits_;
    std::vector<SurfaceRecipe>& recipes_;
    PyramidCache pyramids_;
};

std::vector<SurfaceRecipe> make_recipes(const Scene& scene, const SurfaceList& list,
                                        const std::vector<Vec3f>& taken_off) {
    std::vector<SurfaceRecipe> recipes(list.numbers.size());
    for (const auto& [key, surface] : list.numbers) {
        SurfaceRecipe& recipe = recipes[surface];
        recipe.mesh = std::get<0>(key), recipe.displacement = std::get<1>(key);
        recipe.object_from_world = *invert(scene.objects[list.first_object[surface]].world_from_object);
        recipe.uv_sets = list.uv_sets[surface];
    }
    for (uint32_t k = 0; k < scene.objects.size(); ++k) {
        Affine place = scene.objects[k].world_from_object;
        place.translation = transform_point(place, taken_off[scene.objects[k].mesh]);
        recipes[list.numbers.at(make_key(scene, k))].places.push_back(place);
    }
    return recipes;
}

/// With the map of the surface before, which may have been edited.
Surface remake_surface(const SceneParts& parts, const SurfaceRecipe& recipe, const SubdivisionMesh* limit,
                       const Surface& before) {
    const Mesh& mesh = parts.meshes[recipe.mesh];
    PyramidCache pyramids;
    if (recipe.displacement == kNoIndex)
        return make_surface(mesh, nullptr, make_context(recipe, pyramids, limit));
    Displacement displacement = parts.displacements[recipe.displacement];
    // The images of the surface before are coefficients already.
    if (is_smooth(displacement.filter))
        displacement.filter = MapFilter::bspline, displacement.dequantize = false;
    for (size_t k = 0; k < before.map.tiles.size(); ++k) {
        displacement.tiles[k].texture = before.map.tiles[k].texture;
        pyramids.keep(before.map.tiles[k].texture, before.map.tiles[k].pyramid);
    }
    Surface surface = make_surface(mesh, &displacement, make_context(recipe, pyramids, limit));
    for (size_t k = 0; k < before.map.tiles.size(); ++k) surface.map.tiles[k].mips = before.map.tiles[k].mips;
    return surface;
}

} // namespace

SurfaceList list_surfaces(const Scene& scene, const std::vector<Material>& materials,
                          std::vector<Instance>& instances) {
    std::vector<std::vector<int>> of_material;
    for (const Material& material : materials) of_material.push_back(list_uv_sets(material));
    const auto default_material = uint32_t(materials.size()) - 1;
    SurfaceList list;
    for (uint32_t k = 0; k < scene.objects.size(); ++k) {
        const auto [place, is_new] =
            list.numbers.try_emplace(make_key(scene, k), uint32_t(list.first_object.size()));
        if (is_new) list.first_object.push_back(k), list.uv_sets.emplace_back();
        instances.push_back(make_instance(scene.objects[k], place->second, default_material));
        const uint32_t material = instances.back().material;
        add_uv_sets(of_material[material], list.uv_sets[place->second]);
        if (has_tiles(scene, scene.objects[k]) && !materials[material].textures.empty())
            add_uv_sets({kOwnUvSet}, list.uv_sets[place->second]);
    }
    return list;
}

std::vector<SurfaceChange> make_surfaces(Scene& scene, const SurfaceList& list, const SameParts& same,
                                         SceneParts* before, Polygonal polygons, MeshLimits& limits,
                                         SceneParts& parts) {
    std::vector<Surface>& surfaces = parts.prepared.scene->surfaces;
    std::vector<std::vector<SurfaceKey>> keys_of_mesh(scene.meshes.size());
    for (const auto& [key, surface] : list.numbers) keys_of_mesh[std::get<0>(key)].push_back(key);
    std::vector<SurfaceChange> changes(list.numbers.size());
    surfaces.resize(list.numbers.size());
    parts.recipes = make_recipes(scene, list, parts.taken_off);
    SurfaceMaker maker(scene, same, before, parts.prepared.scene->levels, limits, parts.recipes);
    std::vector<uint64_t> face_counts;
    for (const Mesh& mesh : scene.meshes) face_counts.push_back(mesh.face_sizes.size());
    ProgressCounter progress(find_progress(),
                             std::accumulate(face_counts.begin(), face_counts.end(), uint64_t(0)));
    parallel_for("make_surfaces", scene.meshes.size(), 1, [&](size_t begin, size_t end) {
        for (size_t mesh = begin; mesh < end; ++mesh) {
            const std::vector<SurfaceKey>& keys = keys_of_mesh[mesh];
            for (const SurfaceKey& key : keys) {
                const uint32_t surface = list.numbers.at(key);
                changes[surface].surface = surface;
                surfaces[surface] = maker.make(key, keys.size() == 1, changes[surface]);
            }
            limits.release(uint32_t(mesh));
            const bool is_kept = polygons == Polygonal::keep || (polygons == Polygonal::keep_for_views &&
                                                                 is_subdivided_by_view(scene.meshes[mesh]));
            if (!is_kept) release_mesh(scene, uint32_t(mesh));
            progress.add(face_counts[mesh]);
        }
    });
    return changes;
}

std::vector<uint32_t> follow_view(SceneParts& parts, const LevelFieldConfig& config) {
    std::vector<Surface>& surfaces = parts.prepared.scene->surfaces;
    std::vector<uint32_t> numbers;
    std::vector<SurfaceRecipe> recipes;
    for (uint32_t k = 0; k < surfaces.size(); ++k) {
        SurfaceRecipe recipe = parts.recipes[k];
        const Mesh& mesh = parts.meshes[recipe.mesh];
        if (!is_subdivided_by_view(mesh)) continue;
        BaseTolerance tolerance = choose_base_tolerance(mesh, recipe.places, recipe.reach, config);
        if (is_same_base(recipe.tolerance, tolerance, surfaces[k].base_reserve)) continue;
        recipe.tolerance = std::move(tolerance);
        numbers.push_back(k), recipes.push_back(std::move(recipe));
    }
    std::map<uint32_t, std::vector<size_t>> of_mesh;
    for (size_t k = 0; k < recipes.size(); ++k) of_mesh[recipes[k].mesh].push_back(k);
    const std::vector<std::pair<uint32_t, std::vector<size_t>>> meshes(of_mesh.begin(), of_mesh.end());
    MeshLimits limits(parts.meshes);
    std::vector<Surface> made(numbers.size());
    parallel_for("surfaces of another view", meshes.size(), 1, [&](size_t begin, size_t end) {
        for (size_t mesh = begin; mesh < end; ++mesh) {
            const std::vector<size_t>& places = meshes[mesh].second;
            for (const size_t k : places)
                made[k] =
                    remake_surface(parts, recipes[k], find_limit(recipes[k], places.size() == 1, limits),
                                   surfaces[numbers[k]]);
            limits.release(meshes[mesh].first);
        }
    });
    // All at the end, so that an error changes nothing.
    for (size_t k = 0; k < numbers.size(); ++k) {
        surfaces[numbers[k]] = std::move(made[k]);
        parts.recipes[numbers[k]] = std::move(recipes[k]);
    }
    parts.made_surfaces += numbers.size();
    return numbers;
}

} // namespace relief
