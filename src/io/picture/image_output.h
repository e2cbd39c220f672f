// Files of pictures with every disk error noticed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

namespace relief {

/// A file that remembers its first failed write: encoders may drop errors.
class CheckedFile {
  public:
    explicit CheckedFile(const std::filesystem::path& file);
    ~CheckedFile() { finish(); }
    CheckedFile(const CheckedFile&) = delete;
    CheckedFile& operator=(const CheckedFile&) = delete;

    void write(const void* bytes, size_t count);
    uint64_t tell();
    void seek(uint64_t position);
    /// Closes; returns what went wrong first, or an empty text.
    std::string finish();

  private:
    void note_failure();

    std::FILE* stream_;
    std::string failure_;
};

/// The file appears whole or not at all. `encode` writes it, and may throw std::exception. Throws
/// Error{failed}, or the std::bad_alloc of `encode`; nothing is left behind then.
void write_checked(const std::filesystem::path& file, const std::function<void(CheckedFile&)>& encode);

} // namespace relief
