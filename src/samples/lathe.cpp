#include "samples/lathe.h"

#include <algorithm>
#include <cmath>

#include "math/vec.h"
#include "samples/angles.h"
#include "samples/noise.h"
#include "samples/profile.h"

namespace relief::samples {

namespace {

constexpr int kProfileSamples = 1024;

// Layout of the atlas: the tube fills the upper part from side to side, the caps stand below it.
constexpr float kTubeLow = 0.44f, kTubeHigh = 0.985f;
constexpr float kCapHalfSize = 0.2f, kCapCentreV = 0.215f;
constexpr float kBottomCapU = 0.25f, kTopCapU = 0.75f;

/// Polar coordinates of a point of [-1, 1]^2, squares to circles (Shirley and Chiu 1997).
Vec2f square_to_polar(const Vec2f& p) {
    if (p.x == 0 && p.y == 0) return {0, 0};
    if (std::fabs(p.x) >= std::fabs(p.y))
        return {std::fabs(p.x), kPi / 4 * (p.y / p.x) + (p.x < 0 ? kPi : 0.0f)};
    return {std::fabs(p.y), kPi / 2 - kPi / 4 * (p.x / p.y) + (p.y < 0 ? kPi : 0.0f)};
}

std::vector<Vec2f> resample_by_arc_length(const ProfileCurve& curve) {
    constexpr int kFine = 8 * kProfileSamples;
    std::vector<float> lengths(kFine + 1, 0.0f);
    for (int i = 1; i <= kFine; ++i)
        lengths[size_t(i)] =
            lengths[size_t(i) - 1] + length(curve.at(float(i) / kFine) - curve.at(float(i - 1) / kFine));
    std::vector<Vec2f> samples;
    size_t at = 0;
    for (int i = 0; i <= kProfileSamples; ++i) {
        const float target = lengths.back() * float(i) / kProfileSamples;
        while (at + 2 < lengths.size() && lengths[at + 1] < target) ++at;
        const float f = (target - lengths[at]) / (lengths[at + 1] - lengths[at]);
        samples.push_back(curve.at((float(at) + f) / kFine));
    }
    return samples;
}

} // namespace

float BodyPoint::radius() const { return std::sqrt(position.x * position.x + position.z * position.z); }

LatheBody::LatheBody(const LatheShape& shape)
    : shape_(shape),
      samples_(resample_by_arc_length(ProfileCurve(shape.profile, ProfileCurve::Ends::free))) {}

BodyPoint LatheBody::point_at(float theta, float s) const {
    const float position = std::clamp(s, 0.0f, 1.0f) * kProfileSamples;
    const int i = std::min(int(position), kProfileSamples - 1);
    const auto sample = [&](int k) { return samples_[size_t(std::clamp(k, 0, kProfileSamples))]; };
    // Directions are differences over two samples, blended, so that they turn smoothly along the profile.
    const float f = position - float(i);
    const Vec2f p = sample(i) * (1 - f) + sample(i + 1) * f;
    const Vec2f d = (sample(i + 1) - sample(i - 1)) * (1 - f) + (sample(i + 2) - sample(i)) * f;
    const float c = std::cos(theta), w = std::sin(theta);
    BodyPoint point;
    point.theta = theta;
    point.position = {p.x * c, p.y, -p.x * w};
    point.around = {-w, 0, -c};
    point.along = normalize(Vec3f{d.x * c, d.y, -d.x * w});
    point.normal = cross(point.around, point.along);
    return point;
}

BodyPoint LatheBody::point_at_uv(const Vec2f& uv) const {
    if (uv.y > (kTubeLow + kCapCentreV + kCapHalfSize) / 2) {
        const float f = (uv.y - kTubeLow) / (kTubeHigh - kTubeLow);
        return point_at(2 * kPi * uv.x, lerp(shape_.cap_share, 1 - shape_.cap_share, f));
    }
    const bool is_top = uv.x >= 0.5f;
    const Vec2f centre{is_top ? kTopCapU : kBottomCapU, kCapCentreV};
    const Vec2f polar = square_to_polar((uv - centre) * (1 / kCapHalfSize));
    return is_top ? point_at(polar.y, 1 - shape_.cap_share * polar.x)
                  : point_at(-polar.y, shape_.cap_share * polar.x);
}

Vec3f LatheBody::tangent_at_uv(const Vec2f& uv, const BodyPoint& point) const {
    if (uv.y > (kTubeLow + kCapCentreV + kCapHalfSize) / 2) return point.around;
    constexpr float kStep = 1e-3f;
    const Vec3f step =
        point_at_uv({uv.x + kStep, uv.y}).position - point_at_uv({uv.x - kStep, uv.y}).position;
    return normalize(step - point.normal * dot(step, point.normal));
}

Vec2f LatheBody::cap_uv(const Vec2f& square, bool is_top) const {
    if (shape_.tiles > 0) return {0.5f + 0.12f * square.x, 0.5f + 0.12f * square.y};
    return {(is_top ? kTopCapU : kBottomCapU) + kCapHalfSize * square.x,
            kCapCentreV + kCapHalfSize * square.y};
}

uint32_t LatheBody::ring_vertex(int column, bool is_top) const {
    const int columns = 4 * shape_.cap_cells, wrapped = ((column % columns) + columns) % columns;
    return uint32_t((is_top ? shape_.rows : 0) * columns + wrapped);
}

void LatheBody::add_tube(Mesh& mesh) const {
    const int columns = 4 * shape_.cap_cells, rows = shape_.rows;
    for (int i = 0; i <= rows; ++i) {
        const float f = float(i) / float(rows);
        const float s = lerp(shape_.cap_share, 1 - shape_.cap_share, f);
        const float v = shape_.tiles > 0 ? f * shape_.tiles : lerp(kTubeLow, kTubeHigh, f);
        for (int j = 0; j <= columns; ++j) {
            const float u = float(j) / float(columns);
            if (j < columns) mesh.positions.push_back(point_at(2 * kPi * u, s).position);
            mesh.uvs.push_back({u, v});
        }
    }
    const auto uv_of = [&](int i, int j) { return uint32_t(i * (columns + 1) + j); };
    const auto vertex = [&](int i, int j) { return uint32_t(i * columns + j % columns); };
    for (int i = 0; i < rows; ++i)
        for (int j = 0; j < columns; ++j) {
            mesh.face_sizes.push_back(4);
            for (const auto& [di, dj] : {std::pair(0, 0), {0, 1}, {1, 1}, {1, 0}}) {
                mesh.position_indices.push_back(vertex(i + di, j + dj));
                mesh.uv_indices.push_back(uv_of(i + di, j + dj));
            }
        }
}

void LatheBody::add_cap(Mesh& mesh, bool is_top) const {
    const int k = shape_.cap_cells;
    const uint32_t first_uv = uint32_t(mesh.uvs.size());
    std::vector<uint32_t> vertices;
    for (int y = 0; y <= k; ++y)
        for (int x = 0; x <= k; ++x) {
            const Vec2f square{2 * float(x) / float(k) - 1, 2 * float(y) / float(k) - 1};
            const Vec2f polar = square_to_polar(square);
            const float theta = is_top ? polar.y : -polar.y;
            mesh.uvs.push_back(cap_uv(square, is_top));
            if (x == 0 || y == 0 || x == k || y == k) {
                const int column = int(std::lround(theta / (2 * kPi) * float(4 * k)));
                vertices.push_back(ring_vertex(column, is_top));
                continue;
            }
            const float s = shape_.cap_share * polar.x;
            vertices.push_back(uint32_t(mesh.positions.size()));
            mesh.positions.push_back(point_at(theta, is_top ? 1 - s : s).position);
        }
    for (int y = 0; y < k; ++y)
        for (int x = 0; x < k; ++x) {
            mesh.face_sizes.push_back(4);
            for (const auto& [dx, dy] : {std::pair(0, 0), {1, 0}, {1, 1}, {0, 1}}) {
                const uint32_t corner = uint32_t((y + dy) * (k + 1) + x + dx);
                mesh.position_indices.push_back(vertices[corner]);
                mesh.uv_indices.push_back(first_uv + corner);
            }
        }
}

Mesh LatheBody::make_mesh(const std::string& name, const Deformation& deform) const {
    Mesh mesh;
    mesh.name = name;
    add_tube(mesh);
    add_cap(mesh, false);
    add_cap(mesh, true);
    for (Vec3f& p : mesh.positions) p = deform(p);
    return mesh;
}

} // namespace relief::samples
