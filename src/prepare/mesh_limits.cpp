#include "prepare/mesh_limits.h"

#include "base/parallel.h"
#include "prepare/surface_recipe.h"

namespace relief {

namespace {

/// Limit surfaces of meshes with more faces than this in all are not kept from the maps to the surfaces:
/// each face takes a few hundred bytes.
constexpr uint64_t kMostKeptFaces = 1 << 18;

std::unique_ptr<const SubdivisionMesh> make_limit(const Mesh& mesh) {
    return std::make_unique<const SubdivisionMesh>(make_polygons(mesh, Welding::equal_points),
                                                   mesh.subdivision);
}

} // namespace

MeshLimits::MeshLimits(const Scene& scene) : scene_(scene), entries_(scene.meshes.size()) {}
MeshLimits::~MeshLimits() = default;

void MeshLimits::make_outlines(std::span<const uint32_t> meshes) {
    uint64_t faces = 0;
    for (const uint32_t mesh : meshes) faces += scene_.meshes[mesh].face_sizes.size();
    parallel_for("outlines", meshes.size(), 1, [&](size_t begin, size_t end) {
        for (size_t k = begin; k < end; ++k) {
            const Mesh& mesh = scene_.meshes[meshes[k]];
            Entry& entry = entries_[meshes[k]];
            if (entry.outlines) continue;
            if (!has_curved_outlines(mesh)) {
                entry.outlines = std::make_unique<const UvOutlines>(make_uv_outlines(mesh));
                continue;
            }
            std::unique_ptr<const SubdivisionMesh> limit = make_limit(mesh);
            entry.outlines = std::make_unique<const UvOutlines>(make_uv_outlines(*limit));
            if (faces <= kMostKeptFaces) entry.limit = std::move(limit);
        }
    });
}

const SubdivisionMesh* MeshLimits::find_or_make(uint32_t mesh) {
    Entry& entry = entries_[mesh];
    if (!entry.limit && is_subdivided_by_view(scene_.meshes[mesh]))
        entry.limit = make_limit(scene_.meshes[mesh]);
    return entry.limit.get();
}

} // namespace relief
