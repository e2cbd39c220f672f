// A mesh of an FBX file as its blend shapes and bones have it.
#pragma once

#include <vector>

#include <assimp/mesh.h>

#include "io/mesh/assimp_nodes.h"

namespace relief {

/// Refers to the mesh and the facts.
class PosedMesh {
  public:
    PosedMesh(const aiMesh& mesh, const MeshPlace& place, const FbxFacts& facts, const NodePlaces& places);

    bool is_mirrored() const { return is_mirrored_; }
    aiVector3D compute_position(unsigned vertex) const;
    aiVector3D compute_normal(unsigned vertex) const; ///< of any length

  private:
    void add_shapes(const FbxFacts& facts);
    void add_bones(const MeshPlace& place, const NodePlaces& places);
    const aiMatrix4x4& get_matrix(unsigned vertex) const {
        return matrices_.empty() ? world_from_mesh_ : matrices_[vertex];
    }

    struct Shape {
        const aiAnimMesh* mesh;
        float weight;
    };

    const aiMesh& mesh_;
    aiMatrix4x4 world_from_mesh_;
    std::vector<Shape> shapes_;
    std::vector<aiMatrix4x4> matrices_; ///< of each vertex; none without bones
    aiMatrix3x3 normal_matrix_;         ///< without bones
    bool is_mirrored_ = false;
};

} // namespace relief
