// validate_scene: every index, range and number of a scene, before anything is built from it.
#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <span>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "base/suggest.h"
#include "image/texel_layout.h"
#include "math/affine.h"
#include "math/box.h"
#include "relief/error.h"
#include "relief/material_inputs.h"
#include "relief/scene.h"
#include "scene/check_input_textures.h"
#include "scene/coordinate_limit.h"
#include "scene/displacement_conventions.h"
#include "scene/left_out_mesh.h"
#include "scene/object_names.h"
#include "scene/uv_sets.h"

namespace relief {

namespace {

[[noreturn]] void fail(const std::string& where, const std::string& message, const std::string& hint = {}) {
    throw Error(ErrorKind::bad_input, {message, where, hint});
}

std::string describe(const char* kind, const std::string& name, size_t index) {
    return name.empty() ? fmt::format("{} {}", kind, index) : fmt::format("{} '{}'", kind, name);
}

std::string describe_mesh(const Mesh& mesh, size_t index) {
    const std::string name = describe("mesh", mesh.name, index);
    return mesh.source.empty() ? name : name + " (" + mesh.source + ")";
}

void check_range(const std::string& where, const char* what, float value, float low, float high) {
    if (!(value >= low && value <= high))
        fail(where, fmt::format("{} is {}, not in [{}, {}]", what, value, low, high));
}

void check_range(const std::string& where, const char* what, const Vec3f& value, float low, float high) {
    check_range(where, what, value.x, low, high);
    check_range(where, what, value.y, low, high);
    check_range(where, what, value.z, low, high);
}

void check_light_group(const std::string& where, const std::string& name) {
    if (!name.empty() && !is_light_group_name(name))
        fail(where, fmt::format("'{}' is no name of a light group", name),
             fmt::format("1 to {} letters, digits, '_' and '-'", kMaxLightGroupName));
}

constexpr float kHuge = 3e38f;

float largest_component(const Vec3f& v) { return std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)}); }

void check_indices(const std::string& where, const char* what, const std::vector<uint32_t>& indices,
                   size_t corners, size_t count) {
    if (indices.size() != corners)
        fail(where, fmt::format("has {} {} indices for {} corners", indices.size(), what, corners));
    for (size_t i = 0; i < indices.size(); ++i) {
        if (indices[i] >= count)
            fail(where,
                 fmt::format("{} index {} of corner {} is out of range: there are {}", what, indices[i], i,
                             count),
                 "the mesh is damaged: export it again");
    }
}

/// A face has a uv at each of its corners, or at none of them.
void check_uv_indices(const std::string& where, const Mesh& mesh, size_t corners,
                      const std::vector<uint32_t>& uv_indices, size_t uv_count) {
    if (uv_indices.size() != corners) {
        check_indices(where, "uv", uv_indices, corners, uv_count);
        return;
    }
    bool has_uvs = false;
    size_t first = 0;
    for (size_t face = 0; face < mesh.face_sizes.size(); first += mesh.face_sizes[face], ++face) {
        const std::span<const uint32_t> indices(uv_indices.data() + first, mesh.face_sizes[face]);
        const auto missing = size_t(std::count(indices.begin(), indices.end(), kNoIndex));
        if (missing != 0 && missing != indices.size())
            fail(where, fmt::format("face {} has {} uvs for {} corners", face, indices.size() - missing,
                                    indices.size()));
        has_uvs = has_uvs || missing == 0;
        for (size_t k = 0; missing == 0 && k < indices.size(); ++k)
            if (indices[k] >= uv_count)
                fail(where,
                     fmt::format("uv index {} of corner {} is out of range: there are {}", indices[k],
                                 first + k, uv_count),
                     "the mesh is damaged: export it again");
    }
    if (!has_uvs) fail(where, "has uv indices, but no face has uvs", "leave them out");
}

