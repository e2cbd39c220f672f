// How far a work is that takes longer than a moment and is no render, which has an observer
// (relief/render.h).
#pragma once

#include <functional>

namespace relief {

/// Told a few times a second which part of a work is done, from 0 to 1 and never less than before; from one
/// thread at a time. Empty: nobody asks.
using ProgressFunction = std::function<void(double fraction)>;

} // namespace relief
