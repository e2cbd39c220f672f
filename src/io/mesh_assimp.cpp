#include "io/mesh_assimp.h"

#include <array>
#include <bit>
#include <unordered_map>

#include <assimp/Importer.hpp>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include "relief/error.h"

namespace relief {

namespace {

/// Gives equal values one index: closed meshes that were stored corner by corner become closed again.
template <class Value, size_t N> class Welder {
  public:
    explicit Welder(std::vector<Value>& values) : values_(values) {}

    uint32_t add(const Value& value, const std::array<float, N>& components) {
        std::array<uint32_t, N> key;
        for (size_t i = 0; i < N; ++i) key[i] = std::bit_cast<uint32_t>(components[i] + 0.0f); // -0 is 0
        const auto [found, is_new] = indices_.try_emplace(key, uint32_t(values_.size()));
        if (is_new) values_.push_back(value);
        return found->second;
    }

  private:
    struct Hash {
        size_t operator()(const std::array<uint32_t, N>& key) const {
            uint64_t hash = 0xcbf29ce484222325u;
            for (const uint32_t word : key) hash = (hash ^ word) * 0x9e3779b97f4a7c15u, hash ^= hash >> 29;
            return size_t(hash);
        }
    };
    std::vector<Value>& values_;
    std::unordered_map<std::array<uint32_t, N>, uint32_t, Hash> indices_;
};

class AssimpBuilder {
  public:
    AssimpBuilder(const aiScene& scene, std::string file)
        : scene_(scene),
          file_(std::move(file)),
          positions_(mesh_.positions),
          uvs_(mesh_.uvs),
          normals_(mesh_.normals) {}

    Mesh build() {
        for (unsigned m = 0; m < scene_.mNumMeshes; ++m) {
            const aiMesh& mesh = *scene_.mMeshes[m];
            if (!(mesh.mPrimitiveTypes & (aiPrimitiveType_TRIANGLE | aiPrimitiveType_POLYGON))) continue;
            if (mesh.HasTextureCoords(0))
                ++with_uv_;
            else
                ++without_uv_;
            if (!mesh.HasNormals()) has_normals_ = false;
        }
        if (with_uv_ > 0 && without_uv_ > 0)
            fail("some parts have uvs and some have none", "give every part uvs, or none");
        add_node(*scene_.mRootNode, aiMatrix4x4());
        return std::move(mesh_);
    }

  private:
    [[noreturn]] void fail(const std::string& message, const std::string& hint) const {
        throw Error(ErrorKind::bad_input, {message, file_, hint});
    }

    void add_node(const aiNode& node, const aiMatrix4x4& world_from_parent) {
        const aiMatrix4x4 world_from_node = world_from_parent * node.mTransformation;
        for (unsigned m = 0; m < node.mNumMeshes; ++m)
            add_mesh(*scene_.mMeshes[node.mMeshes[m]], world_from_node);
        for (unsigned c = 0; c < node.mNumChildren; ++c) add_node(*node.mChildren[c], world_from_node);
    }

    void add_mesh(const aiMesh& mesh, const aiMatrix4x4& world_from_node) {
        aiMatrix3x3 normal_matrix(world_from_node);
        const bool is_mirrored = normal_matrix.Determinant() < 0;
        normal_matrix.Inverse().Transpose();
        for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
            const aiFace& face = mesh.mFaces[f];
            if (face.mNumIndices < 3) continue;
            for (unsigned k = 0; k < face.mNumIndices; ++k) {
                // A mirror turns the winding round; the corners are walked backwards to keep the outside
                // outside.
                const unsigned corner = face.mIndices[is_mirrored ? face.mNumIndices - 1 - k : k];
                if (corner >= mesh.mNumVertices)
                    fail(fmt::format("face {} has an index out of range: {} of {}", f + 1, corner,
                                     mesh.mNumVertices),
                         "the file is damaged: export it again");
                add_corner(mesh, corner, world_from_node, normal_matrix);
            }
            mesh_.face_sizes.push_back(face.mNumIndices);
        }
    }

    void add_corner(const aiMesh& mesh, unsigned corner, const aiMatrix4x4& world_from_node,
                    const aiMatrix3x3& normal_matrix) {
        const aiVector3D p = world_from_node * mesh.mVertices[corner];
        mesh_.position_indices.push_back(positions_.add({p.x, p.y, p.z}, {p.x, p.y, p.z}));
        if (mesh.HasTextureCoords(0)) {
            const aiVector3D& uv = mesh.mTextureCoords[0][corner];
            mesh_.uv_indices.push_back(uvs_.add({uv.x, uv.y}, {uv.x, uv.y}));
        }
        if (has_normals_) {
            const aiVector3D n = normal_matrix * mesh.mNormals[corner];
            mesh_.normal_indices.push_back(normals_.add({n.x, n.y, n.z}, {n.x, n.y, n.z}));
        }
    }

    const aiScene& scene_;
    std::string file_;
    Mesh mesh_;
    Welder<Vec3f, 3> positions_;
    Welder<Vec2f, 2> uvs_;
    Welder<Vec3f, 3> normals_;
    int with_uv_ = 0, without_uv_ = 0;
    bool has_normals_ = true;
};

} // namespace

Mesh read_assimp_mesh(const std::filesystem::path& file) {
    Assimp::Importer importer;
    const aiScene* scene = importer.ReadFile(file.string(), aiProcess_ValidateDataStructure);
    if (!scene || !scene->mRootNode)
        throw Error(ErrorKind::bad_input, {fmt::format("cannot be read: {}", importer.GetErrorString()),
                                           file.string(), "the file is damaged: export it again"});
    return AssimpBuilder(*scene, file.string()).build();
}

} // namespace relief
