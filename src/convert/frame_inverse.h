// The way back through frames, also nearly collapsed ones: frames are blended between corners, and where
// opposite tangents meet, no (t, b, n) of sensible size reaches some directions.
#pragma once

#include "convert/texel_frames.h"

namespace relief {

/// Of the shortest direction to the length that its axes have at the corners.
inline constexpr double kLeastStretch = 0.25;

struct FrameCoordinates {
    Vec3f tbn;
    float error = 0; ///< distance from what the frame makes of `tbn` to what was requested
};

/// The (t, b, n) that the frame turns into `d`. Components along directions that the frame shortens to less
/// than kLeastStretch of its corners' lengths are damped to at most |d| / (kLeastStretch x that length).
FrameCoordinates invert_frame(const TexelFrame& frame, const Vec3f& d);

} // namespace relief
