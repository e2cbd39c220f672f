#include "surface/vertex_frames.h"

#include <cmath>

namespace relief {

namespace {

using Vec3d = Vec3<double>;

Vec3d to_double(const Vec3f& a) { return {a.x, a.y, a.z}; }

double compute_length(const Vec3d& a) { return std::sqrt(dot(a, a)); }

/// Unit vector, or zero.
Vec3d normalize_double(const Vec3d& a) {
    const double size = compute_length(a);
    return size > 0 ? Vec3d{a.x / size, a.y / size, a.z / size} : Vec3d{};
}

Vec3f to_float(const Vec3d& a) { return {float(a.x), float(a.y), float(a.z)}; }

/// A unit vector at right angles to `n` (Duff et al. 2017, Building an Orthonormal Basis, Revisited).
Vec3d make_perpendicular(const Vec3d& n) {
    const double sign = std::copysign(1.0, n.z);
    const double a = -1 / (sign + n.z);
    return {1 + sign * n.x * n.x * a, sign * n.x * n.y * a, -sign * n.x};
}

/// The two edges that leave corner k of a patch, and the angle between them.
struct Corner {
    Vec3d to_next, to_previous;
    double angle;
};

Corner make_corner(const Surface& surface, size_t patch, int k) {
    const Quad& quad = surface.quads[patch];
    const Vec3d p = to_double(surface.positions[quad.vertex[k]]);
    Corner corner;
    if (surface.controls.empty()) {
        corner.to_next = to_double(surface.positions[quad.vertex[(k + 1) & 3]]) - p;
        corner.to_previous = to_double(surface.positions[quad.vertex[(k + 3) & 3]]) - p;
    } else {
        // A cubic leaves its end towards the next control point.
        const InnerControls& controls = surface.controls[patch];
        corner.to_next = (to_double(controls[size_t(2 * k)]) - p) * 3.0;
        corner.to_previous = (to_double(controls[size_t(2 * ((k + 3) & 3) + 1)]) - p) * 3.0;
    }
    corner.angle = std::atan2(compute_length(cross(corner.to_next, corner.to_previous)),
                              dot(corner.to_next, corner.to_previous));
    return corner;
}

/// Sums of the points' normals, kept at their dominant vertices.
std::vector<Vec3d> sum_normals(const Surface& surface) {
    std::vector<Vec3d> sums(surface.positions.size());
    for (size_t patch = 0; patch < surface.quads.size(); ++patch)
        for (int k = 0; k < 4; ++k) {
            const Corner corner = make_corner(surface, patch, k);
            Vec3d normal = normalize_double(cross(corner.to_next, corner.to_previous));
            sums[surface.dominant(surface.quads[patch].vertex[k])] += normal * corner.angle;
        }
    return sums;
}

/// Direction of growing u at corner k, in the plane of `normal`; zero where the uvs do not tell.
Vec3d compute_u_direction(const Surface& surface, const Quad& quad, int k, const Corner& corner,
                          const Vec3d& normal) {
    const Vec2f &uv = surface.uvs[quad.vertex[k]], &next = surface.uvs[quad.vertex[(k + 1) & 3]],
                &previous = surface.uvs[quad.vertex[(k + 3) & 3]];
    const double du_next = double(next.x) - uv.x, dv_next = double(next.y) - uv.y;
    const double du_previous = double(previous.x) - uv.x, dv_previous = double(previous.y) - uv.y;
    const double determinant = du_next * dv_previous - du_previous * dv_next;
    if (determinant == 0) return {};
    const Vec3d direction =
        (corner.to_next * dv_previous - corner.to_previous * dv_next) * (determinant < 0 ? -1.0 : 1.0);
    return normalize_double(direction - normal * dot(normal, direction));
}

} // namespace

double compute_uv_area(const std::array<Vec2f, 4>& uvs) {
    const double ax = double(uvs[2].x) - uvs[0].x, ay = double(uvs[2].y) - uvs[0].y;
    const double bx = double(uvs[3].x) - uvs[1].x, by = double(uvs[3].y) - uvs[1].y;
    return (ax * by - ay * bx) / 2;
}

void compute_vertex_frames(Surface& surface, const std::vector<float>& handedness,
                           const std::vector<Vec3f>& known_normals) {
    std::vector<Vec3d> normals;
    for (const Vec3f& normal : known_normals) normals.push_back(to_double(normal));
    if (known_normals.empty()) normals = sum_normals(surface);
    for (Vec3d& normal : normals) {
        normal = normalize_double(normal);
        if (normal == Vec3d{}) normal = {0, 0, 1};
    }
    std::vector<Vec3d> tangents;
    if (surface.map.is_tangent) {
        tangents.resize(surface.positions.size());
        for (size_t patch = 0; patch < surface.quads.size(); ++patch)
            for (int k = 0; k < 4; ++k) {
                const Quad& quad = surface.quads[patch];
                const Corner corner = make_corner(surface, patch, k);
                const Vec3d& normal = normals[surface.dominant(quad.vertex[k])];
                tangents[quad.vertex[k]] +=
                    compute_u_direction(surface, quad, k, corner, normal) * corner.angle;
            }
    }
    surface.frames.resize(surface.positions.size());
    for (uint32_t vertex = 0; vertex < surface.frames.size(); ++vertex) {
        const Vec3d& normal = normals[surface.dominant(vertex)];
        if (tangents.empty()) {
            surface.frames[vertex] = {pack_frame(to_float(normal), {}, 1).normal, 0};
            continue;
        }
        Vec3d tangent = normalize_double(tangents[vertex]);
        if (tangent == Vec3d{}) tangent = make_perpendicular(normal);
        surface.frames[vertex] = pack_frame(to_float(normal), to_float(tangent), handedness[vertex]);
    }
}

} // namespace relief
