#include "io/picture/image_output.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>

#include "io/file_system.h"

namespace relief {

CheckedFile::CheckedFile(const std::filesystem::path& file) : stream_(std::fopen(file.c_str(), "wb")) {
    if (!stream_) note_failure();
}

void CheckedFile::write(const void* bytes, size_t count) {
    if (!stream_ || std::fwrite(bytes, 1, count, stream_) != count) note_failure();
}

uint64_t CheckedFile::tell() { return stream_ ? uint64_t(std::ftell(stream_)) : 0; }

void CheckedFile::seek(uint64_t position) {
    if (!stream_ || std::fseek(stream_, long(position), SEEK_SET) != 0) note_failure();
}

std::string CheckedFile::finish() {
    if (stream_ && std::fclose(stream_) != 0) note_failure();
    stream_ = nullptr;
    return failure_;
}

void CheckedFile::note_failure() {
    if (failure_.empty()) failure_ = std::strerror(errno);
}

void write_checked(const std::filesystem::path& file, const std::function<void(CheckedFile&)>& encode) {
    AtomicFile atomic(file);
    CheckedFile stream(atomic.temporary());
    std::string message;
    try {
        encode(stream);
    } catch (const std::bad_alloc&) {
        throw; // told apart from the disk's faults; the file closes and disappears on the way
    } catch (const std::exception& error) {
        message = error.what();
    }
    const std::string disk_message = stream.finish();
    if (!disk_message.empty()) atomic.fail("cannot be written: " + disk_message);
    if (!message.empty()) atomic.fail("cannot be written: " + message);
    atomic.commit();
}

} // namespace relief
