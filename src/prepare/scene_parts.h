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
};

/// Whether a mesh is left out because it is as before (SceneUpdate::scene).
inline bool is_left_out(const Mesh& mesh) { return mesh.positions.empty() && mesh.face_sizes.empty(); }

/// Which parts of a scene are those that were there before: a byte each.
struct SameParts {
    std::vector<uint8_t> meshes;
    std::vector<uint8_t> images; ///< of displacements: all that PreparedScene::maps and mips are made of
    std::vector<uint8_t> bases;  ///< of displacements: all that surfaces are made of but the map
    bool materials = false;
};

/// Puts meshes that were left out back into the scene. Throws Error{usage} for one that was not there before
/// under that number and name. `before` null: nothing is the same.
SameParts find_same_parts(Scene& scene, SceneParts* before);

/// What becomes of the polygons of meshes once surfaces are made: freed, kept where another view may ask for
/// a finer subdivision, or kept.
enum class Polygonal { free, keep_for_views, keep };

/// As prepare_scene(). With `keep`, prepare_next_scene() can take over from the result, unless surfaces are
/// tessellated.
SceneParts prepare_scene_parts(Scene scene, const RenderSettings& settings, SceneOrigin origin,
                               Polygonal polygons);

/// The scene at another time, in which meshes may be left out, in the place of the prepared one before: what
/// comes of it is what prepare_scene_parts() makes of a whole one. What has changed, one a surface; nullopt:
/// there are other surfaces. Throws as prepare_scene(); `parts` is then not to be used again.
std::optional<std::vector<SurfaceChange>> prepare_next_scene(Scene scene, const RenderSettings& settings,
                                                             SceneParts& parts);

/// As SceneParts::users.
std::vector<std::vector<uint32_t>> list_users(const Scene& scene);

} // namespace relief
