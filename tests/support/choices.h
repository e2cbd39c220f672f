// Every structure and traversal that an engine can be asked for.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "math/vec.h"
#include "relief/render.h"
#include "relief/scene.h"

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

/// Polygons that a linear tree of 30 bits needs more than 30 levels for: 30 of which each splits off the
/// rest, which are `count` small ones of one code.
inline Scene make_deep_polygons(uint32_t count) {
    Scene scene;
    Mesh& mesh = scene.meshes.emplace_back();
    const auto add = [&](const Vec3f& place, float size) {
        for (const Vec3f& corner : {Vec3f{0, 0, 0}, Vec3f{1, 0, 0.2f}, Vec3f{0, 1, 0.1f}}) {
            mesh.position_indices.push_back(uint32_t(mesh.positions.size()));
            mesh.positions.push_back(corner * size + place);
        }
        mesh.face_sizes.push_back(3);
    };
    // One for each bit of a code.
    for (int k = 0; k < 10; ++k)
        for (int axis = 0; axis < 3; ++axis) {
            Vec3f place{};
            set_component(place, axis, std::ldexp(1.0f, -k));
            add(place, std::ldexp(0.05f, -k));
        }
    for (uint32_t k = 0; k < count; ++k) {
        const float place = std::ldexp(float(k + 1) / float(count), -11);
        add({place, place, place}, std::ldexp(1.0f, -14));
    }
    scene.objects.emplace_back();
    return scene;
}

} // namespace relief::test
