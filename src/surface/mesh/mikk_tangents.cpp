#include "surface/mesh/mikk_tangents.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/parallel.h"
#include "surface/mesh/vertex_frames.h"

namespace relief {

namespace {

using Vec2d = Vec2<double>;

Vec3d project(const Vec3d& v, const Vec3d& normal) { return normalize_double(v - normal * dot(normal, v)); }

/// Derivatives of the position by u and by v on a triangle.
struct Derivatives {
    Vec3d along_u{}, along_v{};        ///< unit, or zero
    double u_length = 0, v_length = 0; ///< of the derivatives themselves
    double uv_area = 0;                ///< twice the signed one
};

struct Triangle {
    std::array<uint32_t, 3> corner{};
    bool is_turned = false;    ///< the uvs run clockwise
    bool is_free = false;      ///< uvs without area: no direction of its own, follows the others
    bool is_collapsed = false; ///< two corners at one point: joins nothing
};

/// The triangles of the polygons, and which corners are one vertex.
struct TriangleMesh {
    const Polygons& polygons;
    std::span<const Vec3d> point_normals;
    std::vector<Triangle> triangles;
    std::vector<uint32_t> vertices;     ///< one a corner
    std::vector<uint32_t> first_around; ///< of `around`, one a vertex and the end
    std::vector<uint32_t> around;       ///< 3 * triangle + number of its corner, rising around each vertex

    Vec3d position(uint32_t corner) const { return to_double(polygons.positions[polygons.points[corner]]); }
    Vec2d uv(uint32_t corner) const { return {polygons.uvs[corner].x, polygons.uvs[corner].y}; }
    Vec3d normal(uint32_t corner) const {
        return point_normals.empty() ? to_double(polygons.normals[corner])
                                     : point_normals[polygons.points[corner]];
    }
    uint32_t corner(uint32_t entry, uint32_t step = 0) const {
        return triangles[entry / 3].corner[(entry % 3 + step) % 3];
    }
};

Derivatives differentiate(const TriangleMesh& mesh, const Triangle& triangle) {
    const auto [a, b, c] = triangle.corner;
    const Vec3d p = mesh.position(b) - mesh.position(a), q = mesh.position(c) - mesh.position(a);
    const Vec2d s = mesh.uv(b) - mesh.uv(a), t = mesh.uv(c) - mesh.uv(a);
    Derivatives result;
    result.uv_area = s.x * t.y - s.y * t.x;
    const double sign = result.uv_area > 0 ? 1 : -1, size = std::fabs(result.uv_area);
    const Vec3d along_u = p * t.y - q * s.y, along_v = q * s.x - p * t.x;
    result.along_u = normalize_double(along_u) * sign;
    result.along_v = normalize_double(along_v) * sign;
    if (size == 0) return result;
    result.u_length = compute_length(along_u) / size;
    result.v_length = compute_length(along_v) / size;
    return result;
}

/// True where corners 0 and 2 are joined: the shorter diagonal in uv, on a tie the shorter one in space.
bool is_cut_from_first(const TriangleMesh& mesh, uint32_t start) {
    const auto measure = [&](uint32_t a, uint32_t b) {
        const Vec2d uv = mesh.uv(start + b) - mesh.uv(start + a);
        const Vec3d way = mesh.position(start + b) - mesh.position(start + a);
        return std::pair(uv.x * uv.x + uv.y * uv.y, dot(way, way));
    };
    return !(measure(1, 3) < measure(0, 2));
}

/// Finds out how the uvs of a triangle lie; returns their area without its sign.
double classify(const TriangleMesh& mesh, Triangle& triangle) {
    const std::vector<uint32_t>& points = mesh.polygons.points;
    const uint32_t a = points[triangle.corner[0]], b = points[triangle.corner[1]],
                   c = points[triangle.corner[2]];
    const Derivatives derivatives = differentiate(mesh, triangle);
    triangle.is_collapsed = a == b || b == c || c == a;
    triangle.is_turned = !(derivatives.uv_area > 0);
    triangle.is_free = !(derivatives.u_length > 0 && derivatives.v_length > 0);
    return std::fabs(derivatives.uv_area);
}

void add_triangles(TriangleMesh& mesh) {
    for (uint32_t face = 0; face < mesh.polygons.face_count(); ++face) {
        const uint32_t start = mesh.polygons.starts[face];
        if (mesh.polygons.face_size(face) == 3) {
            Triangle triangle{{start, start + 1, start + 2}};
            classify(mesh, triangle);
            mesh.triangles.push_back(triangle);
            continue;
        }
        const bool from_first = is_cut_from_first(mesh, start);
        Triangle first{{start, start + 1, from_first ? start + 2 : start + 3}};
        Triangle second{{from_first ? start : start + 1, start + 2, start + 3}};
        const double first_area = classify(mesh, first), second_area = classify(mesh, second);
        // A quad lies one way round, that of its larger half.
        if (!first.is_collapsed && !second.is_collapsed)
            first.is_turned = second.is_turned =
                second.is_free || first_area >= second_area ? first.is_turned : second.is_turned;
        mesh.triangles.push_back(first), mesh.triangles.push_back(second);
    }
}

/// Corners that agree in point, uv and normal are one vertex.
void join_corners(TriangleMesh& mesh) {
    const Polygons& polygons = mesh.polygons;
    std::vector<uint32_t> first_of_point(polygons.positions.size(), kNoIndex);
    std::vector<std::pair<uint32_t, uint32_t>> links; // a corner of the vertex, the next vertex of its point
    const auto is_equal = [&](uint32_t a, uint32_t b) {
        return polygons.uvs[a] == polygons.uvs[b] &&
               (!mesh.point_normals.empty() || polygons.normals[a] == polygons.normals[b]);
    };
    mesh.vertices.resize(polygons.points.size());
    for (uint32_t corner = 0; corner < mesh.vertices.size(); ++corner) {
        uint32_t* link = &first_of_point[polygons.points[corner]];
        while (*link != kNoIndex && !is_equal(links[*link].first, corner)) link = &links[*link].second;
        mesh.vertices[corner] = *link;
        if (*link != kNoIndex) continue;
        mesh.vertices[corner] = *link = uint32_t(links.size());
        links.emplace_back(corner, kNoIndex);
    }
    mesh.first_around.assign(links.size() + 1, 0);
}

void sort_around(TriangleMesh& mesh) {
    const uint32_t count = uint32_t(3 * mesh.triangles.size());
    const auto vertex = [&](uint32_t entry) { return mesh.vertices[mesh.corner(entry)]; };
    for (uint32_t entry = 0; entry < count; ++entry) ++mesh.first_around[vertex(entry) + 1];
    for (size_t k = 1; k < mesh.first_around.size(); ++k) mesh.first_around[k] += mesh.first_around[k - 1];
    std::vector<uint32_t> next(mesh.first_around.begin(), mesh.first_around.end() - 1);
    mesh.around.resize(count);
    for (uint32_t entry = 0; entry < count; ++entry) mesh.around[next[vertex(entry)]++] = entry;
}

/// What the corners of a group share.
struct GroupFrame {
    Vec3d along_u{}, along_v{};
    double u_length = 0, v_length = 0;
    bool is_turned = false;
};

/// Groups the triangles around a vertex and gives its corners tangents. Reuses its memory.
class Fan {
  public:
    Fan(const TriangleMesh& mesh, Polygons& target) : mesh_(mesh), target_(target) {}

