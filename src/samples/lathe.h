// Closed bodies of revolution made of quads only: a tube of 4k columns, its two ends closed by k x k quads
// each, so that no quad and no uv degenerates at the poles.
#pragma once

#include <vector>

#include "samples/shapes.h"

namespace relief::samples {

/// A place on a body: where it is, and which way its frame looks.
struct BodyPoint {
    float theta = 0; ///< angle about the y axis, radians; 0 is +x, a quarter turn is -z
    Vec3f position;
    Vec3f around; ///< unit, towards greater theta
    Vec3f along;  ///< unit, along the profile from the bottom pole
    Vec3f normal; ///< unit, outward
    float radius() const;
};

/// Profile, cells and map layout of a lathe body.
struct LatheShape {
    std::vector<Vec2f>
        profile;        ///< (radius, y) control points from the bottom pole to the top pole, radius 0 at both
    int cap_cells = 10; ///< k, even
    int rows = 15;      ///< quads along the tube
    float cap_share = 0.2f; ///< of the arc length, at either end
    float tiles = 0;        ///< 0: an atlas (tube above, caps below); else copies of a tile along the tube
};

class LatheBody {
  public:
    explicit LatheBody(const LatheShape& shape);

    /// Faces of the mesh: 2 k^2 + 4 k rows.
    int patch_count() const {
        return 2 * shape_.cap_cells * shape_.cap_cells + 4 * shape_.cap_cells * shape_.rows;
    }

    /// `s`: arc length from the bottom pole over that of the whole profile, [0, 1].
    BodyPoint point_at(float theta, float s) const;

    /// Place that a uv of the atlas belongs to; outside of the charts the nearest chart goes on.
    BodyPoint point_at_uv(const Vec2f& uv) const;

    /// Unit tangent (towards greater u) of the chart at a uv of the atlas, at right angles to `point.normal`.
    Vec3f tangent_at_uv(const Vec2f& uv, const BodyPoint& point) const;

    Mesh make_mesh(const std::string& name, const Deformation& deform) const;

  private:
    void add_tube(Mesh& mesh) const;
    void add_cap(Mesh& mesh, bool is_top) const;
    uint32_t ring_vertex(int column, bool is_top) const;
    Vec2f cap_uv(const Vec2f& square, bool is_top) const;

    LatheShape shape_;
    std::vector<Vec2f> samples_; ///< profile at even steps of arc length
};

} // namespace relief::samples
