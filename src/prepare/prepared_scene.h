// The scene as engines see it: surfaces, instances with their levels, materials, lights. Engines and all
// others hold it const; a SceneEditor (prepare/scene_edit.h) may change one that it made, between pictures.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "math/affine.h"
#include "prepare/light_groups.h"
#include "prepare/light_links.h"
#include "prepare/material_glass.h"
#include "prepare/material_layers.h"
#include "prepare/textured_materials.h"
#include "relief/render.h"
#include "relief/scene.h"
#include "surface/map/gutter.h"
#include "surface/map/mip_chain.h"
#include "surface/map/spline_coefficients.h"
#include "surface/patch/level_field.h"
#include "surface/patch/surface.h"

namespace relief {

/// The way from the world into the space of an object.
struct ObjectSpace {
    Vec3f origin{}; ///< what places are measured from first, world space: 0 but for objects that lie far away
    Affine from_origin; ///< of what is left then; its linear part is the inverse of world_from_object's

    Vec3f place(const Vec3f& p_world) const { return transform_point(from_origin, p_world - origin); }
};

/// One placed surface.
struct Instance {
    uint32_t surface = 0;  ///< index into PreparedScene::surfaces
    uint32_t material = 0; ///< index into PreparedScene::materials
    Affine world_from_object;
    ObjectSpace object_space;
    float reach = 0; ///< of the displaced surface from the object's origin, world space
    uint32_t visibility_mask = kVisibleToAll; ///< of the object
    bool is_mirrored = false;                 ///< negative determinant: the winding is turned
    bool is_in_place = false;                 ///< object space is world space
    bool is_shadow_catcher = false;           ///< of the object
    std::shared_ptr<const LevelField> levels;
    std::shared_ptr<const std::vector<PatchLines>> lines; ///< of levels to come; null: not measured
};

/// One image of a displacement, as the surfaces that use it read it.
struct PreparedMap {
    std::string displacement;
    int udim = 1001;
    std::shared_ptr<const Texture> texture; ///< null: no editor needs it, or no object uses it
    GutterFill gutter;                      ///< worked into the texture already
    std::shared_ptr<const MipChain> mips;   ///< of that texture; null: not filtered
    std::shared_ptr<const Texture>
        coefficients;             ///< of a smooth filter, in place of the texture; null: that itself
    SplineForm form;              ///< what they are
    TileNeighbours neighbours{};  ///< of a tile whose coefficients depend on other tiles of its displacement
    bool has_neighbours = false;  ///< whether it is such a tile
    bool is_flipped = false;      ///< Displacement::flip_v
    const void* source = nullptr; ///< names the scene's image; those of one image may hold different copies
};

/// Triangles that let light through which comes from above the smooth surface that they stand for
/// (formulas/terminator.h): polygons with normals; displaced patches too, with `bases` because they are flat
/// while their normals are not, with `all` also because their triangles are as large as a fixed level or, on
/// flat patches, few texels make them. Other triangles of automatic levels are as small as pixels.
enum class Terminators : uint32_t { none, polygons, bases, all };

struct PreparedScene {
    std::vector<Surface>
        surfaces; ///< one a used (mesh, displacement) pair; one an object for world-space maps
    std::vector<Instance> instances;  ///< in the order of Scene::objects
    std::vector<PreparedMap> maps;    ///< of all displacements
    std::vector<Material> materials;  ///< the last one is the default material; all of base_weight 1
    bool has_cut_outs = false;        ///< some material is a cut-out or a clear wall
    bool has_normal_maps = false;     ///< some material has one
    bool has_anisotropy = false;      ///< the roughness of some material has a direction
    bool has_shadow_catchers = false; ///< some instance is one
    Terminators terminators = Terminators::none;
    TexturedMaterials textured; ///< of the materials
    MaterialLayers layers;      ///< of the materials
    MaterialGlass glass;        ///< of the materials
    std::vector<Light> lights;
    LightLinks links; ///< of the lights
    std::optional<Environment> environment;
    LightGroups light_groups; ///< of layers that the picture has
    Camera camera;
    uint32_t mesh_count = 0;      ///< of the scene
    int width = 0, height = 0;    ///< of the whole picture
    bool has_far_objects = false; ///< so far from the world's origin that shadows would lose digits
    Vec3f origin{}; ///< world space is measured from here, camera and lights included: SceneOrigin::camera
    LevelFieldConfig levels;         ///< what the instances' levels were computed with
    bool may_enclose_camera = false; ///< see prepare/camera_enclosure.h
    std::vector<std::string> warnings;
};

/// Makes the tangents of surfaces that normal maps or materials with a direction are on.
void add_tangents(PreparedScene& prepared);

/// Chooses the copies of maps that the surfaces read, by the levels of their instances.
std::vector<uint32_t> choose_scene_mips(const PreparedScene& scene, uint32_t surface);

/// What world space is measured from. camera: from there, if an object lies so far away from the origin that
/// its shadows would lose digits; for pictures, whose rays all start at the camera or at what it sees. given:
/// from PreparedScene::origin, that of an earlier time of the scene.
enum class SceneOrigin { world, camera, given };

/// The one way from a scene to a prepared one: validates, makes surfaces in parallel, computes levels, lists
/// warnings; meshes are freed as used. Throws bad_input, out_of_memory for a tessellation.
std::shared_ptr<const PreparedScene> prepare_scene(Scene scene, const RenderSettings& settings,
                                                   SceneOrigin origin = SceneOrigin::world);

} // namespace relief
