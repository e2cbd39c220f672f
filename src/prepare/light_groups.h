// Groups of lights that a picture has layers of.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "relief/scene.h"

namespace relief {

struct LightGroups {
    std::vector<std::string> names;    ///< rising; empty: no layer of a group is asked for
    std::vector<uint32_t> of_material; ///< of what materials emit; as find()
    uint32_t of_default = kNoIndex, of_environment = kNoIndex;

    /// Index into `names` of the group that a light names; kNoIndex: it is none of them.
    uint32_t find(const std::string& light_group) const;
};

/// What of a scene gives light.
struct LightGivers {
    std::span<const Material> materials;
    std::span<const Light> lights;
    const Environment* environment; ///< may be null
};

/// `layers`: as ImageSettings has them. Throws Error{usage} for the layer of a group that nothing is in.
LightGroups make_light_groups(const LightGivers& from, std::span<const std::string> layers);

} // namespace relief
