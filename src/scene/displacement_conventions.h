// Names of displacement conventions: types, spaces, frames, wraps, encodings, axes, presets of programs.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "relief/scene.h"

namespace relief {

/// How stored values (integers scaled to [0, 1]) are read before the midlevel: as they are, or as -1..1.
enum class MapEncoding { as_stored, from_unit };

/// Axes as text and the letters they were written in.
struct AxisText {
    AxisMap axes;
    bool is_tangent = true; ///< t, b, n; otherwise x, y, z
};

/// What a program writes: its order in tangent space, and what it means by zero.
struct MapPreset {
    std::string_view name, axes;
    std::optional<float> midlevel; ///< none: by the kind of file
};

/// "t,-n,b" or "x,-z,y": the axis that each channel moves along. Throws bad_input with a hint.
AxisText parse_axes(std::string_view text);
std::string format_axes(const AxisMap& axes, DisplacementSpace space);

/// Presets that a scene or a command line may name.
std::span<const std::string_view> get_preset_names();
/// Throws bad_input for an unknown name, and for ZBrush, whose codes say no order by themselves.
const MapPreset& find_preset(std::string_view name);

DisplacementType parse_displacement_type(std::string_view text);
DisplacementSpace parse_displacement_space(std::string_view text);
WrapMode parse_wrap_mode(std::string_view text);
MapFilter parse_map_filter(std::string_view text);
FrameKind parse_frame_kind(std::string_view text);
FrameLengths parse_frame_lengths(std::string_view text);
MapEncoding parse_encoding(std::string_view text);
std::string_view get_name(DisplacementType type);
std::string_view get_name(DisplacementSpace space);
std::string_view get_name(FrameKind frame);
std::string_view get_name(FrameLengths lengths);
std::string_view get_name(WrapMode wrap);
std::string_view get_name(MapFilter filter);
std::string_view get_name(MapEncoding encoding);

} // namespace relief
