// Limit surfaces of the meshes of a scene, so that maps and surfaces of one mesh share what is made of it.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "relief/scene.h"
#include "surface/mesh/uv_outlines.h"

namespace relief {

/// Refers to the meshes. Several threads may ask for different meshes at once.
class MeshLimits {
  public:
    explicit MeshLimits(const std::vector<Mesh>& meshes);
    ~MeshLimits();

    /// Makes the outlines of these meshes where they are not there yet, of several meshes at once. Throws as
    /// make_surface() where subdivision fails.
    void make_outlines(std::span<const uint32_t> meshes);
    const UvOutlines& outlines(uint32_t mesh) const { return *entries_[mesh].outlines; }
    void release_outlines();

    /// The limit surface of a mesh whose levels are automatic, without further uv sets; null if the mesh has
    /// another one, or if nothing but one surface needs it.
    const SubdivisionMesh* find(uint32_t mesh) const { return entries_[mesh].limit.get(); }
    const SubdivisionMesh* find_or_make(uint32_t mesh);
    /// Frees what is kept of a mesh.
    void release(uint32_t mesh) { entries_[mesh] = {}; }

  private:
    struct Entry {
        std::unique_ptr<const SubdivisionMesh> limit;
        std::unique_ptr<const UvOutlines> outlines;
    };
    const std::vector<Mesh>& meshes_;
    std::vector<Entry> entries_;
    uint64_t kept_faces_ = 0; ///< of meshes whose limits are kept
};

} // namespace relief
