#include "io/scene/scene_values.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "relief/material_inputs.h"
#include "scene/displacement_conventions.h"
#include "scene/words.h"

namespace relief {

Json to_json(float value) { return std::stod(fmt::format("{}", value)); }
Json to_json(const Vec3f& v) { return Json::array({to_json(v.x), to_json(v.y), to_json(v.z)}); }

Json write_picture(const PictureDefaults& picture) {
    Json node = Json::object();
    if (picture.width) node["width"] = *picture.width;
    if (picture.height) node["height"] = *picture.height;
    if (picture.spp) node["spp"] = *picture.spp;
    if (picture.bounces) node["bounces"] = *picture.bounces;
    if (picture.seed) node["seed"] = *picture.seed;
    if (picture.fps) node["fps"] = to_json(*picture.fps);
    return node;
}

Json write_matrix(const Affine& m) {
    Json matrix = Json::array();
    const float offsets[] = {m.translation.x, m.translation.y, m.translation.z};
    for (size_t r = 0; r < 3; ++r)
        for (const float value : {m.rows[r].x, m.rows[r].y, m.rows[r].z, offsets[r]})
            matrix.push_back(to_json(value));
    for (const int value : {0, 0, 0, 1}) matrix.push_back(value);
    return matrix;
}

Json write_camera(const Camera& camera) {
    Json node = {{"from", to_json(camera.from)},
                 {"to", to_json(camera.to)},
                 {"up", to_json(camera.up)},
                 {"fov_degrees", to_json(camera.fov_degrees)},
                 {"aperture_radius", to_json(camera.aperture_radius)},
                 {"focus_distance", to_json(camera.focus_distance)}};
    if (camera.shift != Vec2f{}) node["shift"] = {to_json(camera.shift.x), to_json(camera.shift.y)};
    if (camera.shutter_open != 0 || camera.shutter_close != 0)
        node["shutter"] = {to_json(camera.shutter_open), to_json(camera.shutter_close)};
    return node;
}

void write_inputs(const Material& material, Json& node) {
    const Material plain;
    const auto write = [&](const MaterialInputKind& kind, const auto Material::*member) {
        if (kind.is_always_saved || !(material.*member == plain.*member))
            node[kind.short_name()] = to_json(material.*member);
    };
    for (const MaterialInputKind& kind : list_material_fields()) {
        if (kind.number) write(kind, kind.number);
        if (kind.color && !kind.is_emission()) write(kind, kind.color);
        if (kind.flag && material.*kind.flag != plain.*kind.flag) node[kind.name] = material.*kind.flag;
    }
}

Json write_placement(const InputTexture& texture) {
    const InputTexture plain;
    Json node = Json::object();
    const auto write_pair = [&](const char* key, const Vec2f& value, const Vec2f& usual) {
        if (!(value == usual)) node[key] = {to_json(value.x), to_json(value.y)};
    };
    if (texture.filter != plain.filter) node["filter"] = get_word(texture.filter);
    if (texture.wrap != plain.wrap && !texture.is_udim) node["wrap"] = get_word(texture.wrap);
    write_pair("uv_scale", texture.uv_scale, plain.uv_scale);
    write_pair("uv_offset", texture.uv_offset, plain.uv_offset);
    return node;
}

void write_emission(const Material& material, Json& node) {
    const Vec3f& emission = material.emission;
    const bool has_luminance = node.contains("emission_luminance");
    if (!has_luminance && !node.contains("emission_color")) {
        node["emission"] = to_json(emission);
        return;
    }
    if (!has_luminance) {
        node["emission"] = std::move(node["emission_color"]);
        node.erase("emission_color");
        node["emission"]["factor"] = to_json(emission);
        return;
    }
    // A luminance goes with a colour in [0, 1].
    const float most = std::max({emission.x, emission.y, emission.z, 1e-30f});
    const Json color = to_json(Vec3f{emission.x / most, emission.y / most, emission.z / most});
    node["emission_luminance"]["factor"] = to_json(most);
    if (node.contains("emission_color"))
        node["emission_color"]["factor"] = color;
    else
        node["emission_color"] = color;
}

void write_normal_options(const Material& material, Json& node) {
    const Material plain;
    if (!has_normal_map(material)) return;
    if (material.normal_scale == plain.normal_scale && !material.normal_flip_y) return;
    Json& texture = node["normal_texture"];
    if (texture.is_string()) texture = Json{{"file", texture}};
    if (material.normal_scale != plain.normal_scale) texture["scale"] = to_json(material.normal_scale);
    if (material.normal_flip_y) texture["flip_y"] = true;
}

void write_map_convention(const Displacement& map, Json& node) {
    node["type"] = get_word(map.type);
    node["space"] = get_word(map.space);
    node["axes"] = format_axes(map.axes, map.space);
    node["frame"] = get_word(map.frame);
    node["lengths"] = get_word(map.lengths);
    // Unsaid it is 0 of the floats that are written.
    if (map.has_midlevel || map.midlevel != Vec3f{}) node["midlevel"] = to_json(map.midlevel);
    node["scale"] = to_json(map.scale);
    node["flip_v"] = map.flip_v;
    node["dilate"] = map.dilate;
    node["filter"] = get_word(map.filter);
    node["autobump"] = map.autobump;
    node["wrap"] = get_word(map.wrap);
}

void write_environment(const Environment& environment, Json& node) {
    node["color"] = to_json(environment.color);
    node["strength"] = to_json(environment.strength);
    node["rotate_degrees"] = to_json(environment.rotate_degrees);
    if (!environment.light_group.empty()) node["light_group"] = environment.light_group;
}

Json write_light(const Light& light) {
    Json node;
    if (light.type == LightType::sun) {
        node = {{"type", "sun"},
                {"direction", to_json(light.direction)},
                {"angle_degrees", to_json(light.angle_degrees)}};
    } else {
        constexpr const char* kNames[] = {"sun", "point", "rectangle", "disk", "spot"};
        node = {{"type", kNames[size_t(light.type)]}, {"position", to_json(light.position)}};
        if (light.type != LightType::point) node["direction"] = to_json(light.direction);
        if (light.type != LightType::rectangle) node["radius"] = to_json(light.radius);
    }
    if (light.type == LightType::disk && light.color_texture) node["up"] = to_json(light.up);
    if (light.type == LightType::rectangle) {
        node["up"] = to_json(light.up);
        node["width"] = to_json(light.width);
        node["height"] = to_json(light.height);
    }
    if (light.type == LightType::spot) {
        node["angle_degrees"] = to_json(light.cone_degrees);
        node["blend"] = to_json(light.blend);
    }
    node["color"] = to_json(light.color);
    node["strength"] = to_json(light.strength);
    if (light.is_visible_to_camera) node["visible_to_camera"] = true;
    if (!light.light_group.empty()) node["light_group"] = light.light_group;
    if (!light.link_includes.empty()) node["light_link_includes"] = light.link_includes;
    if (!light.link_excludes.empty()) node["light_link_excludes"] = light.link_excludes;
    return node;
}

} // namespace relief
