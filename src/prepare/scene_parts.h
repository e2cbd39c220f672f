// What a prepared scene was made of, kept so that the scene at another time takes over what is the same.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <tuple>
#include <vector>

#include "prepare/editable_scene.h"
#include "prepare/surface_change.h"
#include "prepare/surface_recipe.h"
#include "scene/left_out_mesh.h"

namespace relief {

/// Objects that share a surface: same mesh, same displacement, and for world-space maps the same object.
using SurfaceKey = std::tuple<uint32_t, uint32_t, uint32_t>;
using SurfaceNumbers = std::map<SurfaceKey, uint32_t>; ///< places in PreparedScene::surfaces

/// Nothing of it changes; what the prepared scene owns alone is moved out of it by the next one.
struct SceneParts {
    EditableScene prepared;
    std::vector<Mesh> meshes;                 ///< of the scene, as surfaces were made of them
    std::vector<Vec3f> taken_off;             ///< of the meshes, by move_meshes_to_origin()
    std::vector<Displacement> displacements;  ///< as they were given: keeps their images alive
    std::vector<std::vector<uint32_t>> users; ///< meshes of each displacement, rising
    std::vector<Material> materials;          ///< as they were given
    SurfaceNumbers surfaces;
    std::vector<SurfaceRecipe> recipes; ///< per surface
    uint64_t made_surfaces = 0;         ///< from meshes, of this scene and all before it
    bool has_old_numbers = true;        ///< as SameParts::has_old_numbers(), of this scene and the one before
};

/// Which parts of a scene are those that were there before: a byte each.
struct SameParts {
    std::vector<uint8_t> meshes;
    std::vector<uint8_t> images; ///< of displacements: all that PreparedScene::maps and mips are made of
    std::vector<uint8_t> bases;  ///< of displacements: all that surfaces are made of but the map
    /// Numbers of the meshes and displacements before that have the same names; kNoIndex: there was none.
    std::vector<uint32_t> old_meshes, old_displacements;
    bool materials = false;

    /// The key before of the same mesh and displacement.
    SurfaceKey find_old(const SurfaceKey& key) const;
    /// Whether meshes and displacements that were there before have the numbers that they had.
    bool has_old_numbers() const;
};

/// Puts meshes that were left out back into the scene. Throws Error{usage} for one that was not there before
/// under that name, or without names under that number. `before` null: nothing is the same.
SameParts find_same_parts(Scene& scene, SceneParts* before);

/// What becomes of the polygons of meshes once surfaces are made: freed, kept where another view may ask for
/// a finer subdivision, or kept.
enum class Polygonal { free, keep_for_views, keep };

/// After an error: what was moved out of `before`, to `scene` and `next`, goes back, so that
/// prepare_next_scene() can begin again. Maps of surfaces, and what depends on the view, may be those of the
/// scene that failed.
void give_back(Scene& scene, SceneParts& next, SceneParts& before);

/// As prepare_scene(). With `keep`, prepare_next_scene() can take over from the result, unless surfaces are
/// tessellated.
SceneParts prepare_scene_parts(Scene scene, const RenderSettings& settings, SceneOrigin origin,
                               Polygonal polygons);

/// The scene at another time, in which meshes may be left out, in the place of the prepared one before: what
/// comes of it is what prepare_scene_parts() makes of a whole one. What has changed, one a surface; nullopt:
/// there are other surfaces. Throws as prepare_scene(); then `parts` serves for another call alone, and no
/// rays may be traced in its scene.
std::optional<std::vector<SurfaceChange>> prepare_next_scene(Scene scene, const RenderSettings& settings,
                                                             SceneParts& parts);

/// As SceneParts::users.
std::vector<std::vector<uint32_t>> list_users(const Scene& scene);

} // namespace relief
