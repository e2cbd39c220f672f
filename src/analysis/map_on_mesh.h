// A displacement map on its mesh: does it fit tangent or object space, along which axes, does it fold?
#pragma once

#include <cstdint>
#include <vector>

#include "relief/scene.h"
#include "surface/patch/surface.h"

namespace relief {

/// Raw values of a map (less its midlevel) at a place of the mesh, and the frame there.
struct MapSample {
    Vec3f value;
    Frame frame;
    TileIndex tile = Surface::kNoTile; ///< of the surface's map
};

/// Both sides of a point on a uv seam.
struct SeamSample {
    MapSample first, second;
};

struct MapSamples {
    std::vector<MapSample> places; ///< in the middles of patches
    std::vector<SeamSample> seams;
};

/// Of a surface made with axes 0, 1, 2, scale 1 and tangent frames.
MapSamples sample_map(const Surface& surface);

/// Those that lie in one tile of the map, on both sides of a seam.
MapSamples keep_tile(const MapSamples& samples, TileIndex tile);

/// Those of at most `most` edges, spread over all seams, of a surface in any space.
std::vector<SeamSample> sample_seams(const Surface& surface, size_t most);

/// All 48 signed permutations.
const std::vector<AxisMap>& get_all_axis_maps();

/// Values turned into a vector: of the frame in tangent space, else plain.
Vec3f turn_by_frame(const MapSample& sample, const AxisMap& axes);
Vec3f turn_by_axes(const Vec3f& value, const AxisMap& axes);

/// How far both sides of the seams are apart, over their length: 0 fits, about 1.4 is chance.
double measure_object_gap(const std::vector<SeamSample>& seams);
double measure_tangent_gap(const std::vector<SeamSample>& seams, const AxisMap& axes);

/// Mean displacement along the mesh's normals over the mean length, in [-1, 1], in object space.
double measure_object_rise(const std::vector<MapSample>& places, const AxisMap& axes);

/// Share of the cells of a displaced surface that face away from its base; of up to 65536 cells.
double measure_folded_share(const Surface& surface);

} // namespace relief
