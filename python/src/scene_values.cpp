#include "scene_values.h"

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <nanobind/stl/string.h>

#include "base/suggest.h"
#include "relief/error.h"
#include "values.h"

namespace nb = nanobind;

namespace relief::python {

namespace {

nb::object make_list(const Vec3f& v) {
    nb::list list;
    for (const float value : {v.x, v.y, v.z}) list.append(value);
    return list;
}

View read_view(const Argument& value) {
    constexpr std::array<std::string_view, 7> kViews = {"automatic", "front", "back",         "left",
                                                        "right",     "top",   "three-quarter"};
    return View(value.word(kViews));
}

SunDirection read_sun(const Argument& value) {
    const std::vector<Argument> angles = value.elements(2, "azimuth and elevation, degrees");
    return {float(angles[0].number(-360, 360)), float(angles[1].number(-90, 90))};
}

Ground read_ground(const Argument& value, nb::handle given) {
    if (given.ptr() == Py_False) return Ground::none;
    if (given.ptr() == Py_True) return Ground::plane;
    constexpr std::array<std::string_view, 3> kGrounds = {"none", "plane", "shadow"};
    return Ground(value.word(kGrounds));
}

void read_option(const std::string& name, nb::handle given, AimOptions& aim) {
    const Argument value(name, given);
    const char* const point = "three numbers, x, y and z";
    if (name == "from_") {
        aim.from = value.vector(point);
    } else if (name == "to") {
        aim.to = value.vector(point);
    } else if (name == "fov") {
        aim.fov_degrees = float(value.number(0.001, 179.999));
    } else if (name == "zoom") {
        aim.zoom = float(value.number(0.01, 100));
    } else if (name == "view") {
        aim.view = read_view(value);
    } else if (name == "frame_all") {
        aim.frame_all = value.truth();
    } else if (name == "env_rotate") {
        aim.rotate_degrees = float(value.number(-360, 360));
    } else if (name == "env_strength") {
        aim.strength = float(value.number(0, 1e9));
    } else if (name == "light") {
        for (size_t k = 0; k < nb::len(given); ++k) aim.suns.push_back(read_sun(Argument(name, given[k])));
    } else if (name == "ground") {
        aim.ground = read_ground(value, given);
    } else {
        constexpr std::string_view kNames[] = {"from_",     "to",         "fov",          "zoom",  "view",
                                               "frame_all", "env_rotate", "env_strength", "light", "ground"};
        throw Error(ErrorKind::usage,
                    {fmt::format("there is no keyword '{}'", name), "", suggest_word(name, kNames)});
    }
}

} // namespace

nb::dict describe_camera(const Camera& camera) {
    nb::dict node;
    node["from"] = make_list(camera.from), node["to"] = make_list(camera.to),
    node["up"] = make_list(camera.up);
    node["fov_degrees"] = camera.fov_degrees;
    node["aperture_radius"] = camera.aperture_radius;
    node["focus_distance"] = camera.focus_distance;
    const auto add_pair = [&](const char* key, float first, float second) {
        if (first == 0 && second == 0) return;
        nb::list pair;
        pair.append(first), pair.append(second);
        node[key] = pair;
    };
    add_pair("shift", camera.shift.x, camera.shift.y);
    add_pair("shutter", camera.shutter_open, camera.shutter_close);
    return node;
}

nb::dict describe_environment(const Environment& environment) {
    nb::dict node;
    node["color"] = make_list(environment.color);
    node["strength"] = environment.strength;
    node["rotate_degrees"] = environment.rotate_degrees;
    return node;
}

nb::list describe_suns(const std::vector<Light>& lights) {
    nb::list list;
    for (const Light& light : lights) {
        if (light.type != LightType::sun) continue;
        nb::dict node;
        node["type"] = "sun";
        node["direction"] = make_list(light.direction);
        node["angle_degrees"] = light.angle_degrees;
        node["color"] = make_list(light.color);
        node["strength"] = light.strength;
        if (light.is_visible_to_camera) node["visible_to_camera"] = true;
        if (!light.light_group.empty()) node["light_group"] = light.light_group;
        for (const auto& [key, names] : {std::pair("light_link_includes", &light.link_includes),
                                         std::pair("light_link_excludes", &light.link_excludes)}) {
            nb::list linked;
            for (const std::string& name : *names) linked.append(name);
            if (!names->empty()) node[key] = linked;
        }
        list.append(node);
    }
    return list;
}

nb::dict describe_material(const Material& material) {
    nb::dict node;
    node["base_color"] = make_list(material.base_color);
    node["specular_roughness"] = material.roughness;
    if (material.ior != Material().ior) node["specular_ior"] = material.ior;
    return node;
}

AimOptions read_aim(const nb::dict& keywords) {
    AimOptions aim;
    for (const auto& [key, value] : keywords)
        if (!value.is_none()) read_option(nb::cast<std::string>(nb::str(key)), value, aim);
    return aim;
}

} // namespace relief::python
