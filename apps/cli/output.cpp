#include "output.h"

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <system_error>

#include <fmt/format.h>

#include "common/console.h"
#include "relief/error.h"

namespace relief::cli {

namespace {

namespace fs = std::filesystem;

/// `name`, or `name-2`, `name-3`... when that is taken.
fs::path find_free_name(const fs::path& folder, const fs::path& name) {
    fs::path candidate = folder / name;
    std::error_code ignored;
    for (int i = 2; fs::exists(candidate, ignored); ++i)
        candidate = folder / fmt::format("{}-{}{}", name.stem().string(), i, name.extension().string());
    return candidate;
}

} // namespace

std::vector<fs::path> get_fallback_folders() {
    std::vector<fs::path> folders;
    std::error_code failure;
    const fs::path temporary = fs::temp_directory_path(failure);
    if (!failure) folders.push_back(temporary);
    if (const char* home = std::getenv("HOME")) folders.emplace_back(home);
    return folders;
}

Saved save_with_fallback(const Image& image, const fs::path& file,
                         const std::vector<fs::path>& fallback_folders, const ImageWriter& write) {
    try {
        write(image, file);
        return {file, false};
    } catch (const std::exception& failure) {
        print_error("relief: error: the picture could not be written: {}\n", failure.what());
        for (const fs::path& folder : fallback_folders) {
            const fs::path other = find_free_name(folder, file.filename());
            try {
                write(image, other);
            } catch (const std::exception&) {
                continue;
            }
            print_error("relief: the picture is not lost, it was written to {}\n", other.string());
            return {other, true};
        }
        throw;
    }
}

} // namespace relief::cli
