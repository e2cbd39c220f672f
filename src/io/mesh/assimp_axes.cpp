#include "io/mesh/assimp_axes.h"

#include <array>
#include <cstdint>
#include <optional>

#include <assimp/metadata.h>
#include <fmt/format.h>

namespace relief {

namespace {

template <class Value> std::optional<Value> find_entry(const aiScene& scene, const std::string& key) {
    Value value{};
    if (!scene.mMetaData || !scene.mMetaData->Get(key, value)) return std::nullopt;
    return value;
}

/// An axis of the file, 0 to 2, with its sign.
struct Axis {
    int32_t index = 0;
    float sign = 1;
};

std::optional<Axis> find_axis(const aiScene& scene, const std::string& key) {
    const auto index = find_entry<int32_t>(scene, key), sign = find_entry<int32_t>(scene, key + "Sign");
    if (!index || !sign) return std::nullopt;
    return Axis{*index, *sign < 0 ? -1.0f : 1.0f};
}

} // namespace

aiMatrix4x4 find_turn_of_axes(const aiScene& scene, const std::string& name,
                              std::vector<std::string>& warnings) {
    const auto right = find_axis(scene, "CoordAxis"), up = find_axis(scene, "UpAxis"),
               front = find_axis(scene, "FrontAxis");
    aiMatrix4x4 turn;
    if (!right || !up || !front) return turn;
    const std::array<Axis, 3> axes{*right, *up, *front};
    std::array<bool, 3> is_used{};
    for (const Axis& axis : axes)
        if (axis.index >= 0 && axis.index < 3) is_used[size_t(axis.index)] = true;
    if (!(is_used[0] && is_used[1] && is_used[2])) {
        warnings.push_back(
            fmt::format("{}: its axes (right {}, up {}, front {}, counted from 0) are no three "
                        "different ones: Relief takes y for up and z for front; export it with Y up",
                        name, right->index, up->index, front->index));
        return turn;
    }
    for (unsigned row = 0; row < 3; ++row)
        for (unsigned column = 0; column < 3; ++column)
            turn[row][column] = axes[row].index == int32_t(column) ? axes[row].sign : 0.0f;
    return turn;
}

void warn_of_unit(const aiScene& scene, const std::string& name, std::vector<std::string>& warnings) {
    constexpr double kMetre = 100; // centimetres
    std::optional<double> unit = find_entry<double>(scene, "UnitScaleFactor");
    if (!unit)
        if (const auto narrow = find_entry<float>(scene, "UnitScaleFactor")) unit = double(*narrow);
    if (!unit || *unit == 1 || *unit == kMetre) return;
    warnings.push_back(
        fmt::format("{}: its unit of length is {:g} cm, and its numbers are taken as they are: for "
                    "metres, scale the object by {:g}",
                    name, *unit, *unit / kMetre));
}

} // namespace relief
