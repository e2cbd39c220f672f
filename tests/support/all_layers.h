// Names of all layers of a picture but motion, which render_moving() sets.
#pragma once

#include <string>
#include <vector>

namespace relief::test {

/// `light_layer`: that of a group of lights, "light_NAME".
inline std::vector<std::string> list_all_layers(const std::string& light_layer) {
    return {"depth",
            "N",
            "N_camera",
            "Ng",
            "P",
            "albedo",
            "uv",
            "id",
            "samples",
            "variance",
            "cost",
            "shadow",
            "guide_albedo",
            "guide_N",
            "direct",
            "diffuse_direct",
            "emission",
            "background",
            "diffuse_indirect",
            "specular_direct",
            "specular_indirect",
            "transmission_indirect",
            "transmission_direct",
            light_layer,
            "CryptoObject",
            "CryptoMaterial"};
}

} // namespace relief::test
