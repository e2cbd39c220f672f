// Finished pictures are not lost: where the place asked for fails at the end, another is tried.
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "relief/image.h"

namespace relief::cli {

using ImageWriter = std::function<void(const Image&, const std::filesystem::path&)>;

struct Saved {
    std::filesystem::path file; ///< where the picture is
    bool is_elsewhere = false;  ///< not where it was asked for
};

/// Folders tried in turn when the place asked for fails: the system's temporary folder, the home directory.
std::vector<std::filesystem::path> get_fallback_folders();

/// Writes to `file`; when that throws, the same file name in each fallback folder, where nothing is
/// overwritten. Tells on stderr what happened. Rethrows the first failure when no place works.
Saved save_with_fallback(const Image& image, const std::filesystem::path& file,
                         const std::vector<std::filesystem::path>& fallback_folders,
                         const ImageWriter& write);

} // namespace relief::cli
