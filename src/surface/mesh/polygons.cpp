#include "surface/mesh/polygons.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "math/vec.h"
#include "relief/error.h"
#include "scene/coordinate_limit.h"
#include "surface/mesh/degenerate_faces.h"
#include "surface/mesh/join_points.h"
#include "surface/mesh/pinched_points.h"

namespace relief {

namespace {

constexpr float kLargestUv = 1e6f;

[[noreturn]] void throw_bad_face(const std::string& where, size_t face, std::string message,
                                 std::string hint) {
    throw Error(ErrorKind::bad_input,
                {std::move(message), fmt::format("{}, face {}", where, face), std::move(hint)});
}

std::string describe_mesh(const Mesh& mesh) {
    const std::string name = fmt::format("mesh '{}'", mesh.name);
    return mesh.source.empty() ? name : mesh.source + ": " + name;
}

void check_counts(const Mesh& mesh, const std::string& where) {
    const auto fail = [&](std::string message) {
        throw Error(ErrorKind::bad_input, {std::move(message), where, "write the mesh again"});
    };
    if (mesh.face_sizes.empty())
        throw Error(ErrorKind::bad_input, {"mesh has no faces", where, "export it with polygons"});
    size_t corner_count = 0;
    for (const uint32_t size : mesh.face_sizes) corner_count += size;
    const auto check = [&](size_t count, const char* what) {
        if (count != corner_count)
            fail(fmt::format("faces have {} corners, but there are {} {}", corner_count, count, what));
    };
    check(mesh.position_indices.size(), "position indices");
    if (!mesh.uv_indices.empty()) check(mesh.uv_indices.size(), "uv indices");
    for (const UvSet& set : mesh.further_uvs) check(set.indices.size(), "uv indices of a further set");
    if (!mesh.normal_indices.empty()) check(mesh.normal_indices.size(), "normal indices");
    if (!mesh.tangents.empty()) check(mesh.tangents.size(), "tangents");
    if (corner_count >= size_t(kNoIndex) / 8) fail("mesh has too many corners");
}

bool is_in_range(const Vec3f& p, float limit) {
    return std::fabs(p.x) <= limit && std::fabs(p.y) <= limit && std::fabs(p.z) <= limit;
}

void check_face(const Mesh& mesh, const std::string& where, size_t face, size_t start) {
    const uint32_t size = mesh.face_sizes[face];
    if (size < 3)
        throw_bad_face(where, face, fmt::format("face has {} corners", size),
                       "remove points and lines from the mesh");
    const auto check_index = [&](const char* name, uint32_t index, size_t count) {
        if (index >= count)
            throw_bad_face(where, face,
                           fmt::format("{} index {} is out of range, there are {}", name, index, count),
                           "write the mesh again");
    };
    size_t corner = start;
    const auto check_uv = [&](const std::vector<Vec2f>& uvs, const std::vector<uint32_t>& indices) {
        if (indices.empty() || indices[start] == kNoIndex) return;
        const uint32_t index = indices[corner];
        check_index("uv", index, uvs.size());
        const Vec2f& uv = uvs[index];
        if (!(std::fabs(uv.x) <= kLargestUv && std::fabs(uv.y) <= kLargestUv))
            throw_bad_face(where, face, fmt::format("uv {} is not finite or above 1e6", index),
                           "unwrap the mesh again");
    };
    for (; corner < start + size; ++corner) {
        const uint32_t point = mesh.position_indices[corner];
        check_index("position", point, mesh.positions.size());
        if (!is_in_range(mesh.positions[point], kLargestCoordinate))
            throw_bad_face(where, face, fmt::format("position {} is not finite or above 1e18", point),
                           "write the mesh again");
        check_uv(mesh.uvs, mesh.uv_indices);
        for (const UvSet& set : mesh.further_uvs) check_uv(set.uvs, set.indices);
        if (!mesh.normal_indices.empty()) {
            const uint32_t index = mesh.normal_indices[corner];
            check_index("normal", index, mesh.normals.size());
            if (!is_in_range(mesh.normals[index], kLargestCoordinate))
                throw_bad_face(where, face, fmt::format("normal {} is not finite", index),
                               "write the mesh again");
        }
    }
}

void check_faces(const Mesh& mesh, const std::string& where) {
    size_t start = 0;
    for (size_t face = 0; face < mesh.face_sizes.size(); start += mesh.face_sizes[face], ++face)
        check_face(mesh, where, face, start);
}

/// Creases between the points of the polygons; those between points that have become one are gone.
std::vector<Crease> move_creases(const Mesh& mesh, const std::string& where,
                                 const std::vector<uint32_t>& representatives) {
    std::vector<Crease> result;
    for (const Crease& crease : mesh.creases) {
        if (crease.first >= mesh.positions.size() || crease.second >= mesh.positions.size())
            throw Error(ErrorKind::bad_input,
                        {fmt::format("crease from point {} to {} is out of range, there are {}", crease.first,
                                     crease.second, mesh.positions.size()),
                         where, "points count from 0; write the mesh again"});
        if (!(crease.sharpness >= 0))
            throw Error(ErrorKind::bad_input,
                        {fmt::format("sharpness {} of a crease is not 0 or more", crease.sharpness), where,
                         "10 and above stays sharp for ever"});
        Crease moved = crease;
        if (!representatives.empty())
            moved = {representatives[crease.first], representatives[crease.second], crease.sharpness};
        if ((moved.first == moved.second) == (crease.first == crease.second)) result.push_back(moved);
    }
    return result;
}

/// In the order of the mesh.
std::vector<const UvSet*> choose_uv_sets(const Mesh& mesh, std::span<const int> numbers) {
    std::vector<const UvSet*> result;
    for (const UvSet& set : mesh.further_uvs)
        if (std::ranges::find(numbers, set.number) != numbers.end()) result.push_back(&set);
    return result;
}

/// Of corner k of the face whose corners begin at `start`.
Vec2f get_uv(const std::vector<Vec2f>& uvs, const std::vector<uint32_t>& indices, size_t start, uint32_t k) {
    return indices[start] == kNoIndex ? Vec2f{} : uvs[indices[start + k]];
}

template <class Corner> Vec3<double> sum_newell(uint32_t size, const Corner& corner) {
    const Vec3f origin = corner(0);
    const auto offset = [&](uint32_t k) {
        const Vec3f p = corner(k);
        return Vec3<double>{double(p.x) - origin.x, double(p.y) - origin.y, double(p.z) - origin.z};
    };
    Vec3<double> sum{};
    for (uint32_t k = 1; k + 1 < size; ++k) sum += cross(offset(k), offset(k + 1));
    return sum;
}

template <class Value> Value mix(const Value& a, const Value& b, float part) {
    return part == 0 ? a : a * (1 - part) + b * part;
}

} // namespace

void add_corner_between(const Polygons& from, uint32_t corner, uint32_t next, const PointOnWay& at,
                        Polygons& to) {
    to.points.push_back(at.point);
    if (!from.uvs.empty()) to.uvs.push_back(mix(from.uvs[corner], from.uvs[next], at.part));
    for (size_t n = 0; n < from.further_uvs.size(); ++n) {
        const std::vector<Vec2f>& uvs = from.further_uvs[n].uvs;
        to.further_uvs[n].uvs.push_back(mix(uvs[corner], uvs[next], at.part));
    }
    if (!from.normals.empty()) to.normals.push_back(mix(from.normals[corner], from.normals[next], at.part));
    if (!from.bitangents.empty())
        to.bitangents.push_back(mix(from.bitangents[corner], from.bitangents[next], at.part));
    if (from.tangents.empty()) return;
    std::array<float, 4> tangent = from.tangents[corner];
    for (size_t c = 0; c < 3; ++c) tangent[c] = mix(tangent[c], from.tangents[next][c], at.part);
    to.tangents.push_back(tangent);
}

Vec3<double> compute_newell_normal(const Polygons& polygons, uint32_t face) {
    const uint32_t start = polygons.starts[face];
    return sum_newell(polygons.face_size(face),
                      [&](uint32_t k) { return polygons.positions[polygons.points[start + k]]; });
}

Vec3<double> compute_newell_normal(std::span<const Vec3f> corners) {
    return sum_newell(uint32_t(corners.size()), [&](uint32_t k) { return corners[k]; });
}

Polygons make_polygons(const Mesh& mesh, Welding welding, std::span<const int> uv_sets) {
    Polygons result;
    result.where = describe_mesh(mesh);
    check_counts(mesh, result.where);
    result.positions = mesh.positions;
    for (Vec3f& p : result.positions) p = p + Vec3f{}; // -0 becomes 0
    check_faces(mesh, result.where);
    std::vector<uint32_t> representatives;
    if (welding == Welding::joined_points) {
        representatives = join_points(mesh).representatives;
        if (mesh.subdivision.scheme == SubdivisionScheme::catmark)
            split_pinched_points(mesh, representatives);
    }

    const std::vector<const UvSet*> wanted = choose_uv_sets(mesh, uv_sets);
    for (const UvSet* set : wanted) result.further_uvs.push_back({set->number, {}});

    if (mesh.subdivision.creases == CreaseRule::obey)
        result.creases = move_creases(mesh, result.where, representatives);

    size_t start = 0;
    for (size_t face = 0; face < mesh.face_sizes.size(); start += mesh.face_sizes[face], ++face) {
        const uint32_t size = mesh.face_sizes[face];
        result.starts.push_back(uint32_t(result.points.size()));
        for (uint32_t k = 0; k < size; ++k) {
            const uint32_t point = mesh.position_indices[start + k];
            const uint32_t previous = mesh.position_indices[start + (k + size - 1) % size];
            // A face whose corners all coincide loses them all and has no area.
            if (result.positions[point] == result.positions[previous]) continue;
            result.points.push_back(representatives.empty() ? point : representatives[point]);
            if (!mesh.uv_indices.empty()) result.uvs.push_back(get_uv(mesh.uvs, mesh.uv_indices, start, k));
            for (size_t n = 0; n < wanted.size(); ++n)
                result.further_uvs[n].uvs.push_back(get_uv(wanted[n]->uvs, wanted[n]->indices, start, k));
            if (!mesh.normal_indices.empty())
                result.normals.push_back(mesh.normals[mesh.normal_indices[start + k]]);
            if (!mesh.tangents.empty()) result.tangents.push_back(mesh.tangents[start + k]);
        }
        result.source_faces.push_back(uint32_t(face));
    }
    result.starts.push_back(uint32_t(result.points.size()));
    drop_degenerate_faces(result);
    return result;
}

} // namespace relief
