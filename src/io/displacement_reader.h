// What a displacement map means: presets, axis texts, defaults by kind of file, warnings.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "io/asset_cache.h"
#include "relief/scene.h"

namespace relief {

/// Axes as text and the letters they were written in.
struct AxisText {
    AxisMap axes;
    bool is_tangent = true; ///< t, b, n; otherwise x, y, z
};

/// "t,-n,b" or "x,-z,y": the axis that each channel moves along. Throws bad_input with a hint.
AxisText parse_axes(std::string_view text);
std::string format_axes(const AxisMap& axes, DisplacementSpace space);

/// Presets that a scene or a command line may name.
std::span<const std::string_view> get_preset_names();

DisplacementType parse_displacement_type(std::string_view text);
DisplacementSpace parse_displacement_space(std::string_view text);
WrapMode parse_wrap_mode(std::string_view text);
std::string_view get_name(DisplacementType type);
std::string_view get_name(DisplacementSpace space);
std::string_view get_name(WrapMode wrap);

/// What was said of a map. Unset values come from the preset, then from the file.
struct DisplacementRequest {
    std::string name, file, preset;
    std::optional<std::string> type, space, axes, wrap;
    std::optional<Vec3f> midlevel, scale;
    bool flip_v = false, dilate = true;
};

/// Reads the tiles and settles every value; what it had to assume goes to the warnings of `assets`.
Displacement make_displacement(const DisplacementRequest& request, AssetCache& assets);

} // namespace relief
