// Every structure and traversal that an engine can be asked for.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "relief/render.h"

namespace relief::test {

struct Choice {
    StructureKind structure;
    TraversalKind traversal;
};

inline std::vector<Choice> list_choices(EngineKind engine) {
    std::vector<Choice> choices;
    for (const StructureKind structure : {StructureKind::bvh, StructureKind::lbvh, StructureKind::kdtree})
        for (const TraversalKind traversal : available_traversals(engine, structure))
            choices.push_back({structure, traversal});
    return choices;
}

/// As names of tests may be: "bvh_skip_link".
inline std::string name_choice(const Choice& choice) {
    std::string name = std::string(structure_name(choice.structure)) + "_" + traversal_name(choice.traversal);
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
}

} // namespace relief::test
