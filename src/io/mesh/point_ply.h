// Points of a PLY file as places of instances.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "relief/types.h"

namespace relief {

struct InstancePoints {
    std::vector<Affine> transforms;
    std::vector<uint32_t> materials; ///< an index each, or empty
};

/// Element `vertex` with `x y z`; optional are a rotation `qw qx qy qz` (a quaternion of any length but 0),
/// `scale` or `scale_x scale_y scale_z` (not 0), and `material`, an index below `material_count`. A point
/// scales, then rotates, then moves. `name` is for messages. Throws bad_input with point and place.
InstancePoints parse_points(std::string_view bytes, const std::string& name, size_t material_count);

} // namespace relief
