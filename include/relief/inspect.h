// What a scene, a mesh or a map is, what it will cost, and what is wrong with it.
#pragma once

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

Inspection inspect_scene(const Scene& scene, const RenderSettings& settings);
Inspection inspect_mesh(const Mesh& mesh);
Inspection inspect_texture(const Texture& texture);

} // namespace relief
