#include "io/picture/image_input.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <functional>
#include <sstream>
#include <utility>

#include <fmt/format.h>

#include "base/suggest.h"
#include "io/file_system.h"
#include "io/foreign_files.h"
#include "io/picture/exr_header.h"
#include "io/picture/exr_layers.h"
#include "io/picture/exr_source.h"
#include "io/picture/hdr_source.h"
#include "io/picture/jpeg_source.h"
#include "io/picture/picture_library.h"
#include "io/picture/picture_text.h"
#include "io/picture/png_header.h"
#include "io/picture/png_source.h"
#include "io/picture/tiff_header.h"
#include "io/picture/tiff_source.h"
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
    // No supported compression packs constant pixels, as stored, tighter than this: longer claims are damage.
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

/// First bytes of kinds that are not read, and the usual end of their names.
constexpr std::array<std::pair<std::string_view, std::string_view>, 17> kOtherStarts = {
    {{"RIFF", ".webp"},
     {"DDS ", ".dds"},
     {"\xabKTX 11", ".ktx"},
     {"\xabKTX 20", ".ktx2"},
     {"SDPX", ".dpx"},
     {"XPDS", ".dpx"},
     {"\x80\x2a\x5f\xd7", ".cin"},
     {"GIF8", ".gif"},
     {"8BPS", ".psd"},
     {"gimp xcf", ".xcf"},
     {std::string_view("\0\0\0\x0cjP", 6), ".jp2"},
     {std::string_view("\0\0\0\x0cJXL", 7), ".jxl"},
     {"\xff\x0a", ".jxl"},
     {"PF\n", ".pfm"},
     {"Pf\n", ".pfm"},
     {"P6\n", ".ppm"},
     {"BM", ".bmp"}}};

/// The picture library would try all its readers on other bytes, some of which believe any size.
void check_start(std::istream& stream, const std::string& name) {
    constexpr std::array<std::string_view, 8> kStarts = {"\x76\x2f\x31\x01",
                                                         std::string_view("II\x2a\0", 4),
                                                         std::string_view("MM\0\x2a", 4),
                                                         std::string_view("II\x2b\0", 4),
                                                         std::string_view("MM\0\x2b", 4),
                                                         "\x89PNG\r\n\x1a\n",
                                                         "\xff\xd8",
                                                         "#?"};
    constexpr size_t kLongest = 16;
    std::string start(kLongest, '\0');
    stream.read(start.data(), std::streamsize(start.size()));
    start.resize(size_t(stream.gcount()));
    if (std::ranges::none_of(kStarts, [&](std::string_view known) { return start.starts_with(known); })) {
        for (const auto& [known, extension] : kOtherStarts)
            if (start.starts_with(known))
                if (const auto foreign = find_foreign_file(fmt::format("picture{}", extension)))
                    fail(
                        name,
                        fmt::format("holds another kind of picture than its name says: {}", foreign->message),
                        foreign->hint);
        fail(name, "is no EXR, TIFF, PNG, JPEG or HDR file: it starts otherwise", kDamagedPictureHint);
    }
    stream.clear();
    stream.seekg(0);
}

void check_attributes(std::istream& stream, const std::string& name, uint64_t file_bytes) {
    if (const std::optional<std::string> attribute = find_missized_exr_attribute(stream, file_bytes))
        fail(name,
             fmt::format("is damaged: attribute '{}' is longer than the file, or not as long as its type",
                         make_printable(*attribute)),
             kDamagedPictureHint);
    stream.clear();
    stream.seekg(0);
    if (const std::string compression = find_unknown_exr_compression(stream); !compression.empty())
        fail(name, fmt::format("has a compression that this build does not read ({})", compression),
             "save it with ZIP, PIZ or DWAA compression");
    stream.clear();
    stream.seekg(0);
    if (has_oversized_png_chunk(stream, file_bytes))
        fail(name, "is damaged: it ends within a chunk", kDamagedPictureHint);
    stream.clear();
    stream.seekg(0);
}