    void process(uint32_t vertex) {
        const uint32_t begin = mesh_.first_around[vertex], end = mesh_.first_around[vertex + 1];
        entries_ = std::span(mesh_.around).subspan(begin, end - begin);
        link_edges();
        form_groups();
        store();
    }

  private:
    /// An edge of the vertex with one of its triangles.
    struct Spoke {
        uint32_t other; ///< vertex at its far end
        uint32_t place; ///< of the triangle in entries_
        uint32_t side;  ///< 0: the triangle's edge leaves the vertex, 1: it comes to it
        friend auto operator<=>(const Spoke&, const Spoke&) = default;
    };

    const Triangle& triangle(uint32_t place) const { return mesh_.triangles[entries_[place] / 3]; }

    /// Triangles are neighbours where one's edge leaves and the other's comes; of several the first.
    void link_edges() {
        links_.assign(2 * entries_.size(), kNoIndex);
        spokes_.clear();
        for (uint32_t place = 0; place < entries_.size(); ++place)
            for (uint32_t side = 0; side < 2 && !triangle(place).is_collapsed; ++side)
                spokes_.push_back(
                    {mesh_.vertices[mesh_.corner(entries_[place], side == 0 ? 1 : 2)], place, side});
        std::sort(spokes_.begin(), spokes_.end());
        size_t waiting = 0; // spokes from here on wait, those already linked apart
        for (size_t k = 0; k < spokes_.size(); ++k) {
            const Spoke& spoke = spokes_[k];
            if (spokes_[waiting].other != spoke.other) waiting = k;
            while (waiting < k && link(spokes_[waiting]) != kNoIndex) ++waiting;
            if (waiting == k || spokes_[waiting].side == spoke.side) continue;
            link(spoke) = spokes_[waiting].place;
            link(spokes_[waiting]) = spoke.place;
        }
    }
    uint32_t& link(const Spoke& spoke) { return links_[2 * spoke.place + spoke.side]; }

