#include "io/mesh/assimp_pose.h"

#include <cmath>
#include <map>
#include <string_view>

namespace relief {

namespace {

aiMatrix3x3 make_normal_matrix(const aiMatrix4x4& matrix) {
    aiMatrix3x3 normal_matrix(matrix);
    normal_matrix.Inverse().Transpose();
    return normal_matrix;
}

void add_scaled(aiMatrix4x4& sum, const aiMatrix4x4& matrix, float weight) {
    for (unsigned row = 0; row < 4; ++row)
        for (unsigned column = 0; column < 4; ++column) sum[row][column] += weight * matrix[row][column];
}

} // namespace

PosedMesh::PosedMesh(const aiMesh& mesh, const MeshPlace& place, const FbxFacts& facts,
                     const NodePlaces& places)
    : mesh_(mesh), world_from_mesh_(place.world_from_mesh) {
    add_shapes(facts);
    add_bones(place, places);
    normal_matrix_ = make_normal_matrix(world_from_mesh_);
    is_mirrored_ = mesh.mNumVertices > 0 && aiMatrix3x3(get_matrix(0)).Determinant() < 0;
}

void PosedMesh::add_shapes(const FbxFacts& facts) {
    std::map<const std::vector<float>*, size_t> seen; // shapes of each channel
    for (unsigned k = 0; k < mesh_.mNumAnimMeshes; ++k) {
        const aiAnimMesh& shape = *mesh_.mAnimMeshes[k];
        const std::vector<float>* weights = facts.find_channel(shape.mName.C_Str());
        if (!weights) continue;
        const size_t place = seen[weights]++;
        const float weight = place < weights->size() ? (*weights)[place] : 0.0f;
        if (weight != 0 && shape.HasPositions() && shape.mNumVertices == mesh_.mNumVertices)
            shapes_.push_back({&shape, weight});
    }
}

void PosedMesh::add_bones(const MeshPlace& place, const NodePlaces& places) {
    const aiMatrix4x4 none(0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0);
    std::vector<float> sums;
    for (unsigned b = 0; b < mesh_.mNumBones; ++b) {
        const aiBone& bone = *mesh_.mBones[b];
        const auto found = places.find(std::string_view(bone.mName.C_Str()));
        if (found == places.end()) continue;
        if (matrices_.empty()) matrices_.assign(mesh_.mNumVertices, none), sums.resize(mesh_.mNumVertices);
        const aiMatrix4x4 matrix = found->second * bone.mOffsetMatrix * place.node_from_mesh;
        for (unsigned w = 0; w < bone.mNumWeights; ++w) {
            const auto [vertex, weight] = bone.mWeights[w];
            if (vertex >= mesh_.mNumVertices || !std::isfinite(weight)) continue;
            add_scaled(matrices_[vertex], matrix, weight), sums[vertex] += weight;
        }
    }
    for (size_t vertex = 0; vertex < sums.size(); ++vertex) {
        if (sums[vertex] > 0) {
            aiMatrix4x4 mean = none;
            add_scaled(mean, matrices_[vertex], 1 / sums[vertex]);
            matrices_[vertex] = mean;
        } else {
            matrices_[vertex] = world_from_mesh_;
        }
    }
}

aiVector3D PosedMesh::compute_position(unsigned vertex) const {
    const aiVector3D& rest = mesh_.mVertices[vertex];
    aiVector3D position = rest;
    for (const Shape& shape : shapes_) position += (shape.mesh->mVertices[vertex] - rest) * shape.weight;
    return get_matrix(vertex) * position;
}

aiVector3D PosedMesh::compute_normal(unsigned vertex) const {
    const aiVector3D& rest = mesh_.mNormals[vertex];
    aiVector3D normal = rest;
    for (const Shape& shape : shapes_)
        if (shape.mesh->HasNormals()) normal += (shape.mesh->mNormals[vertex] - rest) * shape.weight;
    return (matrices_.empty() ? normal_matrix_ : make_normal_matrix(matrices_[vertex])) * normal;
}

} // namespace relief
