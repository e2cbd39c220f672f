#include "io/mesh/mend_mesh.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "math/vec.h"
#include "scene/coordinate_limit.h"

namespace relief {

namespace {

bool is_usable_normal(const Vec3f& n) {
    const float sum = std::fabs(n.x) + std::fabs(n.y) + std::fabs(n.z);
    return std::isfinite(sum) && sum > 0;
}

bool is_finite_uv(const Vec2f& uv) { return std::isfinite(uv.x) && std::isfinite(uv.y); }

bool is_usable_position(const Vec3f& p) {
    return std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)}) <= kLargestCoordinate && p == p;
}

/// Twice the area vector of the face whose corners begin at `begin`.
Vec3<double> find_area(const Mesh& mesh, size_t begin, uint32_t size) {
    const auto get = [&](size_t k) {
        const Vec3f& p = mesh.positions[mesh.position_indices[begin + k]];
        return Vec3<double>{double(p.x), double(p.y), double(p.z)};
    };
    Vec3<double> sum{};
    for (size_t k = 1; k + 1 < size; ++k) sum += cross(get(k) - get(0), get(k + 1) - get(0));
    return sum;
}

/// Normals for corners that lack one.
class NormalMender {
  public:
    explicit NormalMender(Mesh& mesh) : mesh_(mesh) {}

    /// Returns the number of corners that are seen and had no usable normal.
    size_t mend() {
        const std::vector<uint32_t>& indices = mesh_.normal_indices;
        const auto is_bad = [&](uint32_t index) { return !is_usable_normal(mesh_.normals[index]); };
        const auto bad = size_t(std::ranges::count_if(indices, is_bad));
        if (bad == 0) return 0;
        sum_faces();
        if (bad == indices.size()) {
            mesh_.normals.clear(), mesh_.normal_indices.clear(), mesh_.tangents.clear();
            return bad;
        }
        size_t seen = 0, begin = 0;
        for (const uint32_t size : mesh_.face_sizes) {
            const Vec3<double> area = find_area(mesh_, begin, size);
            for (size_t corner = begin; corner < begin + size; ++corner) {
                if (!is_bad(indices[corner])) continue;
                seen += dot(area, area) > 0 ? 1 : 0;
                mesh_.normal_indices[corner] = find_or_add(mesh_.position_indices[corner]);
            }
            begin += size;
        }
        for (Vec3f& normal : mesh_.normals)
            if (!is_usable_normal(normal)) normal = {0, 1, 0}; // of no corner, or of faces without area
        return seen;
    }

  private:
    void sum_faces() {
        sums_.resize(mesh_.positions.size());
        size_t begin = 0;
        for (const uint32_t size : mesh_.face_sizes) {
            const Vec3<double> area = find_area(mesh_, begin, size);
            for (size_t corner = begin; corner < begin + size; ++corner)
                sums_[mesh_.position_indices[corner]] += area;
            begin += size;
        }
    }

    uint32_t find_or_add(uint32_t point) {
        const auto [found, is_new] = numbers_.try_emplace(point, uint32_t(mesh_.normals.size()));
        if (!is_new) return found->second;
        const Vec3<double>& sum = sums_[point];
        const double length = std::sqrt(dot(sum, sum));
        const double scale = length > 0 ? 1 / length : 0;
        mesh_.normals.push_back({float(sum.x * scale), float(sum.y * scale), float(sum.z * scale)});
        return found->second;
    }

    Mesh& mesh_;
    std::vector<Vec3<double>> sums_;       ///< by position
    std::map<uint32_t, uint32_t> numbers_; ///< of new normals, by position
};

/// Returns the number of faces that have lost their uvs; `indices` is empty where no face has any left.
size_t mend_uvs(const Mesh& mesh, std::vector<Vec2f>& uvs, std::vector<uint32_t>& indices) {
    if (std::ranges::all_of(uvs, is_finite_uv)) return 0;
    size_t lost = 0, left = 0;
    auto begin = indices.begin();
    for (const uint32_t size : mesh.face_sizes) {
        if (begin == indices.end()) break;
        const auto end = begin + ptrdiff_t(size);
        const bool has_uvs = *begin != kNoIndex;
        const bool is_good =
            has_uvs && std::all_of(begin, end, [&](uint32_t index) { return is_finite_uv(uvs[index]); });
        if (!is_good) std::fill(begin, end, kNoIndex);
        lost += has_uvs && !is_good ? 1 : 0;
        left += is_good ? 1 : 0;
        begin = end;
    }
    for (Vec2f& uv : uvs)
        if (!is_finite_uv(uv)) uv = {};
    if (left == 0) uvs.clear(), indices.clear();
    return lost;
}

size_t mend_positions(Mesh& mesh) {
    if (std::ranges::all_of(mesh.positions, is_usable_position)) return 0;
    std::vector<bool> is_used(mesh.positions.size());
    for (const uint32_t index : mesh.position_indices) is_used[index] = true;
    size_t moved = 0;
    for (size_t k = 0; k < mesh.positions.size(); ++k) {
        if (is_used[k] || is_usable_position(mesh.positions[k])) continue;
        mesh.positions[k] =
            mesh.positions[mesh.position_indices.front()]; // the bounds stay those of the faces
        ++moved;
    }
    return moved;
}

} // namespace

void mend_mesh(Mesh& mesh, const std::string& name, std::vector<std::string>& warnings) {
    if (mesh.position_indices.empty()) return;
    if (const size_t count = mend_positions(mesh); count > 0)
        warnings.push_back(fmt::format(
            "{}: {} points of no face are not finite or too far out, and are left out", name, count));
    const auto warn_of_uvs = [&](size_t faces, int set) {
        if (faces > 0)
            warnings.push_back(
                fmt::format("{}: {} of {} faces have uvs in set {} that are not finite, and are "
                            "read without uvs: unwrap them again",
                            name, faces, mesh.face_sizes.size(), set));
    };
    warn_of_uvs(mend_uvs(mesh, mesh.uvs, mesh.uv_indices), mesh.uv_set);
    for (UvSet& set : mesh.further_uvs) warn_of_uvs(mend_uvs(mesh, set.uvs, set.indices), set.number);
    std::erase_if(mesh.further_uvs, [](const UvSet& set) { return set.indices.empty(); });
    const size_t corners = mesh.normal_indices.size();
    if (const size_t count = NormalMender(mesh).mend(); count > 0)
        warnings.push_back(
            fmt::format("{}: {} of {} corners have normals that are not finite or have no length: "
                        "Relief computes them from the faces",
                        name, count, corners));
}

} // namespace relief
