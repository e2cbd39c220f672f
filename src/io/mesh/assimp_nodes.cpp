#include "io/mesh/assimp_nodes.h"

#include <array>
#include <numbers>
#include <string_view>

namespace relief {

namespace {

constexpr std::string_view kChainMark = "_$AssimpFbx$_"; ///< in names of parts of a chain

/// Turns by angles in degrees around x, then y, then z.
aiMatrix4x4 make_xyz_turn(const std::array<double, 3>& degrees) {
    constexpr double kRadians = std::numbers::pi / 180;
    aiMatrix4x4 x, y, z;
    aiMatrix4x4::RotationX(float(degrees[0] * kRadians), x);
    aiMatrix4x4::RotationY(float(degrees[1] * kRadians), y);
    aiMatrix4x4::RotationZ(float(degrees[2] * kRadians), z);
    return z * y * x;
}

aiVector3D multiply(const aiVector3D& a, const aiVector3D& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }

aiMatrix4x4 make_scaling(const aiVector3D& scale) {
    aiMatrix4x4 matrix;
    return aiMatrix4x4::Scaling(scale, matrix);
}

/// Lengths of the columns; a mirror counts as one of x.
aiVector3D find_scale(const aiMatrix4x4& m) {
    aiVector3D scale(aiVector3D(m.a1, m.b1, m.c1).Length(), aiVector3D(m.a2, m.b2, m.c2).Length(),
                     aiVector3D(m.a3, m.b3, m.c3).Length());
    if (aiMatrix3x3(m).Determinant() < 0) scale.x = -scale.x;
    return scale;
}

/// Without its scale. A column of zeros stays.
aiMatrix4x4 remove_scale(const aiMatrix4x4& matrix, const aiVector3D& scale) {
    const auto invert = [](float value) { return value == 0 ? 1.0f : 1 / value; };
    return matrix * make_scaling({invert(scale.x), invert(scale.y), invert(scale.z)});
}

/// All that the children of a node inherit from it.
struct State {
    aiMatrix4x4 world_from_node, world_from_unscaled;
    aiVector3D scale{1, 1, 1};           ///< with that of nodes above which it has taken over
    aiVector3D inherited_scale{1, 1, 1}; ///< the latter alone
};

State combine(const State& parent, const aiMatrix4x4& local, FbxInherit inherit) {
    State state;
    const aiVector3D scale = find_scale(local);
    const aiMatrix4x4 unscaled = remove_scale(local, scale);
    if (inherit == FbxInherit::before_rotation) {
        state.scale = scale;
        state.world_from_node = parent.world_from_node * local;
        state.world_from_unscaled = parent.world_from_node * unscaled;
        return state;
    }
    state.inherited_scale = inherit == FbxInherit::behind_rotation ? parent.scale : parent.inherited_scale;
    state.scale = multiply(scale, state.inherited_scale);
    aiMatrix4x4 moved = unscaled;
    moved.a4 *= parent.scale.x, moved.b4 *= parent.scale.y, moved.c4 *= parent.scale.z;
    state.world_from_unscaled = parent.world_from_unscaled * moved;
    state.world_from_node = state.world_from_unscaled * make_scaling(state.scale);
    return state;
}

class NodePlacer {
  public:
    explicit NodePlacer(const FbxFacts& facts) : facts_(facts) {}

    /// `local` and `geometric`: of the chain so far.
    void visit(const aiNode& node, const State& parent, aiMatrix4x4 local, aiMatrix4x4 geometric) {
        const std::string_view name = node.mName.C_Str();
        const FbxNode* facts = facts_.find_node(name);
        const size_t mark = name.find(kChainMark);
        if (mark != std::string_view::npos) {
            const std::string_view part = name.substr(mark + kChainMark.size());
            if (part == "GeometricRotation" && facts)
                geometric = geometric * make_xyz_turn(facts->geometric_rotation);
            else if (part.starts_with("Geometric") && !part.ends_with("Inverse"))
                geometric = geometric * node.mTransformation;
            else if (!part.starts_with("Geometric"))
                local = local * node.mTransformation;
            visit_children(node, parent, local, geometric);
            return;
        }
        const State state = combine(parent, local * node.mTransformation,
                                    facts ? facts->inherit : FbxInherit::before_rotation);
        placed_.nodes.push_back({&node, facts, {state.world_from_node * geometric, geometric}});
        placed_.places.try_emplace(std::string(name), state.world_from_node);
        visit_children(node, state, {}, {});
    }

    PlacedNodes take() { return std::move(placed_); }

  private:
    void visit_children(const aiNode& node, const State& parent, const aiMatrix4x4& local,
                        const aiMatrix4x4& geometric) {
        for (unsigned c = 0; c < node.mNumChildren; ++c) visit(*node.mChildren[c], parent, local, geometric);
    }

    const FbxFacts& facts_;
    PlacedNodes placed_;
};

} // namespace

PlacedNodes place_nodes(const aiNode& root, const aiMatrix4x4& world_from_file, const FbxFacts& facts) {
    State world;
    world.world_from_node = world.world_from_unscaled = world_from_file;
    NodePlacer placer(facts);
    placer.visit(root, world, {}, {});
    return placer.take();
}

} // namespace relief