void check_uvs(const std::string& where, const std::vector<Vec2f>& uvs) {
    for (size_t i = 0; i < uvs.size(); ++i)
        if (!std::isfinite(uvs[i].x) || !std::isfinite(uvs[i].y))
            fail(where, fmt::format("uv {} is not finite", i));
}

void check_further_uvs(const std::string& where, const Mesh& mesh, size_t corners) {
    std::set<int> numbers{mesh.uv_set};
    if (mesh.uv_set < 0 || mesh.uv_set > kMaxUvSet)
        fail(where, fmt::format("the number of its uv set is {}, not in [0, {}]", mesh.uv_set, kMaxUvSet));
    for (const UvSet& set : mesh.further_uvs) {
        const std::string place = fmt::format("{}, uv set {}", where, set.number);
        if (set.number < 0 || set.number > kMaxUvSet)
            fail(place, fmt::format("the number is not in [0, {}]", kMaxUvSet));
        if (!numbers.insert(set.number).second)
            fail(place, "there are two sets of this number", "uv_set is the number of the mesh's own");
        check_uv_indices(place, mesh, corners, set.indices, set.uvs.size());
        check_uvs(place, set.uvs);
    }
}

} // namespace

void validate_mesh(const Mesh& mesh, size_t index) {
    const std::string where = describe_mesh(mesh, index);
    size_t corners = 0;
    for (size_t f = 0; f < mesh.face_sizes.size(); ++f) {
        if (mesh.face_sizes[f] < 3) fail(where, fmt::format("face {} has {} corners", f, mesh.face_sizes[f]));
        corners += mesh.face_sizes[f];
    }
    if (mesh.face_sizes.empty()) fail(where, "has no faces");
    check_indices(where, "position", mesh.position_indices, corners, mesh.positions.size());
    if (!mesh.uv_indices.empty()) check_uv_indices(where, mesh, corners, mesh.uv_indices, mesh.uvs.size());
    if (!mesh.normal_indices.empty())
        check_indices(where, "normal", mesh.normal_indices, corners, mesh.normals.size());
    if (!mesh.tangents.empty() && mesh.tangents.size() != corners)
        fail(where, fmt::format("has {} tangents for {} corners", mesh.tangents.size(), corners));
    for (size_t i = 0; i < mesh.tangents.size(); ++i)
        for (const float component : mesh.tangents[i])
            if (!std::isfinite(component)) fail(where, fmt::format("tangent {} is not finite", i));
    for (size_t i = 0; i < mesh.positions.size(); ++i) {
        if (!is_finite(mesh.positions[i])) fail(where, fmt::format("position {} is not finite", i));
        if (largest_component(mesh.positions[i]) > kLargestCoordinate)
            fail(where, fmt::format("position {} is farther out than {:g}", i, kLargestCoordinate),
                 "use another unit of length");
    }
    check_uvs(where, mesh.uvs);
    check_further_uvs(where, mesh, corners);
    for (size_t i = 0; i < mesh.normals.size(); ++i)
        if (!is_finite(mesh.normals[i])) fail(where, fmt::format("normal {} is not finite", i));
    if (mesh.weld && !(std::isfinite(*mesh.weld) && *mesh.weld >= 0))
        fail(where, fmt::format("weld is {}", *mesh.weld), "it is a distance of 0 or more");
    const int level = mesh.subdivision.level;
    if (level != kAutoSubdivisionLevel && (level < 0 || level > kMaxSubdivisionLevel))
        fail(where, fmt::format("subdivision level {} is neither automatic nor in [0, {}]", level,
                                kMaxSubdivisionLevel));
    for (size_t i = 0; i < mesh.creases.size(); ++i) {
        const Crease& crease = mesh.creases[i];
        if (crease.first >= mesh.positions.size() || crease.second >= mesh.positions.size())
            fail(where, fmt::format("crease {} from point {} to {} is out of range: there are {}", i,
                                    crease.first, crease.second, mesh.positions.size()));
        if (!(crease.sharpness >= 0))
            fail(where, fmt::format("crease {} has sharpness {}", i, crease.sharpness),
                 "it must be 0 or more");
    }
}

