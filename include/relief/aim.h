// Camera and lights of a scene chosen from what is in it. In library relief_io.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "relief/scene.h"

namespace relief {

/// Sides that a scene is seen from. `automatic`: bodies from above their front, flat ones from the side that
/// they face. The others are axes of the world: `front` looks along -z, `right` along -x, `top` along -y; of
/// a mesh alone, front is the side that the body faces.
enum class View { automatic, front, back, left, right, top, three_quarter };

/// Where light comes from, degrees: `azimuth` about +y from +z towards +x, `elevation` above the horizon.
struct SunDirection {
    float azimuth = 0, elevation = 45;
    friend bool operator==(const SunDirection&, const SunDirection&) = default;
};

/// A wide plane under the lowest point, which in the light of load_mesh_scene goes over into its backdrop.
/// `shadow`: one that only catches shadows.
enum class Ground { none, plane, shadow };

/// What is to be changed of a scene; all empty: nothing.
struct AimOptions {
    std::optional<Vec3f> from, ///< not with view or frame_all
        to;                    ///< of the camera; without `to` the camera looks at the middle of the scene
    std::optional<float> fov_degrees; ///< vertical, in (0, 180)
    std::optional<float>
        zoom;                 ///< factor on the size of all that is seen, by the camera's angle as it is then
    std::optional<View> view; ///< also frames all objects
    bool is_turntable = false;           ///< framed objects stay in the picture through a whole turn_camera
    bool frame_all = false;              ///< the camera keeps its direction and shows all objects
    std::optional<float> rotate_degrees; ///< of the environment
    std::optional<float> strength;       ///< of the environment
    std::vector<SunDirection> suns;      ///< instead of the suns of the scene
    Ground ground = Ground::none;
    friend bool operator==(const AimOptions&, const AimOptions&) = default;
};

/// Applies `options`. The light of a scene of load_mesh_scene or its like, where nothing has changed it, is
/// placed for the new camera. `aspect` is width / height of the picture: framed objects take about 85 % of
/// its height, or of its width. Throws Error{bad_input} for a scene that render() refuses, Error{usage} where
/// the scene has no environment to change, or nothing to frame. Scans about a quarter of a million samples
/// where it frames.
void aim_scene(Scene& scene, const AimOptions& options, float aspect);

/// For a scene whose environment is a copy of that of load_mesh_scene, texel by texel: makes it the original,
/// which aim_scene places for the camera and matches the ground to.
void recognize_studio(Scene& scene);

/// The camera after a turn about its up axis through `camera.to`; the environment and lights stay.
Camera turn_camera(const Camera& camera, float degrees);

} // namespace relief
