// load_mesh_scene: a camera that shows the whole object, a material and a light, for a mesh that comes alone.

#include <fmt/format.h>

#include "io/mesh/up_axis.h"
#include "io/scene/asset_cache.h"
#include "io/scene/displacement_reader.h"
#include "io/scene/frame_scene.h"
#include "io/scene/place_sky.h"
#include "io/scene/scene_content.h"
#include "io/scene/studio.h"
#include "math/affine.h"
#include "math/vec.h"
#include "relief/error.h"
#include "relief/io.h"
#include "scene/words.h"

namespace relief {

namespace {

void add_image_light(Scene& scene, std::shared_ptr<const Texture> sky, const Vec3f& view) {
    const SkyPlacement placement = place_sky(*sky, view);
    Environment environment;
    environment.strength = placement.strength, environment.rotate_degrees = placement.rotate_degrees;
    environment.texture = std::move(sky);
    scene.environment = std::move(environment);
}

void add_map(Scene& scene, const MeshSceneOptions& options, AssetCache& assets) {
    const Mesh& mesh = scene.meshes.front();
    if (mesh.uv_indices.empty())
        throw Error(ErrorKind::bad_input, {"the mesh has no uvs, which its displacement map needs",
                                           mesh.source, "export the mesh with texture coordinates"});
    DisplacementRequest request;
    request.name = options.displacement_map.stem().string();
    request.file = std::filesystem::absolute(options.displacement_map).string();
    request.options = options.map;
    scene.displacements.push_back(make_displacement(request, assets));
    scene.objects.front().displacement = 0;
}

uint64_t compute_hash(const Scene& scene, const MeshSceneOptions& options) {
    ContentHash hash;
    const MapOptions& map = options.map;
    hash.add(map.preset);
    for (const std::optional<std::string>& text :
         {map.type, map.space, map.axes, map.frame, map.lengths, map.encoding, map.wrap, map.filter})
        hash.add(text.value_or("-"));
    for (const std::optional<Vec3f>& value : {map.midlevel, map.scale})
        hash.add(value ? fmt::format("{} {} {}", value->x, value->y, value->z) : std::string("-"));
    for (const bool value : {map.flip_v, map.dilate, map.autobump}) hash.add(value ? "yes" : "no");
    if (map.dequantize) hash.add(std::string("dequantize"));
    add_scene_content(hash, scene);
    return hash.value();
}

void add_clay(Scene& scene) {
    Material clay;
    clay.name = "clay";
    clay.base_color = {0.73f, 0.62f, 0.52f};
    clay.roughness = 0.5f, clay.ior = 1.4f;
    scene.objects.front().material = uint32_t(scene.materials.size());
    scene.materials.push_back(clay);
}

/// One object of clay; not framed and not lit yet.
Scene make_clay_scene(Mesh mesh) {
    Scene scene;
    scene.source = mesh.source;
    scene.meshes.push_back(std::move(mesh));
    Object object;
    object.name = scene.meshes.front().name;
    scene.objects.push_back(object);
    add_clay(scene);
    return scene;
}

/// Sets the camera; returns the way from the object to it.
Vec3f place_camera(Scene& scene) {
    validate_scene(scene); // framing follows the indices of the mesh and the uvs into the map
    const Vec3f view = choose_view(scene, View::automatic);
    scene.camera = frame_scene(scene, Camera{}, view, 1, Framing::still);
    return view;
}

Mesh make_map_plane() {
    Mesh plane;
    plane.name = "plane";
    plane.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    plane.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    plane.face_sizes = {4};
    plane.position_indices = plane.uv_indices = {0, 1, 2, 3};
    return plane;
}

} // namespace

Scene load_mesh_scene(const std::filesystem::path& mesh, const MeshSceneOptions& options) {
    AssetCache assets("");
    Scene scene = make_clay_scene(load_mesh(mesh, {.reader = options.reader}, assets.warnings()));
    Subdivision& subdivision = scene.meshes.front().subdivision;
    if (options.subdivision) subdivision.scheme = parse_word<SubdivisionScheme>(*options.subdivision);
    if (options.subdivision_level) subdivision.level = *options.subdivision_level;
    scene.meshes.front().weld = options.weld;
    if (options.up != UpAxis::y)
        scene.objects.front().world_from_object = make_rotation_degrees(get_upright_turn(options.up));
    if (!options.displacement_map.empty()) add_map(scene, options, assets);
    const Vec3f view = place_camera(scene);
    if (options.environment.empty()) {
        enter_studio(scene);
    } else {
        add_image_light(scene, assets.load(options.environment.string(), TextureUse::radiance), view);
    }
    scene.warnings = std::move(assets.warnings());
    validate_scene(scene);
    scene.hash = compute_hash(scene, options);
    return scene;
}

void complete_mesh_scene(Scene& scene) {
    validate_scene(scene);
    if (scene.objects.size() != 1)
        throw Error(ErrorKind::usage, {fmt::format("{} objects: one is needed", scene.objects.size()),
                                       scene.source, "give a mesh alone"});
    const Vec3f view = place_camera(scene);
    if (scene.objects.front().material == kNoIndex) add_clay(scene);
    scene.lights.clear();
    if (scene.environment && scene.environment->texture)
        add_image_light(scene, scene.environment->texture, view);
    else
        enter_studio(scene);
}

Scene make_mesh_scene(Mesh mesh, const Displacement* map) {
    Scene scene = make_clay_scene(std::move(mesh));
    if (map) {
        scene.displacements.push_back(*map);
        scene.objects.front().displacement = 0;
    }
    place_camera(scene);
    enter_studio(scene);
    validate_scene(scene);
    return scene;
}

Scene make_map_scene(const Displacement& map) { return make_mesh_scene(make_map_plane(), &map); }

} // namespace relief
