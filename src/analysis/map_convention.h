// How a displacement map is probably meant: space, axes and zero, each with its reason.
#pragma once

#include <optional>
#include <string>

#include "analysis/map_on_mesh.h"
#include "analysis/map_statistics.h"
#include "relief/scene.h"

namespace relief {

/// A guess with what speaks for it; `is_clear` is false where nothing does, and the value is the default.
template <class Value> struct Guess {
    Value value{};
    bool is_clear = false;
    std::string reason;
};

struct MapConvention {
    Guess<DisplacementSpace> space;
    Guess<AxisMap> axes;            ///< clear where the axis along the normal is
    bool is_space_by_seams = false; ///< the uv seams of the mesh speak for the space
    bool is_order_clear = false;    ///< of object space: also which channels go along x, y and z
    bool is_hand_clear =
        false; ///< of tangent space: t and b are right, or turned by quarters, but not mirrored
    double axes_lead =
        0; ///< in tangent space: evidence for the channel along the normal over that for the next
};

/// `map`: its tiles count, and its scale, wrap, flip_v and is_udim. `mesh` may be null.
MapConvention guess_convention(const Displacement& map, const MapStatistics& statistics, const Mesh* mesh);

/// Whether the axes of `map` are those of a convention, as far as it is clear about them.
bool agrees_on_axes(const MapConvention& convention, const Displacement& map);

/// Whether the values of a map in tangent space speak so clearly for another channel along the normal that
/// even axes which somebody declared are doubtful.
bool contradicts_axes(const MapConvention& convention, const Displacement& map);

/// Which space the uv seams speak for; nothing where they do not tell.
std::optional<Guess<DisplacementSpace>> guess_space_by_seams(const std::vector<SeamSample>& seams);

/// Share of places where the surface faces away from its base: its mesh, or a plane 2 units wide. Nothing
/// where unknown: tiles or object space without a mesh, or a mesh that does not fit.
std::optional<double> measure_fold_share(const Displacement& map, const Mesh* mesh);

/// The presets that write such a map, for people: "blender-brush, genvdm"; empty: none.
std::string list_presets(const AxisMap& axes);

} // namespace relief