    void form_groups() {
        group_of_.assign(entries_.size(), kNoIndex);
        groups_.clear();
        for (uint32_t first = 0; first < entries_.size(); ++first) {
            const Triangle& seed = triangle(first);
            if (group_of_[first] != kNoIndex || seed.is_free || seed.is_collapsed) continue;
            const uint32_t group = uint32_t(groups_.size());
            members_.assign(1, first);
            group_of_[first] = group;
            for (size_t next = 0; next < members_.size(); ++next)
                for (uint32_t side = 0; side < 2; ++side) {
                    const uint32_t place = links_[2 * members_[next] + side];
                    if (place == kNoIndex || group_of_[place] != kNoIndex) continue;
                    if (!triangle(place).is_free && triangle(place).is_turned != seed.is_turned) continue;
                    group_of_[place] = group;
                    members_.push_back(place);
                }
            groups_.push_back(sum_members(seed.is_turned));
        }
    }

    /// Angle of a triangle at the vertex, seen along the normal.
    double measure_angle(uint32_t entry, const Vec3d& normal) const {
        const Vec3d p = mesh_.position(mesh_.corner(entry));
        const Vec3d a = project(mesh_.position(mesh_.corner(entry, 1)) - p, normal);
        const Vec3d b = project(mesh_.position(mesh_.corner(entry, 2)) - p, normal);
        return std::acos(std::clamp(dot(a, b), -1.0, 1.0));
    }

    GroupFrame sum_members(bool is_turned) const {
        GroupFrame sum;
        sum.is_turned = is_turned;
        double angles = 0;
        for (const uint32_t place : members_) {
            if (triangle(place).is_free) continue;
            const Derivatives derivatives = differentiate(mesh_, triangle(place));
            const Vec3d normal = mesh_.normal(mesh_.corner(entries_[place]));
            const double angle = measure_angle(entries_[place], normal);
            sum.along_u += project(derivatives.along_u, normal) * angle;
            sum.along_v += project(derivatives.along_v, normal) * angle;
            sum.u_length += derivatives.u_length * angle;
            sum.v_length += derivatives.v_length * angle;
            angles += angle;
        }
        sum.along_u = normalize_double(sum.along_u), sum.along_v = normalize_double(sum.along_v);
        if (angles > 0) sum.u_length /= angles, sum.v_length /= angles;
        return sum;
    }

    /// A quad reached by two groups takes their mean; what was not reached takes over what there is.
    void store() {
        if (groups_.empty()) return;
        owners_.clear();
        for (uint32_t place = 0; place < entries_.size(); ++place)
            owners_.emplace_back(mesh_.corner(entries_[place]), group_of_[place]);
        std::sort(owners_.begin(), owners_.end());
        for (size_t k = 0; k < owners_.size(); ++k) {
            const auto [corner, group] = owners_[k];
            GroupFrame frame = groups_[group == kNoIndex ? 0 : group];
            if (k + 1 < owners_.size() && owners_[k + 1].first == corner) {
                const uint32_t other = owners_[++k].second;
                if (other != group && other != kNoIndex) frame = join(frame, groups_[other]);
            }
            store(corner, frame);
        }
    }

    static GroupFrame join(const GroupFrame& a, const GroupFrame& b) {
        return {normalize_double(a.along_u + b.along_u), normalize_double(a.along_v + b.along_v),
                (a.u_length + b.u_length) / 2, (a.v_length + b.v_length) / 2, b.is_turned};
    }

    void store(uint32_t corner, const GroupFrame& frame) {
        const bool is_relative = !target_.bitangents.empty();
        const Vec3f t = to_float(is_relative ? frame.along_u * frame.u_length : frame.along_u);
        target_.tangents[corner] = {t.x, t.y, t.z, frame.is_turned ? -1.0f : 1.0f};
        if (is_relative) target_.bitangents[corner] = to_float(frame.along_v * frame.v_length);
    }

    const TriangleMesh& mesh_;
    Polygons& target_;
    std::span<const uint32_t> entries_;
    std::vector<Spoke> spokes_;
    std::vector<uint32_t> links_; ///< place of the neighbour, two a place
    std::vector<uint32_t> group_of_, members_;
    std::vector<GroupFrame> groups_;
    std::vector<std::pair<uint32_t, uint32_t>> owners_; ///< corner and group
};

} // namespace

void add_mikk_tangents(Polygons& polygons, std::span<const Vec3<double>> point_normals,
                       FrameLengths lengths) {
    TriangleMesh mesh{polygons, point_normals, {}, {}, {}, {}};
    add_triangles(mesh);
    join_corners(mesh);
    sort_around(mesh);
    polygons.tangents.assign(polygons.points.size(), {0, 0, 0, 1});
    polygons.bitangents.clear();
    if (lengths == FrameLengths::relative) polygons.bitangents.resize(polygons.points.size());
    parallel_for("mikk tangents", mesh.first_around.size() - 1, 4096, [&](size_t begin, size_t end) {
        Fan fan(mesh, polygons);
        for (size_t vertex = begin; vertex < end; ++vertex) fan.process(uint32_t(vertex));
    });
}

} // namespace relief
