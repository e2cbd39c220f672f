#include "io/scene/scene_sections.h"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "base/suggest.h"
#include "io/scene/displacement_reader.h"
#include "io/scene/input_texture_reader.h"
#include "io/scene/scene_keys.h"
#include "math/affine.h"
#include "relief/material_inputs.h"
#include "relief/shot.h"
#include "scene/displacement_conventions.h"

namespace relief {

namespace {

template <class Value, class Read>
void read_optional(const JsonNode& node, std::string_view key, Value& value, const Read& read) {
    if (const auto found = node.find(key)) value = read(*found);
}

void read_float(const JsonNode& node, std::string_view key, float& value, double low = -double(FLT_MAX),
                double high = FLT_MAX) {
    if (const auto found = node.find(key)) value = found->as_float(low, high);
}

void read_vec3(const JsonNode& node, std::string_view key, Vec3f& value, double low = -double(FLT_MAX),
               double high = FLT_MAX) {
    if (const auto found = node.find(key)) value = found->as_vec3(low, high);
}

std::optional<int> read_int(const JsonNode& node, std::string_view key, int64_t low, int64_t high) {
    const auto found = node.find(key);
    return found ? std::optional<int>(int(found->as_integer(low, high))) : std::nullopt;
}

void read_light_group(const JsonNode& node, std::string& group) {
    const auto found = node.find("light_group");
    if (!found) return;
    group = found->as_string();
    if (!is_light_group_name(group))
        found->fail(fmt::format("'{}' is no name of a light group", group),
                    fmt::format("1 to {} letters, digits, '_' and '-'", kMaxLightGroupName));
}

std::shared_ptr<const Texture> read_texture_key(const JsonNode& node, std::string_view key, TextureUse use,
                                                AssetCache& assets, const std::string& space = {}) {
    const auto found = node.find(key);
    if (!found) return nullptr;
    const std::string file = key == "file" ? read_picture_file(node, assets) : found->as_string();
    return found->with_place([&] { return assets.load(file, use, 0, space); });
}

Affine read_matrix(const JsonNode& node) {
    const std::vector<JsonNode> values = node.elements();
    if (values.size() != 16) node.fail(fmt::format("must be 16 numbers, row by row, not {}", values.size()));
    Affine m;
    for (size_t r = 0; r < 3; ++r) {
        m.rows[r] = {values[4 * r].as_float(), values[4 * r + 1].as_float(), values[4 * r + 2].as_float()};
        set_component(m.translation, int(r), values[4 * r + 3].as_float());
    }
    for (size_t c = 0; c < 4; ++c)
        if (values[12 + c].as_float() != (c == 3 ? 1.0f : 0.0f))
            node.fail("the last row must be 0, 0, 0, 1",
                      "numbers go row by row; projections are not supported");
    return m;
}

} // namespace

std::vector<int> parse_frames_at(const JsonNode& node) {
    const std::string text = node.as_string();
    try {
        return parse_frames(text);
    } catch (const Error& error) {
        node.fail(error.message(), error.hint());
    }
}

PictureDefaults read_picture(const JsonNode& node) {
    node.check_keys(scene_keys::kPicture);
    PictureDefaults picture;
    picture.width = read_int(node, "width", 1, kMaxPictureSize);
    picture.height = read_int(node, "height", 1, kMaxPictureSize);
    picture.spp = read_int(node, "spp", 1, kMaxSamples);
    picture.bounces = read_int(node, "bounces", 0, kMaxBounces);
    if (const auto seed = node.find("seed"))
        picture.seed = uint32_t(seed->as_integer(0, std::numeric_limits<uint32_t>::max()));
    if (const auto frames = node.find("frames")) parse_frames_at(*frames);
    if (const auto fps = node.find("fps")) picture.fps = fps->as_float(FLT_MIN);
    return picture;
}

Camera read_camera(const JsonNode& node) {
    node.check_keys(scene_keys::kCamera);
    Camera camera;
    read_vec3(node, "from", camera.from);
    read_vec3(node, "to", camera.to);
    read_vec3(node, "up", camera.up);
    read_float(node, "fov_degrees", camera.fov_degrees, 0.001, 179.999);
    read_float(node, "aperture_radius", camera.aperture_radius, 0);
    const float distance = length(camera.to - camera.from);
    if (distance > 0) camera.focus_distance = distance;
    read_float(node, "focus_distance", camera.focus_distance, FLT_MIN);
    if (const auto shift = node.find("shift")) camera.shift = shift->as_vec2(-kMaxLensShift, kMaxLensShift);
    if (const auto shutter = node.find("shutter")) {
        const Vec2f times = shutter->as_vec2(-kMaxShutter, kMaxShutter);
        if (times.x > times.y)
            shutter->fail("the shutter opens after it closes",
                          "[open, close], in frames, for example [-0.25, 0.25]");
        camera.shutter_open = times.x, camera.shutter_close = times.y;
    }
    return camera;
}

Affine read_transform(const JsonNode& node) {
    node.check_keys(scene_keys::kTransform);
    Affine transform;
    if (const auto matrix = node.find("matrix")) {
        if (node.members().size() > 1)
            matrix->fail("cannot be mixed with translate, rotate_degrees or scale");
        transform = read_matrix(*matrix);
    } else {
        Vec3f translate, rotate, scale{1, 1, 1};
        read_vec3(node, "translate", translate);
        read_vec3(node, "rotate_degrees", rotate);
        read_optional(node, "scale", scale, [](const JsonNode& n) { return n.as_vec3_or_number(); });
        transform = compose(make_rotation_degrees(rotate), make_scale(scale));
        transform.translation = translate;
    }
    if (!invert(transform)) {
        const auto scale = node.find("scale");
        (scale ? *scale : node)
            .fail("makes the transform singular", "no factor may be 0: nothing would be left");
    }
    return transform;
}

namespace {

void read_direction(const JsonNode& node, const char* key, Vec3f& direction) {
    read_vec3(node, key, direction);
    if (length(direction) == 0) node.fail(fmt::format("the {} has no length", key));
}

void read_sun(const JsonNode& node, Light& light) {
    node.check_keys(scene_keys::kSun);
    read_direction(node, "direction", light.direction);
    read_float(node, "angle_degrees", light.angle_degrees, 0, 90);
}

void read_point(const JsonNode& node, Light& light) {
    node.check_keys(scene_keys::kPoint);
    read_vec3(node, "position", light.position);
    read_float(node, "radius", light.radius, 0);
}

/// Of rectangles and disks.
constexpr double kSmallestFace = 1e-18, kLargestFace = 1e18;

void read_rectangle(const JsonNode& node, Light& light) {
    node.check_keys(scene_keys::kRectangle);
    read_vec3(node, "position", light.position);
    read_direction(node, "direction", light.direction);
    read_direction(node, "up", light.up);
    read_float(node, "width", light.width, kSmallestFace, kLargestFace);
    read_float(node, "height", light.height, kSmallestFace, kLargestFace);
}

void read_disk(const JsonNode& node, Light& light) {
    node.check_keys(scene_keys::kDisk);
    read_vec3(node, "position", light.position);
    read_direction(node, "direction", light.direction);
    read_direction(node, "up", light.up);
    light.radius = 0.5f;
    read_float(node, "radius", light.radius, kSmallestFace, kLargestFace);
}

void read_spot(const JsonNode& node, Light& light) {
    node.check_keys(scene_keys::kSpot);
    read_vec3(node, "position", light.position);
    read_direction(node, "direction", light.direction);
    read_float(node, "angle_degrees", light.cone_degrees, 0.001, 180);
    read_float(node, "blend", light.blend, 0, 1);
    read_float(node, "radius", light.radius, 0);
}

/// Of objects; whether there are such is checked with the whole scene.
std::vector<std::string> read_names(const JsonNode& node) {
    std::vector<std::string> names;
    for (const JsonNode& name : node.elements()) names.push_back(name.as_string());
    if (names.empty()) node.fail("names no object", "leave it out to light all objects");
    return names;
}

struct LightReader {
    std::string_view name;
    LightType type;
    void (*read)(const JsonNode& node, Light& light);
};

constexpr LightReader kLightReaders[] = {{"sun", LightType::sun, read_sun},
                                         {"point", LightType::point, read_point},
                                         {"rectangle", LightType::rectangle, read_rectangle},
                                         {"disk", LightType::disk, read_disk},
                                         {"spot", LightType::spot, read_spot}};

} // namespace

Light read_light(const JsonNode& node, AssetCache& assets) {
    Light light;
    const JsonNode type = node.get("type");
    const std::string name = type.as_string();
    const auto* found = std::ranges::find(kLightReaders, name, &LightReader::name);
    if (found == std::end(kLightReaders)) {
        std::vector<std::string_view> names;
        for (const LightReader& reader : kLightReaders) names.push_back(reader.name);
        type.fail(fmt::format("unknown light '{}'", name), suggest_word(name, names));
    }
    light.type = found->type;
    found->read(node, light);
    read_vec3(node, "color", light.color, 0);
    light.color_texture = read_texture_key(node, "color_texture", TextureUse::color, assets);
    if (const auto up = node.find("up"); up && light.type == LightType::disk && !light.color_texture)
        up->fail("turns the texture of a disk, and there is none", "leave it out, or add color_texture");
    read_float(node, "strength", light.strength, 0);
    read_optional(node, "visible_to_camera", light.is_visible_to_camera,
                  [](const JsonNode& n) { return n.as_bool(); });
    read_light_group(node, light.light_group);
    read_optional(node, "light_link_includes", light.link_includes, read_names);
    read_optional(node, "light_link_excludes", light.link_excludes, read_names);
    return light;
}

Environment read_environment(const JsonNode& node, AssetCache& assets) {
    node.check_keys(scene_keys::kEnvironment);
    Environment environment;
    environment.texture =
        read_texture_key(node, "file", TextureUse::radiance, assets, read_color_space(node));
    if (const auto space = node.find("color_space"); space && !environment.texture)
        space->fail("is that of a file, and there is none", "color is linear Rec.709");
    read_vec3(node, "color", environment.color, 0);
    read_float(node, "strength", environment.strength, 0);
    read_float(node, "rotate_degrees", environment.rotate_degrees);
    read_light_group(node, environment.light_group);
    return environment;
}

namespace {

/// Reads a number, or the factor of the texture that replaces it.
float read_factor(const JsonNode& value, float low, float high) {
    if (!value.is_object()) return value.as_float(low, high);
    const auto factor = value.find("factor");
    return factor ? factor->as_float(low, high) : 1;
}

Vec3f read_color_factor(const JsonNode& value, float low, float high) {
    if (!value.is_object()) return value.as_vec3(low, high);
    const auto factor = value.find("factor");
    if (!factor) return {1, 1, 1};
    return factor->is_array() ? factor->as_vec3(low, high) : Vec3f{1, 1, 1} * factor->as_float(low, high);
}

/// Returns the node of an input under its name or its alias, not both.
std::optional<JsonNode> find_value(const JsonNode& node, const char* name, const char* alias) {
    const auto found = node.find(name), other = alias ? node.find(alias) : std::nullopt;
    if (found && other)
        found->fail(fmt::format("means the same as '{}', which is there too", alias),
                    "leave one of the two out");
    return found ? found : other;
}

void read_input(const JsonNode& node, const MaterialInputKind& kind, Material& material) {
    const auto value = find_value(node, kind.name, kind.alias);
    if (!value) return;
    if (kind.texture_hint && value->is_object()) value->fail("cannot have a texture", kind.texture_hint);
    if (kind.number) material.*kind.number = read_factor(*value, kind.low, kind.high);
    if (kind.color) material.*kind.color = read_color_factor(*value, kind.low, kind.high);
    if (kind.flag) material.*kind.flag = value->as_bool();
}

/// Reads the radiance: `emission`, or the product of the other two.
void read_emission(const JsonNode& node, Vec3f& emission) {
    find_value(node, "emission_luminance", "emission");
    if (const auto radiance = find_value(node, "emission_color", "emission");
        radiance && node.find("emission"))
        emission = read_color_factor(*radiance, 0, kUnboundedInput);
    const auto color = node.find("emission_color");
    const auto luminance = node.find("emission_luminance");
    if (color && !luminance)
        color->fail("is multiplied by emission_luminance, which is not there", "give both, or 'emission'");
    if (!luminance) return;
    const Vec3f scale = color ? read_color_factor(*color, 0, 1) : Vec3f{1, 1, 1};
    emission = scale * read_factor(*luminance, 0, kUnboundedInput);
}

/// Reads what the object of a normal map says beside its texture.
void read_normal_options(const JsonNode& node, Material& material) {
    const auto found = find_value(node, "geometry_normal", "normal_texture");
    if (!found || found->is_string()) return;
    read_float(*found, "scale", material.normal_scale, 0, double(kMaxNormalScale));
    if (const auto flip = found->find("flip_y")) material.normal_flip_y = flip->as_bool();
}

} // namespace

Material read_material(const JsonNode& node, const std::string& name, AssetCache& assets) {
    for (const std::string_view key : scene_keys::kMaterialLacks)
        if (const auto found = node.find(key))
            found->fail("this input of OpenPBR is not rendered",
                        "leave it out; docs/decisions/openpbr.md lists what is");
    node.check_keys(list_material_keys());
    Material material;
    material.name = name;
    for (const MaterialInputKind& kind : list_material_fields())
        if (!kind.is_emission()) read_input(node, kind, material);
    read_emission(node, material.emission);
    read_light_group(node, material.light_group);
    read_normal_options(node, material);
    read_input_textures(node, assets, material);
    return material;
}

Displacement read_displacement(const JsonNode& node, const std::string& name, AssetCache& assets) {
    node.check_keys(scene_keys::kDisplacement);
    DisplacementRequest request;
    request.name = name;
    MapOptions& options = request.options;
    const auto as_text = [](const JsonNode& n) { return n.as_string(); };
    const auto as_factors = [](const JsonNode& n) { return n.as_vec3_or_number(); };
    request.file = read_picture_file(node, assets);
    read_optional(node, "preset", options.preset, as_text);
    read_optional(node, "type", options.type, as_text);
    read_optional(node, "space", options.space, as_text);
    read_optional(node, "axes", options.axes, as_text);
    read_optional(node, "frame", options.frame, as_text);
    read_optional(node, "lengths", options.lengths, as_text);
    read_optional(node, "encoding", options.encoding, as_text);
    read_optional(node, "wrap", options.wrap, as_text);
    read_optional(node, "midlevel", options.midlevel, as_factors);
    read_optional(node, "scale", options.scale, as_factors);
    const auto as_bool = [](const JsonNode& n) { return n.as_bool(); };
    read_optional(node, "flip_v", options.flip_v, as_bool);
    read_optional(node, "dilate", options.dilate, as_bool);
    read_optional(node, "filter", options.filter, as_text);
    read_optional(node, "dequantize", options.dequantize, as_bool);
    read_optional(node, "autobump", options.autobump, as_bool);
    return node.with_place([&] { return make_displacement(request, assets); });
}

} // namespace relief
