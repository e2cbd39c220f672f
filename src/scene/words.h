// What scene files and options call the values of enumerations.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

#include "relief/scene.h"

namespace relief {

/// How stored values (integers scaled to [0, 1]) are read before the midlevel: as they are, or as -1..1.
enum class MapEncoding { as_stored, from_unit };

struct EnumWords {
    const char* what;                      ///< of the enumeration, for messages
    std::array<std::string_view, 4> words; ///< of its values, in their order; empty beyond the last
};

template <class Value> inline constexpr EnumWords kWords{};
template <> inline constexpr EnumWords kWords<DisplacementType>{"type", {"vector", "height"}};
template <> inline constexpr EnumWords kWords<DisplacementSpace>{"space", {"tangent", "object", "world"}};
template <> inline constexpr EnumWords kWords<MapFilter>{"filter", {"none", "mip", "cubic", "bspline"}};
template <> inline constexpr EnumWords kWords<WrapMode>{"wrap", {"clamp", "repeat", "mirror", "black"}};
template <> inline constexpr EnumWords kWords<MapEncoding>{"encoding", {"float", "signed"}};
template <> inline constexpr EnumWords kWords<FrameKind>{"frame", {"mikk", "dpdu", "file"}};
template <> inline constexpr EnumWords kWords<FrameLengths>{"lengths", {"absolute", "relative"}};
template <>
inline constexpr EnumWords kWords<SubdivisionScheme>{"subdivision scheme", {"none", "bilinear", "catmark"}};
template <> inline constexpr EnumWords kWords<UvRule>{"rule for uvs", {"smooth", "linear"}};
template <>
inline constexpr EnumWords kWords<BoundaryRule>{"rule for boundaries", {"edge-only", "edge-and-corner"}};

/// Place of a word; throws bad_input with a suggestion for an unknown one.
size_t find_word(const EnumWords& words, std::string_view text);

template <class Value> Value parse_word(std::string_view text) {
    return Value(find_word(kWords<Value>, text));
}
template <class Value> std::string get_word(Value value) {
    return std::string(kWords<Value>.words[size_t(value)]);
}

} // namespace relief
