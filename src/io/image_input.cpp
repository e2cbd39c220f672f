#include "io/image_input.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <sstream>

#include <fmt/format.h>

#include "io/exr_header.h"
#include "io/file_system.h"
#include "io/png_header.h"
#include "relief/error.h"
#include "relief/scene.h"
#include "relief/suggest.h"

namespace relief {

namespace {

constexpr int kMaxSide = kMaxPictureSize;
constexpr int64_t kMaxTexels = int64_t(1) << 31;
constexpr int kMaxChannels = 1024;
constexpr std::array<std::string_view, 8> kExtensions = {".exr", ".tif", ".tiff", ".tx",
                                                         ".png", ".hdr", ".jpg",  ".jpeg"};
const char* const kDamagedHint = "the file is damaged or incomplete: export or copy it again";

OIIO::ImageSpec make_raw_config() {
    OIIO::ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha", 1);
    config.attribute("oiio:RawColor", 1);
    return config;
}

} // namespace

bool has_near_display(const OIIO::ImageSpec& spec) {
    return spec.full_width > 0 && spec.full_height > 0 && spec.full_width <= 4 * spec.width &&
           spec.full_height <= 4 * spec.height;
}

namespace {

void check_size(const ImageInput& image, uint64_t file_bytes) {
    const OIIO::ImageSpec& spec = image.spec;
    if (spec.deep) image.fail("is a deep image", "flatten it first");
    if (spec.width <= 0 || spec.height <= 0 || spec.nchannels <= 0)
        image.fail(fmt::format("has no pixels ({} x {})", spec.width, spec.height), kDamagedHint);
    if (spec.width > kMaxSide || spec.height > kMaxSide || spec.depth > 1 ||
        int64_t(spec.width) * spec.height > kMaxTexels || spec.nchannels > kMaxChannels)
        image.fail(
            fmt::format("is too large: {} x {} with {} channels", spec.width, spec.height, spec.nchannels),
            fmt::format("the limit is {} a side and 2^31 texels", kMaxSide));
    // No supported compression packs constant pixels tighter than this; a longer claim would only exhaust
    // memory.
    constexpr uint64_t kBestCompression = 8192, kSlack = uint64_t(4) << 20;
    // A display window that surrounds the pixels is filled up with zeros, which takes memory as well.
    const uint64_t display_bytes =
        uint64_t(std::max(0, spec.full_width)) * uint64_t(std::max(0, spec.full_height)) * spec.pixel_bytes();
    const uint64_t largest =
        std::max(uint64_t(spec.image_bytes()), has_near_display(spec) ? display_bytes : 0);
    if (largest > file_bytes * kBestCompression + kSlack)
        image.fail(
            fmt::format("claims {} x {} pixels in a file of {} bytes", spec.width, spec.height, file_bytes),
            kDamagedHint);
}

void check_extension(const std::string& name) {
    const std::string extension = get_extension(name);
    if (std::find(kExtensions.begin(), kExtensions.end(), extension) == kExtensions.end())
        throw Error(ErrorKind::bad_input, {fmt::format("unknown kind of image '{}'", extension), name,
                                           suggest_word(extension, kExtensions)});
}

void check_attributes(const ImageInput& image, std::istream& stream, uint64_t file_bytes) {
    if (const std::optional<std::string> name = find_oversized_exr_attribute(stream, file_bytes))
        image.fail(fmt::format("is damaged: attribute '{}' is longer than the file", *name), kDamagedHint);
    stream.clear();
    stream.seekg(0);
    if (has_oversized_png_chunk(stream, file_bytes))
        image.fail("is damaged: it ends within a chunk", kDamagedHint);
}

void open(ImageInput& image, uint64_t file_bytes) {
    const OIIO::ImageSpec config = make_raw_config();
    image.input = OIIO::ImageInput::create(image.name, false, &config, image.proxy.get());
    if (!image.input) image.fail("cannot be opened: " + OIIO::geterror(), kDamagedHint);
    if (image.proxy) image.input->set_ioproxy(image.proxy.get());
    if (!image.input->open(image.name, image.spec, config))
        image.fail("cannot be opened: " + image.input->geterror(), kDamagedHint);
    check_size(image, file_bytes);
}

} // namespace

void ImageInput::fail(const std::string& message, const std::string& hint) const {
    std::string line = message;
    std::replace(line.begin(), line.end(), '\n', ' ');
    throw Error(ErrorKind::bad_input, {line, name, hint});
}

ImageInput open_image(const std::filesystem::path& file) {
    require_file(file);
    check_extension(file.string());
    ImageInput image;
    image.name = file.string();
    std::ifstream stream(file, std::ios::binary);
    check_attributes(image, stream, std::filesystem::file_size(file));
    open(image, std::filesystem::file_size(file));
    return image;
}

ImageInput open_image_bytes(std::string_view bytes, const std::string& name) {
    check_extension(name);
    ImageInput image;
    image.name = name;
    std::istringstream stream{std::string(bytes)};
    check_attributes(image, stream, bytes.size());
    image.proxy = std::make_unique<OIIO::Filesystem::IOMemReader>(bytes.data(), bytes.size());
    open(image, bytes.size());
    return image;
}

SampleType get_sample_type(const OIIO::TypeDesc& type) {
    switch (type.basetype) {
    case OIIO::TypeDesc::UINT8:
    case OIIO::TypeDesc::INT8:
        return SampleType::uint8;
    case OIIO::TypeDesc::UINT16:
    case OIIO::TypeDesc::INT16:
        return SampleType::uint16;
    case OIIO::TypeDesc::UINT32:
    case OIIO::TypeDesc::INT32:
        return SampleType::uint32;
    case OIIO::TypeDesc::HALF:
        return SampleType::float16;
    default:
        return SampleType::float32;
    }
}

} // namespace relief
