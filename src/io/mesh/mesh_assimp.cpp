#include "io/mesh/mesh_assimp.h"

#include <exception>
#include <new>
#include <string_view>

#include <assimp/Importer.hpp>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include "io/mesh/assimp_axes.h"
#include "io/mesh/assimp_pose.h"
#include "io/mesh/fbx_source.h"
#include "io/mesh/further_uvs.h"
#include "io/mesh/name_list.h"
#include "io/mesh/welder.h"
#include "relief/error.h"

namespace relief {

namespace {

/// Positions of the mesh by the points of a node's meshes before they are bent and placed.
class RestPoints {
  public:
    RestPoints() : welder_(points_) {}
    RestPoints(const RestPoints&) = delete;
    RestPoints& operator=(const RestPoints&) = delete;

    void add(const Vec3f& point, uint32_t position) {
        if (welder_.add(point) == positions_.size()) positions_.push_back(position);
    }
    /// kNoIndex where no face has the point.
    uint32_t find(const Vec3f& point) {
        const uint32_t place = welder_.add(point);
        return place < positions_.size() ? positions_[place] : kNoIndex;
    }

  private:
    std::vector<Vec3f> points_;
    PointWelder welder_;
    std::vector<uint32_t> positions_;
};

class AssimpBuilder {
  public:
    AssimpBuilder(const aiScene& scene, const aiMatrix4x4& turn_axes, std::string file,
                  const MeshReadOptions& options, const FbxFacts& facts)
        : scene_(scene),
          turn_axes_(turn_axes),
          file_(std::move(file)),
          uv_set_(unsigned(options.uv_set)),
          further_(options),
          facts_(facts),
          positions_(mesh_.positions),
          uvs_(mesh_.uvs),
          normals_(mesh_.normals) {}

    Mesh build() {
        for (unsigned m = 0; m < scene_.mNumMeshes; ++m) {
            const aiMesh& mesh = *scene_.mMeshes[m];
            if (!has_faces(mesh)) continue;
            if (mesh.HasTextureCoords(uv_set_)) ++with_uv_;
            if (!mesh.HasNormals()) has_normals_ = false;
        }
        if (uv_set_ > 0 && with_uv_ == 0)
            fail(fmt::format("has no uv set {}", uv_set_), "sets are counted from 0");
        placed_ = place_nodes(*scene_.mRootNode, turn_axes_, facts_);
        add_nodes();
        if (mesh_.face_sizes.empty()) refuse_without_faces();
        if (mesh_.uvs.empty()) mesh_.uv_indices.clear(); // no node has a part with uvs
        mesh_.uv_set = int(uv_set_);
        mesh_.further_uvs = further_.take();
        return std::move(mesh_);
    }

    /// Warns of parts of the file that do not show in the mesh.
    void add_warnings(std::vector<std::string>& warnings) const {
        if (!hidden_.empty())
            warnings.push_back(fmt::format("{}: hidden nodes with meshes are left out, {} of them: {}; show "
                                           "them before the export if they are wanted",
                                           file_, hidden_.size(), list_names(hidden_)));
        if (!facts_.surfaces.empty())
            warnings.push_back(
                fmt::format("{}: surfaces that are no polygons (NURBS, patches) are not read, {} of "
                            "them: {}; convert them to polygons before the export",
                            file_, facts_.surfaces.size(), list_names(facts_.surfaces)));
        for (const std::string& text : facts_.warnings) warnings.push_back(file_ + ": " + text);
    }

  private:
    [[noreturn]] void fail(const std::string& message, const std::string& hint) const {
        throw Error(ErrorKind::bad_input, {message, file_, hint});
    }

    [[noreturn]] void refuse_without_faces() const {
        if (!hidden_.empty())
            fail(fmt::format("all its nodes with meshes are hidden: {}", list_names(hidden_)),
                 "show them before the export");
        if (!facts_.surfaces.empty())
            fail(fmt::format("the mesh has no faces, only surfaces that are no polygons: {}",
                             list_names(facts_.surfaces)),
                 "convert them to polygons before the export");
        fail("the mesh has no faces", "export the polygons as well");
    }

