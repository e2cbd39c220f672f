// What a scene, a mesh or a map is, what it will cost, and what is wrong with it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "relief/render.h"
#include "relief/scene.h"

namespace relief {

enum class Severity { note, warning, error };

struct Finding {
    Severity severity = Severity::note;
    std::string code; ///< stable, e.g. "W-8BIT"
    std::string text; ///< with the remedy
};

struct Fact {
    std::string name;  ///< stable key, e.g. "patches"
    std::string value; ///< with its unit
};

struct Inspection {
    std::vector<Fact> facts;
    std::vector<Finding> findings;
};

/// What a scene would hold with every displaced patch cut into micro-quads up front: the baseline of direct
/// tracing.
struct TessellationCost {
    uint64_t micro_quads = 0;
    uint64_t geometry_bytes = 0;   ///< exact
    uint64_t structures_bytes = 0; ///< from the size of such trees elsewhere: within a tenth
    uint64_t peak_bytes = 0;       ///< of the displaced surfaces while they are made, what a render asks for
};

/// Cost at the levels of `settings`; nothing is tessellated. Throws Error (bad_input).
TessellationCost estimate_tessellation(const Scene& scene, const RenderSettings& settings);

Inspection inspect_scene(const Scene& scene, const RenderSettings& settings);
Inspection inspect_mesh(const Mesh& mesh);
Inspection inspect_texture(const Texture& texture);

} // namespace relief
