// Changes of a map's convention by hand.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "relief/scene.h"

namespace relief::viewer {

/// Programs whose maps have a preset (docs/formats.md).
inline constexpr const char* kPresets[] = {"blender-brush", "genvdm", "3dcoat", "vray-tangent", "mudbox",
                                           "maya",          "cycles", "arnold", "moonray",      "daz16"};

/// Axes and midlevel of a program's maps, in the space that the map is in; where the preset does not say the
/// midlevel, that of the kind of file. Throws Error{bad_input} for an unknown name.
void apply_preset(const std::string& preset, Displacement& map);

/// The program whose axes and midlevel the map has, in the space that it is in: `chosen` where that is one,
/// else the first of kPresets; empty: none has them.
std::string find_preset(const Displacement& map, const std::string& chosen);

/// The convention in which a program reads maps, to convert `map` to: its space, axes and midlevel, and a
/// scale of 1. Throws likewise.
Displacement choose_convention(const std::string& preset, const Displacement& map);

/// Channel `channel` moves along `axis` with `sign`; the channel that did so before takes the axis that is
/// free now.
void set_axis(AxisMap& axes, size_t channel, uint8_t axis, int8_t sign);

} // namespace relief::viewer
