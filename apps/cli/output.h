// Finished pictures are not lost: if the requested path fails at the end, fallbacks are tried.
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "relief/image.h"

namespace relief::cli {

using ImageWriter = std::function<void(const Image&, const std::filesystem::path&)>;

struct Saved {
    std::filesystem::path file; ///< actual path of the picture
    bool is_elsewhere = false;  ///< differs from the requested path
};

/// Fallback folders, in order: the system's temporary folder, the home directory.
std::vector<std::filesystem::path> get_fallback_folders();

/// Writes to `file`; if that throws, to the same file name in each fallback folder without overwriting
/// anything. Reports on stderr. Rethrows the first error if everything fails.
Saved save_with_fallback(const Image& image, const std::filesystem::path& file,
                         const std::vector<std::filesystem::path>& fallback_folders,
                         const ImageWriter& write);

} // namespace relief::cli
