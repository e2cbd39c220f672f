// Maps of one convention as maps of another, and displaced surfaces as plain meshes, for other programs.
#pragma once

#include <string>
#include <vector>

#include "relief/scene.h"

namespace relief {

/// The same displacement as `from` in the meaning of `to`: its type, space, axes, frame, lengths, midlevel,
/// scale and flip_v; its tiles do not count, name, is_udim, wrap, dilate, filter and autobump stay those of
/// `from`. Texels of the result are 32-bit floats, three channels, not rounded or clipped. Between tangent
/// and object space, and between frames of tangent space, `mesh` gives the frames: texels that lie beside its
/// faces take over the nearest ones, up to eight texels away, and farther ones hold no displacement. Where
/// the frames of tangent space nearly collapse (tangents of other directions meet inside a face) it holds a
/// displacement only as far as values four times as large do; what is lost is added to `warnings`, unless
/// that is null. Rounding apart, and but for those, a way there and back gives what was there. Throws
/// Error{usage} where the two cannot be turned into each other (a height out of vectors, world space, a
/// missing mesh), Error{bad_input} for a mesh that cannot carry the map.
Displacement convert_map(const Displacement& from, const Displacement& to, const Mesh* mesh = nullptr,
                         std::vector<std::string>* warnings = nullptr);

/// Axes as options and scene files take them: "t,-n,b", or "x,-z,y" in object and world space.
std::string format_map_axes(const AxisMap& axes, DisplacementSpace space);

/// The largest |displacement| along an axis of the map, decoded, in scene units.
float find_largest_displacement(const Displacement& map);

/// All objects of a scene as one mesh of quads in world space: displaced surfaces with 2^level x 2^level
/// quads a patch, patches sharing the vertices of their edges, uvs kept; plain polygons as they are, or as
/// their subdivision has them. Level is in [0, kMaxLevel]. Throws Error{usage} for another, Error{bad_input},
/// Error{out_of_memory} with the byte count where it does not fit.
Mesh make_displaced_mesh(const Scene& scene, int level);

} // namespace relief
