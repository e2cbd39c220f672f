// Input files as bytes, with messages that help; output files that appear whole or not at all.
#pragma once

#include <filesystem>
#include <string>

namespace relief {

/// Lower-case extension with its dot: ".exr".
std::string get_lower_extension(const std::filesystem::path& file);

/// The same path with `/` for each `\`, as a program on Windows writes it, where the path as it is names
/// nothing.
std::filesystem::path find_with_slashes(const std::filesystem::path& file);

/// Throws bad_input unless the path names a regular file; the hint names a similar file of the folder.
void require_file(const std::filesystem::path& file);

/// Whole content. Throws bad_input with the name.
std::string read_file_bytes(const std::filesystem::path& file);

/// A temporary name beside `target` that becomes the target on commit and is removed otherwise.
class AtomicFile {
  public:
    /// Throws Error{failed} where the folder does not exist, or the target is no regular file or a link loop.
    explicit AtomicFile(std::filesystem::path target);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    const std::filesystem::path& temporary() const { return temporary_; }
    /// Renames. Throws Error{failed} for an empty or missing temporary, or when the rename fails.
    void commit();
    [[noreturn]] void fail(const std::string& message) const;

  private:
    std::filesystem::path target_, place_, temporary_; ///< `place_`: where a link ends
    bool is_committed_ = false;
};

} // namespace relief
