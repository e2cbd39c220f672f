// The tables of layers and glass as kernels of shading read them: those of the scene, and behind them numbers
// of the vertices at work, where textures change them.
#pragma once

#include <vector>

#include "cpu/shading/point_material.h"
#include "cpu/shading/shading_kernels.h"

namespace relief::cpu {

class VertexInputs {
  public:
    /// For up to `vertex_count` vertices at once. Copies the scene's tables, if textures change them.
    VertexInputs(const PreparedScene& scene, size_t vertex_count);

    /// Changes the material of vertex `n` to what the textures make of it at a hit, whose uv in the mesh's
    /// own set is given, if it has some.
    void set(size_t n, const TraceHit& hit, const Vec2f& uv, PointMaterial& material) {
        if (scene_.textured.has_vertex_numbers) set_textured(n, hit, uv, material);
    }

    LayerView layers() const;
    const scalar::GlassParameters* glass() const { return has_glass_ ? glass_.data() : records().data(); }
    /// The scene's record behind an index into glass().
    uint32_t find_glass_record(uint32_t index) const {
        return index < records().size() ? index : glass_of_vertex_[index - records().size()];
    }

  private:
    const std::vector<scalar::GlassParameters>& records() const { return scene_.glass.records; }
    void set_textured(size_t n, const TraceHit& hit, const Vec2f& uv, PointMaterial& material);

    const PreparedScene& scene_;
    bool has_layers_ = false, has_glass_ = false; ///< of vertices
    std::vector<scalar::LayerParameters> layers_;
    std::vector<Vec2f> entries_;
    std::vector<scalar::GlassParameters> glass_;
    std::vector<uint32_t> glass_of_vertex_;
};

} // namespace relief::cpu
