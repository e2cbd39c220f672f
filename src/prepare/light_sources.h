// All that gives light, as tables that every engine draws from.
#pragma once

#include <cstdint>
#include <vector>

#include "formulas/light_source.h"
#include "prepare/prepared_scene.h"

namespace relief {

/// Emissive patches, drawn by area times brightness.
struct EmitterTable {
    /// Patches of one emissive instance.
    struct Range {
        uint32_t instance;
        uint32_t first; ///< number of its first patch among all emissive ones
    };
    std::vector<double> cumulative;          ///< 0 ... 1: one entry more than there are emissive patches
    std::vector<Range> ranges;               ///< rising in `first`
    std::vector<uint32_t> first_of_instance; ///< one an instance; kNoIndex: not emissive
    double power = 0;                        ///< luminance times area over all; 0: nothing glows
    Vec3f center{};                          ///< of a sphere about all emissive patches
    float radius2 = 0;                       ///< of that sphere, squared

    uint32_t size() const { return uint32_t(cumulative.size()) - 1; }
    /// Probability of emissive patch `index`.
    float probability(uint32_t index) const { return float(cumulative[index + 1] - cumulative[index]); }
};

EmitterTable make_emitter_table(const PreparedScene& scene);

/// What may be drawn, in this order: the environment of the given mean luminance, the scene's list of lights,
/// the emissive surfaces as one. Lights without power are left out.
std::vector<scalar::LightSourceData>
make_light_sources(const PreparedScene& scene, float environment_luminance, const EmitterTable& emitters);

} // namespace relief
