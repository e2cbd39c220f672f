#include "io/mesh/mesh_assimp.h"

#include <exception>
#include <new>

#include <assimp/Importer.hpp>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include "io/mesh/assimp_axes.h"
#include "io/mesh/further_uvs.h"
#include "io/mesh/welder.h"
#include "relief/error.h"

namespace relief {

namespace {

class AssimpBuilder {
  public:
    AssimpBuilder(const aiScene& scene, const aiMatrix4x4& turn_axes, std::string file,
                  const MeshReadOptions& options)
        : scene_(scene),
          turn_axes_(turn_axes),
          file_(std::move(file)),
          uv_set_(unsigned(options.uv_set)),
          further_(options),
          positions_(mesh_.positions),
          uvs_(mesh_.uvs),
          normals_(mesh_.normals) {}

    Mesh build() {
        for (unsigned m = 0; m < scene_.mNumMeshes; ++m) {
            const aiMesh& mesh = *scene_.mMeshes[m];
            if (!(mesh.mPrimitiveTypes & (aiPrimitiveType_TRIANGLE | aiPrimitiveType_POLYGON))) continue;
            if (mesh.HasTextureCoords(uv_set_)) ++with_uv_;
            if (!mesh.HasNormals()) has_normals_ = false;
        }
        if (uv_set_ > 0 && with_uv_ == 0)
            fail(fmt::format("has no uv set {}", uv_set_), "sets are counted from 0");
        add_node(*scene_.mRootNode, turn_axes_);
        if (mesh_.uvs.empty()) mesh_.uv_indices.clear(); // no node has a part with uvs
        mesh_.uv_set = int(uv_set_);
        mesh_.further_uvs = further_.take();
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
                // A mirror turns the winding round: corners are walked backwards.
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
        mesh_.position_indices.push_back(positions_.add({p.x, p.y, p.z}));
        if (mesh.HasTextureCoords(uv_set_)) {
            const aiVector3D& uv = mesh.mTextureCoords[uv_set_][corner];
            mesh_.uv_indices.push_back(uvs_.add({uv.x, uv.y}));
        } else if (with_uv_ > 0) {
            mesh_.uv_indices.push_back(kNoIndex);
        }
        for (size_t n = 0; n < further_.numbers().size(); ++n) {
            const auto set = unsigned(further_.numbers()[n]);
            if (mesh.HasTextureCoords(set))
                further_.add_corner(n,
                                    {mesh.mTextureCoords[set][corner].x, mesh.mTextureCoords[set][corner].y});
            else
                further_.add_corner_without(n);
        }
        if (has_normals_) {
            const aiVector3D n = normal_matrix * mesh.mNormals[corner];
            mesh_.normal_indices.push_back(normals_.add({n.x, n.y, n.z}));
        }
    }

    const aiScene& scene_;
    aiMatrix4x4 turn_axes_;
    std::string file_;
    unsigned uv_set_;
    FurtherUvs further_;
    Mesh mesh_;
    PointWelder positions_;
    UvWelder uvs_;
    PointWelder normals_;
    int with_uv_ = 0; ///< parts
    bool has_normals_ = true;
};

/// The importer catches every exception and keeps it.
void rethrow_out_of_memory(const std::exception_ptr& kept) {
    if (!kept) return;
    try {
        std::rethrow_exception(kept);
    } catch (const std::bad_alloc&) {
        throw;
    } catch (...) { // has become the importer's error text
    }
}

} // namespace

Mesh read_assimp_mesh(const std::filesystem::path& file, const MeshReadOptions& options,
                      std::vector<std::string>& warnings) {
    Assimp::Importer importer;
    const aiScene* scene = importer.ReadFile(file.string(), aiProcess_ValidateDataStructure);
    if (!scene) rethrow_out_of_memory(importer.GetException());
    if (!scene || !scene->mRootNode)
        throw Error(ErrorKind::bad_input, {fmt::format("cannot be read: {}", importer.GetErrorString()),
                                           file.string(), "the file is damaged: export it again"});
    warn_of_unit(*scene, file.string(), warnings);
    return AssimpBuilder(*scene, find_turn_of_axes(*scene, file.string(), warnings), file.string(), options)
        .build();
}

} // namespace relief
