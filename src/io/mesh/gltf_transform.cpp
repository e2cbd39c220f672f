#include "io/mesh/gltf_transform.h"

#include <array>
#include <cmath>

#include <fmt/format.h>

#include "io/mesh/gltf_primitive.h"
#include "math/affine.h"

namespace relief {

namespace {

Affine read_node_matrix(const JsonNode& node) {
    const std::vector<JsonNode> values = node.elements();
    if (values.size() != 16)
        node.fail(fmt::format("must be 16 numbers, not {}", values.size()), kDamagedHint);
    const auto at = [&values](size_t row, size_t column) { return values[4 * column + row].as_float(); };
    constexpr float kRounding = 1e-5f;
    for (size_t column = 0; column < 4; ++column)
        if (std::fabs(at(3, column) - (column == 3 ? 1.0f : 0.0f)) > kRounding)
            node.fail("is no affine map", "its last row must be 0, 0, 0, 1");
    Affine result;
    for (size_t row = 0; row < 3; ++row) result.rows[row] = {at(row, 0), at(row, 1), at(row, 2)};
    result.translation = {at(0, 3), at(1, 3), at(2, 3)};
    return result;
}

/// A quaternion x, y, z, w, which need not have length 1.
std::array<double, 4> read_quaternion(const JsonNode& node) {
    const std::vector<JsonNode> values = node.elements();
    if (values.size() != 4) node.fail(fmt::format("must be 4 numbers, not {}", values.size()), kDamagedHint);
    std::array<double, 4> q;
    for (size_t k = 0; k < 4; ++k) q[k] = double(values[k].as_float());
    return q;
}

Affine make_rotation(const std::array<double, 4>& q, const JsonNode& node) {
    double square = 0;
    for (const double part : q) square += part * part;
    if (!(square > 0)) node.fail("has no length", kDamagedHint);
    const double s = 2 / square, x = q[0], y = q[1], z = q[2], w = q[3];
    Affine result;
    result.rows[0] = {float(1 - s * (y * y + z * z)), float(s * (x * y - z * w)), float(s * (x * z + y * w))};
    result.rows[1] = {float(s * (x * y + z * w)), float(1 - s * (x * x + z * z)), float(s * (y * z - x * w))};
    result.rows[2] = {float(s * (x * z - y * w)), float(s * (y * z + x * w)), float(1 - s * (x * x + y * y))};
    return result;
}

} // namespace

Affine read_gltf_transform(const JsonNode& node, const GltfPose& pose) {
    if (const auto matrix = node.find("matrix")) return read_node_matrix(*matrix); // which nothing moves
    Affine result;
    const auto scale = node.find("scale"), rotation = node.find("rotation"),
               translation = node.find("translation");
    if (pose.scale || scale) result = make_scale(pose.scale ? *pose.scale : scale->as_vec3());
    if (pose.rotation)
        result = compose(make_rotation(*pose.rotation, node), result);
    else if (rotation)
        result = compose(make_rotation(read_quaternion(*rotation), *rotation), result);
    if (pose.translation || translation)
        result.translation = pose.translation ? *pose.translation : translation->as_vec3();
    return result;
}

std::vector<Affine> read_gltf_instances(GltfFile& file, const JsonNode& node) {
    const auto extensions = node.find("extensions");
    const auto instancing = extensions ? extensions->find("EXT_mesh_gpu_instancing") : std::nullopt;
    if (!instancing) return {Affine()};
    const JsonNode attributes = instancing->get("attributes");
    size_t count = SIZE_MAX;
    const auto read = [&](const char* key, size_t width) {
        const auto index = attributes.find(key);
        if (!index) return std::span<const float>();
        const std::span<const float> values = file.read_floats(*index, width);
        if (count != SIZE_MAX && values.size() != width * count)
            index->fail(fmt::format("has {} values for {} instances", values.size() / width, count),
                        kDamagedHint);
        count = values.size() / width;
        return values;
    };
    const auto translations = read("TRANSLATION", 3), rotations = read("ROTATION", 4),
               scales = read("SCALE", 3);
    if (count == SIZE_MAX) attributes.fail("has none of TRANSLATION, ROTATION and SCALE", kDamagedHint);
    std::vector<Affine> instances;
    for (size_t k = 0; k < count; ++k) {
        Affine instance;
        if (!scales.empty()) instance = make_scale({scales[3 * k], scales[3 * k + 1], scales[3 * k + 2]});
        if (!rotations.empty()) {
            const auto q = rotations.subspan(4 * k, 4);
            instance =
                compose(make_rotation({double(q[0]), double(q[1]), double(q[2]), double(q[3])}, attributes),
                        instance);
        }
        if (!translations.empty())
            instance.translation = {translations[3 * k], translations[3 * k + 1], translations[3 * k + 2]};
        instances.push_back(instance);
    }
    return instances;
}

} // namespace relief