    static bool has_faces(const aiMesh& mesh) {
        return (mesh.mPrimitiveTypes & (aiPrimitiveType_TRIANGLE | aiPrimitiveType_POLYGON)) != 0;
    }

    void add_nodes() {
        for (const PlacedNode& placed : placed_.nodes) {
            if (!placed.facts || !placed.facts->is_hidden)
                add_meshes(placed);
            else if (holds_faces(*placed.node))
                hidden_.push_back(placed.facts->name);
        }
    }

    bool holds_faces(const aiNode& node) const {
        for (unsigned m = 0; m < node.mNumMeshes; ++m)
            if (has_faces(*scene_.mMeshes[node.mMeshes[m]])) return true;
        return false;
    }

    void add_meshes(const PlacedNode& placed) {
        RestPoints points;
        const bool has_creases = placed.facts && !placed.facts->creases.empty();
        for (unsigned m = 0; m < placed.node->mNumMeshes; ++m)
            add_mesh(*scene_.mMeshes[placed.node->mMeshes[m]], placed.place, has_creases ? &points : nullptr);
        if (!has_creases) return;
        for (const FbxCrease& crease : placed.facts->creases) {
            const uint32_t first = points.find(crease.first), second = points.find(crease.second);
            if (first != kNoIndex && second != kNoIndex)
                mesh_.creases.push_back({first, second, crease.sharpness});
        }
    }

    void add_mesh(const aiMesh& mesh, const MeshPlace& place, RestPoints* points) {
        const PosedMesh posed(mesh, place, facts_, placed_.places);
        for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
            const aiFace& face = mesh.mFaces[f];
            if (face.mNumIndices < 3) continue;
            for (unsigned k = 0; k < face.mNumIndices; ++k) {
                // A mirror turns the winding round: corners are walked backwards.
                const unsigned corner = face.mIndices[posed.is_mirrored() ? face.mNumIndices - 1 - k : k];
                if (corner >= mesh.mNumVertices)
                    fail(fmt::format("face {} has an index out of range: {} of {}", f + 1, corner,
                                     mesh.mNumVertices),
                         "the file is damaged: export it again");
                add_corner(mesh, corner, posed);
                if (points) points->add(to_vector(mesh.mVertices[corner]), mesh_.position_indices.back());
            }
            mesh_.face_sizes.push_back(face.mNumIndices);
        }
    }

    static Vec3f to_vector(const aiVector3D& v) { return {v.x, v.y, v.z}; }

    void add_corner(const aiMesh& mesh, unsigned corner, const PosedMesh& posed) {
        mesh_.position_indices.push_back(positions_.add(to_vector(posed.compute_position(corner))));
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
        if (has_normals_)
            mesh_.normal_indices.push_back(normals_.add(to_vector(posed.compute_normal(corner))));
    }

    const aiScene& scene_;
    aiMatrix4x4 turn_axes_;
    std::string file_;
    unsigned uv_set_;
    FurtherUvs further_;
    const FbxFacts& facts_;
    PlacedNodes placed_;
    Mesh mesh_;
    PointWelder positions_;
    UvWelder uvs_;
    PointWelder normals_;
    int with_uv_ = 0; ///< parts
    bool has_normals_ = true;
    std::vector<std::string> hidden_; ///< nodes with faces
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
    const FbxSource source = read_fbx_source(file);
    Assimp::Importer importer;
    const aiScene* scene = importer.ReadFileFromMemory(source.bytes.data(), source.bytes.size(),
                                                       aiProcess_ValidateDataStructure, "fbx");
    if (!scene) rethrow_out_of_memory(importer.GetException());
    if (!scene || !scene->mRootNode)
        throw Error(ErrorKind::bad_input, {fmt::format("cannot be read: {}", importer.GetErrorString()),
                                           file.string(), "the file is damaged: export it again"});
    warn_of_unit(*scene, file.string(), warnings);
    AssimpBuilder builder(*scene, find_turn_of_axes(*scene, file.string(), warnings), file.string(), options,
                          source.facts);
    Mesh mesh = builder.build();
    builder.add_warnings(warnings);
    return mesh;
}

} // namespace relief
