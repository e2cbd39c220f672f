// The half turn, for shapes given by angles.
#pragma once

#include <numbers>

namespace relief::samples {

inline constexpr float kPi = std::numbers::pi_v<float>;

} // namespace relief::samples