namespace {

void check_texture(const std::string& where, const Texture& texture) {
    constexpr uint32_t kMaxSide = kMaxPictureSize;
    if (texture.width == 0 || texture.height == 0 || texture.width > kMaxSide || texture.height > kMaxSide)
        fail(where, fmt::format("texture of {} x {} texels", texture.width, texture.height),
             fmt::format("each side must be in [1, {}]", kMaxSide));
    if (!is_complete(texture))
        fail(where, "texture holds another number of texels than its size and its stride say");
}

void check_frame(const std::string& where, const Displacement& map) {
    if (uint32_t(map.frame) > uint32_t(FrameKind::file)) fail(where, "frame is none of mikk, dpdu and file");
    if (uint32_t(map.lengths) > uint32_t(FrameLengths::relative))
        fail(where, "lengths are neither absolute nor relative");
    const bool uses_tangents =
        map.type == DisplacementType::vector && map.space == DisplacementSpace::tangent;
    if (uses_tangents && map.frame == FrameKind::file && map.lengths == FrameLengths::relative)
        fail(where, "the file's tangents have no lengths for relative ones",
             "use lengths absolute, or frame mikk or dpdu");
}

void check_displacement(const Displacement& map, size_t index) {
    const std::string where = describe("displacement", map.name, index);
    const size_t most_tiles = map.is_udim ? size_t(kMaxMapTiles) : 1;
    if (map.tiles.empty() || map.tiles.size() > most_tiles)
        fail(where, fmt::format("has {} tiles, not 1 to {}", map.tiles.size(), most_tiles));
    for (const MapTile& tile : map.tiles) {
        if (!tile.texture) fail(where, fmt::format("tile {} has no texture", tile.udim));
        if (tile.udim < 1001) fail(where, fmt::format("tile number {} is below 1001", tile.udim));
        check_texture(fmt::format("{}, tile {}", where, tile.udim), *tile.texture);
    }
    uint32_t used = 0;
    for (size_t c = 0; c < 3; ++c) {
        if (map.axes.axis[c] < 3) used |= 1u << map.axes.axis[c];
        if (map.axes.sign[c] != 1 && map.axes.sign[c] != -1)
            fail(where, "axes have a sign other than 1 and -1");
    }
    if (used != 7) fail(where, "axes are no permutation");
    if (map.type > DisplacementType::height || map.space > DisplacementSpace::world ||
        map.wrap > WrapMode::black || map.filter > MapFilter::bspline)
        fail(where, "type, space, wrap or filter is none of those there are");
    check_dequantize(map);
    check_frame(where, map);
    check_range(where, "midlevel", map.midlevel, -kHuge, kHuge);
    check_range(where, "scale", map.scale, -kHuge, kHuge);
}

/// Checks the ranges of numbers and colours.
void check_inputs(const Material& material, const std::string& where) {
    for (const MaterialInputKind& kind : list_material_fields()) {
        if (kind.number) check_range(where, kind.short_name(), material.*kind.number, kind.low, kind.high);
        const float high = kind.is_emission() ? kUnboundedInput : kind.high; // the member is the product
        if (kind.is_color()) check_range(where, kind.short_name(), material.*kind.color, kind.low, high);
    }
}

void check_glass(const Material& material, const std::string& where) {
    if (!(material.transmission_weight > 0)) return;
    if (material.coat_weight > 0 || material.fuzz_weight > 0)
        fail(where,
             fmt::format("transmission_weight and {} exclude each other",
                         material.coat_weight > 0 ? "coat_weight" : "fuzz_weight"),
             "glass has neither coat nor fuzz here; give one of the two another material");
    if (is_clear_wall(material) && !(material.emission == Vec3f{}))
        fail(
            where,
            "a thin wall that rays pass straight through cannot emit light: transmission_weight and emission "
            "exclude each other",
            fmt::format("a roughness above {:g} makes it a wall that rays end on", kClearRoughness));
}

void check_material(const Material& material, size_t index) {
    const std::string where = describe("material", material.name, index);
    check_inputs(material, where);
    check_light_group(where, material.light_group);
    if (is_cut_out(material) && !(material.emission == Vec3f{}))
        fail(where,
             "a surface that emits light cannot be a cut-out: opacity and emission exclude each other");
    check_glass(material, where);
    check_range(where, "scale of normal_texture", material.normal_scale, 0, kMaxNormalScale);
    check_input_textures(material, where);
    visit_textures(material, [&](const char* name, const auto& texture, MapFilter) {
        if (texture) check_texture(fmt::format("{}, {}", where, name), *texture);
    });
}

/// Largest coordinate of a transformed box, in double precision: it may be beyond all floats.
double find_farthest(const Affine& m, const Box& box) {
    double farthest = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3f p{corner & 1 ? box.upper.x : box.lower.x, corner & 2 ? box.upper.y : box.lower.y,
                      corner & 4 ? box.upper.z : box.lower.z};
        const double offsets[] = {m.translation.x, m.translation.y, m.translation.z};
        for (size_t r = 0; r < 3; ++r) {
            const Vec3f& row = m.rows[r];
            const double sum = double(row.x) * p.x + double(row.y) * p.y + double(row.z) * p.z + offsets[r];
            farthest = std::max(farthest, std::fabs(sum));
        }
    }
    return farthest;
}

