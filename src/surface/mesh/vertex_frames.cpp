#include "surface/mesh/vertex_frames.h"

namespace relief {

namespace {

/// A unit vector at right angles to `n` (Duff et al. 2017, Building an Orthonormal Basis, Revisited).
Vec3d make_perpendicular(const Vec3d& n) {
    const double sign = std::copysign(1.0, n.z);
    const double a = -1 / (sign + n.z);
    return {1 + sign * n.x * n.x * a, sign * n.x * n.y * a, -sign * n.x};
}

/// The two edges that leave a corner, and the angle between them.
struct Corner {
    Vec3d to_next, to_previous;
    double angle;
};

Corner make_corner(const Vec3d& to_next, const Vec3d& to_previous) {
    return {to_next, to_previous,
            std::atan2(compute_length(cross(to_next, to_previous)), dot(to_next, to_previous))};
}

/// Corner k of a patch.
Corner make_corner(const Surface& surface, size_t patch, int k) {
    const Quad quad = surface.quads[patch];
    const Vec3d p = to_double(surface.position(quad.vertex[k]));
    if (surface.controls.empty())
        return make_corner(to_double(surface.position(quad.vertex[(k + 1) & 3])) - p,
                           to_double(surface.position(quad.vertex[(k + 3) & 3])) - p);
    // A cubic leaves its end towards the next control point.
    const InnerControls& controls = surface.controls[patch];
    return make_corner((to_double(controls[size_t(2 * k)]) - p) * 3.0,
                       (to_double(controls[size_t(2 * ((k + 3) & 3) + 1)]) - p) * 3.0);
}

/// The map from the edges of a corner to derivatives by u and v: along_u = next * u_next + previous *
/// u_previous, over the determinant, which is 0 where the uvs do not tell.
struct CornerUvs {
    double du_next, dv_next, du_previous, dv_previous;
    double determinant() const { return du_next * dv_previous - du_previous * dv_next; }
};

CornerUvs measure_uvs(const Surface& surface, const Quad& quad, int k) {
    const Vec2f &uv = surface.uvs[quad.vertex[k]], &next = surface.uvs[quad.vertex[(k + 1) & 3]],
                &previous = surface.uvs[quad.vertex[(k + 3) & 3]];
    return {double(next.x) - uv.x, double(next.y) - uv.y, double(previous.x) - uv.x,
            double(previous.y) - uv.y};
}

/// Direction of growing u at corner k, in the plane of `normal`; zero where the uvs do not tell.
Vec3d compute_u_direction(const CornerUvs& uvs, const Corner& corner, const Vec3d& normal) {
    const double determinant = uvs.determinant();
    if (determinant == 0) return {};
    const Vec3d direction = (corner.to_next * uvs.dv_previous - corner.to_previous * uvs.dv_next) *
                            (determinant < 0 ? -1.0 : 1.0);
    return normalize_double(direction - normal * dot(normal, direction));
}

/// Calls visit(vertex, corner, uvs) for each corner of each patch.
template <class Visit> void visit_corners(const Surface& surface, const Visit& visit) {
    for (size_t patch = 0; patch < surface.quads.size(); ++patch)
        for (int k = 0; k < 4; ++k) {
            const Quad quad = surface.quads[patch];
            visit(quad.vertex[k], make_corner(surface, patch, k), measure_uvs(surface, quad, k));
        }
}

Vec3d get_normal(const VertexSources& sources, uint32_t vertex) {
    return sources.normals.empty() ? sources.point_normals[sources.points[vertex]]
                                   : to_double(sources.normals[vertex]);
}

/// Directions of growing u in the planes of the normals, not normalised.
std::vector<Vec3d> make_tangents(const Surface& surface, const VertexSources& sources) {
    std::vector<Vec3d> tangents(surface.vertex_count());
    for (uint32_t vertex = 0; vertex < sources.tangents.size(); ++vertex) {
        const std::array<float, 4>& given = sources.tangents[vertex];
        const Vec3d tangent{given[0], given[1], given[2]}, normal = get_normal(sources, vertex);
        tangents[vertex] = tangent - normal * dot(normal, tangent);
    }
    if (!sources.tangents.empty()) return tangents;
    visit_corners(surface, [&](uint32_t vertex, const Corner& corner, const CornerUvs& uvs) {
        tangents[vertex] += compute_u_direction(uvs, corner, get_normal(sources, vertex)) * corner.angle;
    });
    return tangents;
}

void fill_derivatives(Surface& surface, const VertexSources& sources) {
    surface.derivatives.resize(surface.vertex_count());
    for (size_t vertex = 0; vertex < sources.tangents.size(); ++vertex) {
        const std::array<float, 4>& given = sources.tangents[vertex];
        surface.derivatives[vertex] = {Vec3f{given[0], given[1], given[2]}, sources.bitangents[vertex]};
    }
    if (!sources.tangents.empty()) return;
    struct Sum {
        Vec3d along_u{}, along_v{};
        double angle = 0;
    };
    std::vector<Sum> sums(surface.vertex_count());
    visit_corners(surface, [&](uint32_t vertex, const Corner& corner, const CornerUvs& uvs) {
        const double determinant = uvs.determinant();
        if (determinant == 0) return;
        const double weight = corner.angle / determinant;
        Sum& sum = sums[vertex];
        sum.along_u += (corner.to_next * uvs.dv_previous - corner.to_previous * uvs.dv_next) * weight;
        sum.along_v += (corner.to_previous * uvs.du_next - corner.to_next * uvs.du_previous) * weight;
        sum.angle += corner.angle;
    });
    for (size_t vertex = 0; vertex < sums.size(); ++vertex) {
        const Sum& sum = sums[vertex];
        if (sum.angle > 0)
            surface.derivatives[vertex] = {to_float(sum.along_u * (1 / sum.angle)),
                                           to_float(sum.along_v * (1 / sum.angle))};
    }
}

} // namespace

double compute_uv_area(const std::array<Vec2f, 4>& uvs) {
    const double ax = double(uvs[2].x) - uvs[0].x, ay = double(uvs[2].y) - uvs[0].y;
    const double bx = double(uvs[3].x) - uvs[1].x, by = double(uvs[3].y) - uvs[1].y;
    return (ax * by - ay * bx) / 2;
}

std::vector<Vec3d> compute_point_normals(const Polygons& polygons, SummedNormals summed) {
    std::vector<Vec3d> normals(polygons.positions.size());
    for (uint32_t face = 0; face < polygons.face_count(); ++face) {
        const uint32_t start = polygons.starts[face], size = polygons.face_size(face);
        const auto position = [&](uint32_t k) {
            return to_double(polygons.positions[polygons.points[start + k % size]]);
        };
        Vec3d normal{};
        if (summed == SummedNormals::faces) normal = normalize_double(compute_newell_normal(polygons, face));
        for (uint32_t k = 0; k < size; ++k) {
            const Vec3d p = position(k);
            const Corner corner = make_corner(position(k + 1) - p, position(k + size - 1) - p);
            if (summed == SummedNormals::corners)
                normal = normalize_double(cross(corner.to_next, corner.to_previous));
            normals[polygons.points[start + k]] += normal * corner.angle;
        }
    }
    for (Vec3d& normal : normals) {
        normal = normalize_double(normal);
        if (normal == Vec3d{}) normal = {0, 0, 1};
    }
    return normals;
}

void compute_vertex_frames(Surface& surface, const VertexSources& sources) {
    const bool is_relative = surface.map.is_tangent && sources.lengths == FrameLengths::relative;
    if (is_relative) fill_derivatives(surface, sources);
    std::vector<Vec3d> tangents;
    if (surface.map.is_tangent && !is_relative) tangents = make_tangents(surface, sources);
    surface.frames.resize(surface.vertex_count());
    for (uint32_t vertex = 0; vertex < surface.frames.size(); ++vertex) {
        const Vec3d normal = get_normal(sources, vertex);
        if (tangents.empty()) {
            surface.frames[vertex] = {pack_frame(to_float(normal), {}, 1).normal, 0};
            continue;
        }
        Vec3d tangent = normalize_double(tangents[vertex]);
        if (tangent == Vec3d{}) tangent = make_perpendicular(normal);
        surface.frames[vertex] = pack_frame(to_float(normal), to_float(tangent), sources.handedness[vertex]);
    }
}

} // namespace relief
