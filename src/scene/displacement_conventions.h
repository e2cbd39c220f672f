// Orders of axes as text, and the presets of programs.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "relief/scene.h"

namespace relief {

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

/// Throws bad_input for a displacement of this length, which a texel of `file` has.
[[noreturn]] void refuse_reach(const std::string& displacement, const std::string& file, double reach);

/// Of a material's texture: any filter but mip.
MapFilter parse_texture_filter(std::string_view text);
/// Throws bad_input where `dequantize` is set but the filter is not smooth, or a tile is not of integers of 8
/// or 16 bits.
void check_dequantize(const Displacement& map);

} // namespace relief
