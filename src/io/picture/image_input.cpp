#include "io/picture/image_input.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <sstream>

#include <fmt/format.h>

#include "base/suggest.h"
#include "io/file_system.h"
#include "io/picture/exr_header.h"
#include "io/picture/exr_source.h"
#include "io/picture/picture_library.h"
#include "io/picture/png_header.h"
#include "io/picture/png_source.h"
#include "io/picture/tiff_header.h"
#include "relief/error.h"
#include "relief/io.h"
#include "relief/scene.h"

namespace relief {

namespace {

constexpr int kMaxSide = kMaxPictureSize;
constexpr uint64_t kMaxTexels = uint64_t(1) << 31;
constexpr size_t kMaxChannels = 1024;
constexpr std::array<std::string_view, 8> kExtensions = {".exr", ".tif", ".tiff", ".tx",
                                                         ".png", ".hdr", ".jpg",  ".jpeg"};
const char* const kDamagedPictureHint = "the file is damaged or incomplete: export or copy it again";

[[noreturn]] void fail(const std::string& name, const std::string& message, const std::string& hint) {
    throw Error(ErrorKind::bad_input, {message, name, hint});
}

void check_size(const PixelHeader& header, const std::string& name, uint64_t file_bytes) {
    if (header.is_deep) fail(name, "is a deep image", "flatten it first");
    if (header.width <= 0 || header.height <= 0 || header.channels.empty())
        fail(name, fmt::format("has no pixels ({} x {})", header.width, header.height), kDamagedPictureHint);
    const uint64_t pixels = uint64_t(header.width) * uint64_t(header.height);
    if (header.width > kMaxSide || header.height > kMaxSide || header.depth > 1 || pixels > kMaxTexels ||
        header.channels.size() > kMaxChannels)
        fail(name,
             fmt::format("is too large: {} x {} with {} channels", header.width, header.height,
                         header.channels.size()),
             fmt::format("the limit is {} a side and 2^31 texels", kMaxSide));
    // No supported compression packs constant pixels tighter than this: longer claims are damage.
    constexpr uint64_t kBestCompression = 8192, kSlack = uint64_t(4) << 20;
    // A display window that surrounds the pixels is filled up with zeros, which takes memory as well.
    const uint64_t display_pixels =
        has_near_display(header) ? uint64_t(header.full_width) * uint64_t(header.full_height) : 0;
    if (std::max(pixels, display_pixels) * header.pixel_bytes > file_bytes * kBestCompression + kSlack)
        fail(name,
             fmt::format("claims {} x {} pixels in a file of {} bytes", header.width, header.height,
                         file_bytes),
             kDamagedPictureHint);
}

void check_extension(const std::string& name) {
    const std::string extension = get_lower_extension(name);
    if (std::ranges::find(kExtensions, extension) == kExtensions.end())
        throw Error(ErrorKind::bad_input, {fmt::format("unknown kind of image '{}'", extension), name,
                                           suggest_word(extension, kExtensions)});
}

/// The picture library would try all its readers on other bytes, some of which believe any size.
void check_start(std::istream& stream, const std::string& name) {
    constexpr std::array<std::string_view, 6> kStarts = {"\x76\x2f\x31\x01", "II",       "MM",
                                                         "\x89PNG",          "\xff\xd8", "#?"};
    constexpr size_t kLongest =
        std::ranges::max(kStarts, {}, [](std::string_view s) { return s.size(); }).size();
    std::string start(kLongest, '\0');
    stream.read(start.data(), std::streamsize(start.size()));
    start.resize(size_t(stream.gcount()));
    if (std::ranges::none_of(kStarts, [&](std::string_view known) { return start.starts_with(known); }))
        fail(name, "is no EXR, TIFF, PNG, JPEG or HDR file: it starts otherwise", kDamagedPictureHint);
    stream.clear();
    stream.seekg(0);
}

void check_attributes(std::istream& stream, const std::string& name, uint64_t file_bytes) {
    if (const std::optional<std::string> attribute = find_missized_exr_attribute(stream, file_bytes))
        fail(name,
             fmt::format("is damaged: attribute '{}' is longer than the file, or not as long as its type",
                         *attribute),
             kDamagedPictureHint);
    stream.clear();
    stream.seekg(0);
    if (has_oversized_png_chunk(stream, file_bytes))
        fail(name, "is damaged: it ends within a chunk", kDamagedPictureHint);
    stream.clear();
    stream.seekg(0);
}

#ifdef RELIEF_PICTURES
constexpr bool kHasPictureLibrary = true;
#else
constexpr bool kHasPictureLibrary = false;
#endif

/// Plain EXR files are read at once, and PNG files where there is no library of pictures; all else is left to
/// that.
template <class OpenStream, class OpenOther>
std::unique_ptr<PixelSource> open(const OpenStream& open_stream, const std::string& name, uint64_t file_bytes,
                                  const OpenOther& open_other) {
    std::unique_ptr<std::istream> stream = open_stream();
    check_start(*stream, name);
    check_attributes(*stream, name, file_bytes);
    std::unique_ptr<PixelSource> source = open_plain_exr(std::move(stream), name);
    if (!source && !kHasPictureLibrary) source = open_png(open_stream(), name);
    if (!source) source = open_other();
    check_size(source->header(), name, file_bytes);
    return source;
}

} // namespace

bool is_picture_name(const std::filesystem::path& file) {
    return std::ranges::find(kExtensions, get_lower_extension(file.string())) != kExtensions.end();
}

bool has_near_display(const PixelHeader& header) {
    return header.full_width > 0 && header.full_height > 0 && header.full_width <= 4 * header.width &&
           header.full_height <= 4 * header.height;
}

std::string find_color_tag(std::istream& stream) {
    for (std::string (*find)(std::istream&) : {find_png_color_tag, find_exr_color_tag, find_tiff_color_tag}) {
        std::string tag = find(stream);
        stream.clear();
        stream.seekg(0);
        if (!tag.empty()) return tag;
    }
    return {};
}

std::unique_ptr<PixelSource> open_image(const std::filesystem::path& file) {
    require_file(file);
    refuse_foreign_file(file);
    const std::string name = file.string();
    check_extension(name);
    return open([&] { return std::make_unique<std::ifstream>(file, std::ios::binary); }, name,
                std::filesystem::file_size(file), [&] { return get_picture_library(name).open_file(name); });
}

std::unique_ptr<PixelSource> open_image_bytes(std::string_view bytes, const std::string& name) {
    check_extension(name);
    return open([&] { return std::make_unique<std::istringstream>(std::string(bytes)); }, name, bytes.size(),
                [&] { return get_picture_library(name).open_bytes(bytes, name); });
}

} // namespace relief
