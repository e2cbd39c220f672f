// Where the programs look for Open Image Denoise.
#pragma once

#include "relief/denoise.h"

namespace relief::cli {

/// The library that the environment variable RELIEF_OIDN names (a file or its folder), and no other where
/// that is set; else that of the system's loader; else one that a package of `python3` on the path ships
/// (pyoidn, oidn, bpy). Throws Error{device_missing}.
Denoiser load_denoiser(int threads);

} // namespace relief::cli
