// All that gives light, as tables that every engine draws from.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "formulas/light_source.h"
#include "formulas/light_tree.h"
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

/// Up to so many lights are listed: each draw estimates all of them. Emissive objects count as lights.
inline constexpr size_t kMostListedLights = 32;

/// What may be drawn. Lights without power are left out. Groups are those of PreparedScene::light_groups.
struct LightTables {
    /// The environment, the scene's lights, the emissive surfaces as one. Of many lights those that have a
    /// place come behind the others, and emissive surfaces are left out: the tree has them.
    std::vector<scalar::LightSourceData> sources;
    uint32_t listed_count = 0; ///< first sources, which are chosen by their estimates; all without a tree
    std::vector<scalar::LightNodeData> nodes; ///< of the tree; empty: there are few lights
    std::vector<uint32_t> leaf_of_emitter;    ///< of the tree: one an emissive patch; kNoIndex: none
    std::vector<std::shared_ptr<const Texture>> textures; ///< that sources refer to
    std::vector<uint32_t> link_words; ///< as LightLinks::words; empty: all lights light all
};

/// `environment_luminance`: its mean.
LightTables make_light_tables(const PreparedScene& scene, float environment_luminance,
                              const EmitterTable& emitters);

} // namespace relief
