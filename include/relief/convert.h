// Exchange with other programs: displacement maps between conventions, displaced surfaces as plain meshes.
#pragma once

#include <string>
#include <vector>

#include "relief/progress.h"
#include "relief/scene.h"

namespace relief {

/// Re-encodes `from` in the convention of `to`: its type, space, axes, frame, lengths, midlevel, scale and
/// flip_v; its tiles are ignored. The result keeps the name, is_udim, wrap, dilate, filter and autobump of
/// `from`, and holds three channels of 32-bit floats, neither rounded nor clipped; the steps of a map with
/// dequantize are smoothed then. Conversions between
/// tangent and object space, or between tangent frames, need `mesh`, which supplies the frames: texels
/// outside its faces take the frame of the nearest texel inside, up to eight texels away; texels beyond that
/// hold no displacement. Where a tangent frame is nearly singular (tangents of opposite directions meet
/// inside a face), components are limited to four times the displacement; what is lost is added to
/// `warnings`, unless that is null. Elsewhere a round trip restores the map up to rounding. Throws
/// Error{usage} for impossible conversions (vectors to heights, world space, a missing mesh),
/// Error{bad_input} for a mesh that cannot carry the map.
Displacement convert_map(const Displacement& from, const Displacement& to, const Mesh* mesh = nullptr,
                         std::vector<std::string>* warnings = nullptr,
                         const ProgressFunction& on_progress = {});

/// Axes in the notation of options and scene files: "t,-n,b", or "x,-z,y" in object and world space.
std::string format_map_axes(const AxisMap& axes, DisplacementSpace space);

/// Largest magnitude of any decoded component of the map, scene units.
float find_largest_displacement(const Displacement& map);

/// All objects of a scene as one mesh in world space, with uvs: displaced surfaces as 2^level x 2^level quads
/// per patch, welded along shared edges; other polygons unchanged, or subdivided as their mesh asks. `level`
/// is in [0, kMaxLevel], else Error{usage}. Throws Error{bad_input} for an invalid scene,
/// Error{out_of_memory} with the byte count for a mesh that does not fit.
Mesh make_displaced_mesh(const Scene& scene, int level, const ProgressFunction& on_progress = {});

} // namespace relief
