#include "io/mesh/point_ply.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "io/mesh/ply_cursor.h"
#include "relief/error.h"

namespace relief {

namespace {

enum Value : size_t { x, y, z, qw, qx, qy, qz, scale, scale_x, scale_y, scale_z, material, kValues };
constexpr std::array<std::string_view, kValues> kPointNames = {
    "x", "y", "z", "qw", "qx", "qy", "qz", "scale", "scale_x", "scale_y", "scale_z", "material"};

/// Which of the values the properties of an element are; kValues: none that is read.
std::vector<size_t> match_properties(const PlyElement& element) {
    std::vector<size_t> places;
    for (const PlyProperty& property : element.properties) {
        const auto found = std::ranges::find(kPointNames, property.name);
        places.push_back(property.count_type ? size_t(kValues) : size_t(found - kPointNames.begin()));
    }
    return places;
}

/// Rotation by a quaternion after a scale, then the position.
Affine make_transform(const std::array<double, kValues>& v, const PlyCursor& cursor) {
    const double length = std::sqrt(v[qw] * v[qw] + v[qx] * v[qx] + v[qy] * v[qy] + v[qz] * v[qz]);
    if (!(length > 0) || !std::isfinite(length)) cursor.fail("the rotation has no length");
    const double w = v[qw] / length, i = v[qx] / length, j = v[qy] / length, k = v[qz] / length;
    const double sx = v[scale] * v[scale_x], sy = v[scale] * v[scale_y], sz = v[scale] * v[scale_z];
    if (sx * sy * sz == 0 || !std::isfinite(sx * sy * sz)) cursor.fail("the scale is 0 or not finite");
    const auto row = [&](double a, double b, double c) {
        return Vec3f{float(a * sx), float(b * sy), float(c * sz)};
    };
    Affine m;
    m.rows[0] = row(1 - 2 * (j * j + k * k), 2 * (i * j - k * w), 2 * (i * k + j * w));
    m.rows[1] = row(2 * (i * j + k * w), 1 - 2 * (i * i + k * k), 2 * (j * k - i * w));
    m.rows[2] = row(2 * (i * k - j * w), 2 * (j * k + i * w), 1 - 2 * (i * i + j * j));
    m.translation = {float(v[x]), float(v[y]), float(v[z])};
    return m;
}

void read_points(const PlyElement& element, const std::string& name, size_t material_count, PlyCursor& cursor,
                 InstancePoints& points) {
    const std::vector<size_t> places = match_properties(element);
    const auto has = [&](size_t value) { return std::ranges::find(places, value) != places.end(); };
    if (!has(x) || !has(y) || !has(z))
        throw Error(ErrorKind::bad_input, {"the points have no x, y and z", name, kDamagedPlyHint});
    const int parts = has(qw) + has(qx) + has(qy) + has(qz);
    if (parts != 0 && parts != 4)
        throw Error(ErrorKind::bad_input, {"the points have a part of a rotation only", name,
                                           "a quaternion has qw, qx, qy and qz"});
    if (has(material) && material_count == 0)
        throw Error(ErrorKind::bad_input,
                    {"the points have material numbers, but no list of materials is given", name,
                     "\"instances\": { \"file\": ..., \"materials\": [\"first\", \"second\"] }"});
    std::array<double, kValues> values{};
    values[qw] = values[scale] = values[scale_x] = values[scale_y] = values[scale_z] = 1;
    for (uint64_t point = 0; point < element.count; ++point) {
        cursor.enter(element.name, point);
        for (size_t p = 0; p < places.size(); ++p) {
            const PlyProperty& property = element.properties[p];
            if (places[p] == kValues)
                cursor.skip(property);
            else if (places[p] == material)
                points.materials.push_back(
                    uint32_t(cursor.read_whole(property.type, material_count, "material")));
            else
                values[places[p]] = cursor.read(property.type);
        }
        points.transforms.push_back(make_transform(values, cursor));
    }
}

} // namespace

InstancePoints parse_points(std::string_view bytes, const std::string& name, size_t material_count) {
    const PlyHeader header = parse_ply_header(bytes, name);
    refuse_unknown_words(header, name);
    PlyCursor cursor(bytes, name, header);
    InstancePoints points;
    for (const PlyElement& element : header.elements) {
        if (element.name == "vertex") {
            read_points(element, name, material_count, cursor, points);
            return points;
        }
        for (uint64_t i = 0; i < (element.properties.empty() ? 0 : element.count); ++i) {
            cursor.enter(element.name, i);
            for (const PlyProperty& property : element.properties) cursor.skip(property);
        }
    }
    throw Error(ErrorKind::bad_input, {"there are no points: no element 'vertex'", name, kDamagedPlyHint});
}

} // namespace relief
