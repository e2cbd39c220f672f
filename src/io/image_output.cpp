#include "io/image_output.h"

#include <cerrno>
#include <cstdio>
#include <cstring>

#include <OpenImageIO/filesystem.h>
#include <fmt/format.h>

#include "io/file_system.h"

namespace relief {

namespace {

/// A file that remembers its first failed write: some encoders write their tables in destructors and drop
/// errors.
class CheckedFile final : public OIIO::Filesystem::IOProxy {
  public:
    explicit CheckedFile(const std::filesystem::path& file)
        : IOProxy(file.string(), Write), stream_(std::fopen(file.c_str(), "wb")) {
        if (!stream_) note_failure();
    }
    ~CheckedFile() override { finish(); }

    const char* proxytype() const override { return "checked"; }
    bool opened() const override { return stream_ != nullptr; }
    int64_t tell() override { return stream_ ? int64_t(std::ftell(stream_)) : 0; }
    bool seek(int64_t offset) override {
        if (stream_ && std::fseek(stream_, long(offset), SEEK_SET) == 0) return true;
        note_failure();
        return false;
    }
    size_t write(const void* buffer, size_t size) override {
        const size_t written = stream_ ? std::fwrite(buffer, 1, size, stream_) : 0;
        if (written != size) note_failure();
        return written;
    }
    /// The encoder may close and go on; the file is closed by finish().
    void close() override {}

    /// Closes; returns what went wrong first, or an empty text.
    std::string finish() {
        if (stream_ && std::fclose(stream_) != 0) note_failure();
        stream_ = nullptr;
        return failure_;
    }

  private:
    void note_failure() {
        if (failure_.empty()) failure_ = std::strerror(errno);
    }

    std::FILE* stream_;
    std::string failure_;
};

} // namespace

void write_pixels(const std::filesystem::path& file, const char* format, const OIIO::ImageSpec& spec,
                  const OIIO::TypeDesc& type, const void* pixels) {
    AtomicFile atomic(file);
    CheckedFile stream(atomic.temporary());
    std::string message;
    {
        std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(format);
        if (!output) atomic.fail(fmt::format("cannot be written as {}: {}", format, OIIO::geterror()));
        output->set_ioproxy(&stream);
        const bool is_written =
            output->open(atomic.temporary().string(), spec) && output->write_image(type, pixels);
        const bool is_closed = output->close();
        if (!is_written || !is_closed) message = output->geterror();
        if ((!is_written || !is_closed) && message.empty()) message = "the encoder failed";
    }
    const std::string disk_message = stream.finish();
    if (!disk_message.empty()) atomic.fail("cannot be written: " + disk_message);
    if (!message.empty()) atomic.fail("cannot be written: " + message);
    atomic.commit();
}

} // namespace relief