/// What makes a material need tangents; null: nothing.
const char* find_tangent_input(const Material& material) {
    if (has_normal_map(material)) return "normal_texture";
    if (material.specular_roughness_anisotropy > 0) return "specular_roughness_anisotropy";
    return is_anisotropic(material) ? "coat_roughness_anisotropy" : nullptr;
}

/// The mesh has the uv sets that textures of the material lie on.
void check_uv_sets(const std::string& where, const Mesh& mesh, size_t mesh_index, const Material& material) {
    for (const InputTexture& texture : material.textures)
        if (texture.uv_set != kOwnUvSet && !has_uv_set(mesh, texture.uv_set))
            fail(where,
                 fmt::format("the {} of its material '{}' lies on uv set {}, and {} has {}",
                             get_input_name(texture.input), material.name, texture.uv_set,
                             describe_mesh(mesh, mesh_index), describe_uv_sets(mesh)),
                 "sets count from 0, as TEXCOORD_0 of glTF does: name another, or export the mesh with it");
}

void check_object(const Scene& scene, const std::vector<Box>& mesh_boxes, const Object& object,
                  size_t index) {
    const std::string where = describe("object", object.name, index);
    if (object.mesh >= scene.meshes.size()) fail(where, fmt::format("mesh {} does not exist", object.mesh));
    if (object.displacement != kNoIndex && object.displacement >= scene.displacements.size())
        fail(where, fmt::format("displacement {} does not exist", object.displacement));
    if (object.material != kNoIndex && object.material >= scene.materials.size())
        fail(where, fmt::format("material {} does not exist", object.material));
    if (!invert(object.world_from_object))
        fail(where, "the transform is singular or not finite", "no scale factor may be 0");
    if (find_farthest(object.world_from_object, mesh_boxes[object.mesh]) > kLargestCoordinate)
        fail(where, fmt::format("the transform carries it farther out than {:g}", kLargestCoordinate),
             "use a smaller scale or translation");
    const Mesh& mesh = scene.meshes[object.mesh];
    if (is_left_out(mesh)) return;
    if (object.displacement != kNoIndex && mesh.uv_indices.empty())
        fail(where,
             fmt::format("{} has no uvs, which its displacement needs",
                         describe("mesh", mesh.name, object.mesh)),
             "export the mesh with texture coordinates");
    if (object.material == kNoIndex) return;
    check_uv_sets(where, mesh, object.mesh, scene.materials[object.material]);
    if (!mesh.uv_indices.empty()) return;
    if (const char* input = find_tangent_input(scene.materials[object.material]))
        fail(where,
             fmt::format("{} has no uvs, which the {} of its material needs",
                         describe("mesh", mesh.name, object.mesh), input),
             "export the mesh with texture coordinates");
}

