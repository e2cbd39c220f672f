#include "prepare/mesh_limits.h"

#include "base/parallel.h"
#include "prepare/surface_recipe.h"

namespace relief {

namespace {

/// Limit surfaces of meshes with more faces than this in all are not kept from the maps to the surfaces:
/// each face takes a few hundred bytes.
constexpr uint64_t kMostKeptFaces = 1 << 18;

std::unique_ptr<const SubdivisionMesh> make_limit(const Mesh& mesh) {
    return std::make_unique<const SubdivisionMesh>(make_polygons(mesh, Welding::joined_points),
                                                   mesh.subdivision);
}

} // namespace

MeshLimits::MeshLimits(const std::vector<Mesh>& meshes) : meshes_(meshes), entries_(meshes.size()) {}
MeshLimits::~MeshLimits() = default;

void MeshLimits::make_outlines(std::span<const uint32_t> meshes) {
    std::vector<uint32_t> wanted;
    std::vector<bool> is_kept;
    for (const uint32_t mesh : meshes) {
        if (entries_[mesh].outlines) continue;
        wanted.push_back(mesh);
        const uint64_t faces = meshes_[mesh].face_sizes.size();
        is_kept.push_back(has_curved_outlines(meshes_[mesh]) && kept_faces_ + faces <= kMostKeptFaces);
        if (is_kept.back()) kept_faces_ += faces;
    }
    parallel_for("outlines", wanted.size(), 1, [&](size_t begin, size_t end) {
        for (size_t k = begin; k < end; ++k) {
            const Mesh& mesh = meshes_[wanted[k]];
            Entry& entry = entries_[wanted[k]];
            if (!has_curved_outlines(mesh)) {
                entry.outlines = std::make_unique<const UvOutlines>(make_uv_outlines(mesh));
                continue;
            }
            std::unique_ptr<const SubdivisionMesh> limit = make_limit(mesh);
            entry.outlines = std::make_unique<const UvOutlines>(make_uv_outlines(*limit));
            if (is_kept[k]) entry.limit = std::move(limit);
        }
    });
}

void MeshLimits::release_outlines() {
    for (Entry& entry : entries_) entry.outlines = nullptr;
}

const SubdivisionMesh* MeshLimits::find_or_make(uint32_t mesh) {
    Entry& entry = entries_[mesh];
    if (!entry.limit && is_subdivided_by_view(meshes_[mesh])) entry.limit = make_limit(meshes_[mesh]);
    return entry.limit.get();
}

} // namespace relief