/// A picture in a file or in memory.
struct Bytes {
    std::string name;
    uint64_t count;
    std::function<std::unique_ptr<std::istream>()> open;
    std::function<std::unique_ptr<PixelSource>()> open_by_library;
};

Bytes find_bytes(const std::filesystem::path& file) {
    require_file(file);
    refuse_foreign_file(file);
    const std::string name = file.string();
    check_extension(name);
    return {name, std::filesystem::file_size(file),
            [file] { return std::make_unique<std::ifstream>(file, std::ios::binary); },
            [name] { return get_picture_library(name).open_file(name); }};
}

/// Finds the bytes of a picture in memory, which must outlive the result.
Bytes find_bytes(std::string_view bytes, const std::string& name) {
    check_extension(name);
    return {name, bytes.size(), [bytes] { return std::make_unique<std::istringstream>(std::string(bytes)); },
            [bytes, name] { return get_picture_library(name).open_bytes(bytes, name); }};
}

void check_bytes(const Bytes& bytes) {
    const std::unique_ptr<std::istream> stream = bytes.open();
    check_start(*stream, bytes.name);
    check_attributes(*stream, bytes.name, bytes.count);
}

/// Opens files of other kinds than plain EXR. The library of pictures gets only EXR files with subsampled
/// channels: hostile files of the other kinds end the process in it.
std::unique_ptr<PixelSource> open_other(const Bytes& bytes, PictureRemarks& remarks) {
    for (const auto& open : {open_hdr, open_tiff, open_jpeg, open_png})
        if (std::unique_ptr<PixelSource> source = open(bytes.open(), bytes.name, remarks)) return source;
    return bytes.open_by_library();
}

/// All channels of the first part.
std::unique_ptr<PixelSource> open_channels(const Bytes& bytes) {
    check_bytes(bytes);
    std::unique_ptr<PixelSource> source = open_plain_exr(bytes.open(), bytes.name);
    PictureRemarks remarks; // nobody asks for them
    if (!source) source = open_other(bytes, remarks);
    check_size(source->header(), bytes.name, bytes.count);
    return source;
}

/// The layer that is meant.
std::unique_ptr<PixelSource> open_layer(const Bytes& bytes, const PictureName& name,
                                        PictureRemarks& remarks) {
    check_bytes(bytes);
    std::unique_ptr<PixelSource> source = open_exr_layer(bytes.open, name, remarks);
    if (source) {
        remarks.is_cube_map = is_exr_cube(*bytes.open());
    } else {
        if (!name.part.empty() || !name.layer.empty())
            fail(name.file, fmt::format("has no layers, and no '{}{}'", name.part, name.layer),
                 "only EXR files have layers and parts");
        source = open_other(bytes, remarks);
    }
    check_size(source->header(), bytes.name, bytes.count);
    return source;
}

} // namespace

bool is_picture_name(const std::filesystem::path& file) {
    const std::string extension = get_lower_extension(split_picture_name(file.string()).file);
    return std::ranges::find(kExtensions, extension) != kExtensions.end();
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
    return open_channels(find_bytes(file));
}

std::unique_ptr<PixelSource> open_image_bytes(std::string_view bytes, const std::string& name) {
    return open_channels(find_bytes(bytes, name));
}

std::unique_ptr<PixelSource> open_texture(const PictureName& name, PictureRemarks& remarks) {
    return open_layer(find_bytes(name.file), name, remarks);
}

std::unique_ptr<PixelSource> open_texture_bytes(std::string_view bytes, const std::string& name,
                                                PictureRemarks& remarks) {
    return open_layer(find_bytes(bytes, name), {name, "", ""}, remarks);
}

std::vector<PicturePart> list_picture_parts(const std::filesystem::path& file) {
    const Bytes bytes = find_bytes(file);
    check_bytes(bytes);
    if (get_lower_extension(bytes.name) != ".exr") return {};
    return list_exr_parts(bytes.open(), bytes.name);
}

} // namespace relief