/// Squares of lengths from here to kLargestCoordinate are floats without loss.
constexpr float kSmallestFace = 1e-18f;

void check_face(const std::string& where, const char* what, float value) {
    if (!(value >= kSmallestFace && value <= kLargestCoordinate))
        fail(where, fmt::format("{} is {}, not in [{}, {}]", what, value, kSmallestFace, kLargestCoordinate),
             fmt::format("a light of this type needs a {} above 0", what));
}

void check_placed_light(const std::string& where, const Light& light) {
    check_range(where, "position", light.position, -kHuge, kHuge);
    if (light.type == LightType::disk)
        check_face(where, "radius", light.radius);
    else if (light.type != LightType::rectangle)
        check_range(where, "radius", light.radius, 0, kHuge);
    if (light.type == LightType::rectangle || light.color_texture)
        if (!is_finite(light.up) || length(normalize(light.up)) == 0)
            fail(where, "up has no length or is not finite");
    if (light.type == LightType::rectangle) {
        check_face(where, "width", light.width);
        check_face(where, "height", light.height);
    }
    if (light.type == LightType::spot) {
        if (!(light.cone_degrees > 0 && light.cone_degrees <= 180))
            fail(where, fmt::format("the angle of its cone is {}, not in (0, 180]", light.cone_degrees));
        check_range(where, "blend", light.blend, 0, 1);
    }
}

bool has_extent(const Light& light) {
    if (light.type == LightType::sun) return light.angle_degrees > 0;
    return light.type == LightType::rectangle || light.radius > 0;
}

void check_light(const Light& light, size_t index) {
    const std::string where = fmt::format("light {}", index);
    if (light.type < LightType::sun || light.type > LightType::spot)
        fail(where, fmt::format("type {} is none of LightType", int(light.type)));
    check_range(where, "color", light.color, 0, kHuge);
    check_range(where, "strength", light.strength, 0, kHuge);
    check_light_group(where, light.light_group);
    if (light.type != LightType::point &&
        (!is_finite(light.direction) || length(normalize(light.direction)) == 0))
        fail(where, "direction has no length or is not finite");
    if (light.type == LightType::sun)
        check_range(where, "angle_degrees", light.angle_degrees, 0, 90);
    else
        check_placed_light(where, light);
    const bool is_flat = light.type == LightType::rectangle || light.type == LightType::disk;
    if (light.color_texture && !is_flat)
        fail(where, "has a texture, which only rectangles and disks show", "leave color_texture out");
    if (light.color_texture) check_texture(where + ", color_texture", *light.color_texture);
    if (light.is_visible_to_camera && !has_extent(light))
        fail(where, "visible_to_camera is true, but a light without extent cannot be seen",
             light.type == LightType::sun ? "give it angle_degrees above 0" : "give it a radius");
}

/// Lights name objects that there are.
void check_links(const Scene& scene) {
    std::set<std::string, std::less<>> names;
    if (std::ranges::any_of(scene.lights, is_linked))
        for (const Object& object : scene.objects) names.insert(name_object(scene, object));
    for (size_t i = 0; i < scene.lights.size(); ++i)
        for (const auto& [key, linked] : {std::pair("light_link_includes", &Light::link_includes),
                                          std::pair("light_link_excludes", &Light::link_excludes)})
            for (const std::string& name : scene.lights[i].*linked) {
                if (names.contains(name)) continue;
                const std::vector<std::string_view> known(names.begin(), names.end());
                fail(fmt::format("light {}", i), fmt::format("{} names no object: '{}'", key, name),
                     suggest_word(name, known));
            }
}

