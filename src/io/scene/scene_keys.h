// Keys of each section of a scene file except materials (relief/material_inputs.h). docs/scene.schema.json
// has the same ones, as a test checks.
#pragma once

#include <array>
#include <string_view>

namespace relief::scene_keys {

template <class... Text> constexpr auto make_keys(Text... text) {
    return std::array<std::string_view, sizeof...(text)>{text...};
}

inline constexpr auto kRoot = make_keys("version", "render", "camera", "environment", "materials",
                                        "displacements", "meshes", "objects", "lights");
inline constexpr auto kPicture = make_keys("width", "height", "spp", "bounces", "seed", "frames", "fps");
inline constexpr auto kKeyed = make_keys("keys", "interpolation");
inline constexpr auto kCamera =
    make_keys("from", "to", "up", "fov_degrees", "aperture_radius", "focus_distance", "shift", "shutter");
inline constexpr auto kEnvironment =
    make_keys("file", "layer", "part", "color_space", "color", "strength", "rotate_degrees", "light_group");
/// Inputs of OpenPBR 1.1 that are refused by name.
inline constexpr auto kMaterialLacks =
    make_keys("subsurface_weight", "subsurface_color", "subsurface_radius", "subsurface_radius_scale",
              "subsurface_scatter_anisotropy", "transmission_scatter", "transmission_scatter_anisotropy",
              "transmission_dispersion_scale", "transmission_dispersion_abbe_number", "thin_film_weight",
              "thin_film_thickness", "thin_film_ior", "geometry_tangent", "geometry_coat_normal",
              "geometry_coat_tangent");
inline constexpr auto kColorTexture = make_keys("file", "layer", "part", "filter", "color_space", "uv_set");
inline constexpr auto kDataTexture = make_keys("file", "layer", "part", "filter", "channel", "uv_set");
inline constexpr auto kNormalTexture =
    make_keys("file", "layer", "part", "filter", "scale", "flip_y", "wrap", "uv_scale", "uv_offset");
/// In place of the number or colour of an input.
inline constexpr auto kInputTexture = make_keys("file", "layer", "part", "factor", "filter", "channel",
                                                "color_space", "wrap", "uv_scale", "uv_offset", "uv_set");
inline constexpr auto kDisplacement =
    make_keys("type", "file", "layer", "part", "preset", "space", "axes", "frame", "lengths", "encoding",
              "midlevel", "scale", "flip_v", "wrap", "dilate", "filter", "dequantize", "autobump");
inline constexpr auto kMesh = make_keys("file", "uv_set", "animation", "time", "subdivision", "weld");
inline constexpr auto kSubdivision = make_keys("scheme", "level", "uv", "boundary", "creases");
inline constexpr auto kObject =
    make_keys("name", "mesh", "displacement", "material", "transform", "instances", "shadow_catcher");
inline constexpr auto kInstances = make_keys("file", "materials");
inline constexpr auto kTransform = make_keys("translate", "rotate_degrees", "scale", "matrix");
inline constexpr auto kSun =
    make_keys("type", "direction", "angle_degrees", "color", "strength", "visible_to_camera", "light_group",
              "light_link_includes", "light_link_excludes");
inline constexpr auto kPoint =
    make_keys("type", "position", "radius", "color", "strength", "visible_to_camera", "light_group",
              "light_link_includes", "light_link_excludes");
inline constexpr auto kRectangle =
    make_keys("type", "position", "direction", "up", "width", "height", "color", "color_texture", "strength",
              "visible_to_camera", "light_group", "light_link_includes", "light_link_excludes");
inline constexpr auto kDisk =
    make_keys("type", "position", "direction", "up", "radius", "color", "color_texture", "strength",
              "visible_to_camera", "light_group", "light_link_includes", "light_link_excludes");
inline constexpr auto kSpot =
    make_keys("type", "position", "direction", "angle_degrees", "blend", "radius", "color", "strength",
              "visible_to_camera", "light_group", "light_link_includes", "light_link_excludes");

} // namespace relief::scene_keys