void check_picture(const PictureDefaults& picture) {
    const auto check = [](const char* what, const std::optional<int>& value, int low, int high) {
        if (value && (*value < low || *value > high))
            fail("render", fmt::format("{} is {}, not in [{}, {}]", what, *value, low, high));
    };
    check("width", picture.width, 1, kMaxPictureSize);
    check("height", picture.height, 1, kMaxPictureSize);
    check("spp", picture.spp, 1, kMaxSamples);
    check("bounces", picture.bounces, 0, kMaxBounces);
    if (picture.fps && !(*picture.fps > 0 && *picture.fps <= kHuge))
        fail("render", fmt::format("fps is {}, not above 0", *picture.fps));
}

} // namespace

void validate_camera(const Camera& camera) {
    const std::string where = "camera";
    if (!is_finite(camera.from) || !is_finite(camera.to) || !is_finite(camera.up))
        fail(where, "is not finite");
    const Vec3f axis = normalize(camera.to - camera.from);
    if (length(axis) == 0) fail(where, "'from' and 'to' are the same point");
    if (length(cross(axis, normalize(camera.up))) < 1e-5f)
        fail(where, "'up' has no length or points along the view", "use another 'up', for example [0, 0, 1]");
    if (!(camera.fov_degrees > 0 && camera.fov_degrees < 180))
        fail(where, fmt::format("fov_degrees is {}, not in (0, 180)", camera.fov_degrees));
    check_range(where, "aperture_radius", camera.aperture_radius, 0, kHuge);
    if (!(camera.focus_distance > 0 && camera.focus_distance <= kHuge))
        fail(where, fmt::format("focus_distance is {}, not above 0", camera.focus_distance));
    check_range(where, "shift", camera.shift.x, -kMaxLensShift, kMaxLensShift);
    check_range(where, "shift", camera.shift.y, -kMaxLensShift, kMaxLensShift);
    for (const float end : {camera.shutter_open, camera.shutter_close})
        check_range(where, "shutter", end, -kMaxShutter, kMaxShutter);
    if (camera.shutter_open > camera.shutter_close)
        fail(where, fmt::format("the shutter opens at {} and closes before that, at {}", camera.shutter_open,
                                camera.shutter_close));
}

void validate_scene(const Scene& scene) {
    for (size_t i = 0; i < scene.meshes.size(); ++i)
        if (is_left_out(scene.meshes[i])) validate_mesh(scene.meshes[i], i);
    validate_without_left_out(scene);
}

void validate_without_left_out(const Scene& scene) {
    for (size_t i = 0; i < scene.meshes.size(); ++i)
        if (!is_left_out(scene.meshes[i])) validate_mesh(scene.meshes[i], i);
    for (size_t i = 0; i < scene.displacements.size(); ++i) check_displacement(scene.displacements[i], i);
    for (size_t i = 0; i < scene.materials.size(); ++i) check_material(scene.materials[i], i);
    std::vector<Box> mesh_boxes(scene.meshes.size());
    for (size_t i = 0; i < scene.meshes.size(); ++i)
        for (const Vec3f& position : scene.meshes[i].positions) mesh_boxes[i].extend(position);
    for (size_t i = 0; i < scene.objects.size(); ++i) check_object(scene, mesh_boxes, scene.objects[i], i);
    for (size_t i = 0; i < scene.lights.size(); ++i) check_light(scene.lights[i], i);
    check_links(scene);
    if (scene.environment) {
        const Environment& environment = *scene.environment;
        check_range("environment", "color", environment.color, 0, kHuge);
        check_range("environment", "strength", environment.strength, 0, kHuge);
        check_range("environment", "rotate_degrees", environment.rotate_degrees, -kHuge, kHuge);
        check_light_group("environment", environment.light_group);
        if (environment.texture) check_texture("environment", *environment.texture);
    }
    validate_camera(scene.camera);
    check_picture(scene.picture);
}

} // namespace relief
