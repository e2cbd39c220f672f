// write_image and check_writable.
#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "io/file_system.h"
#include "io/image_output.h"
#include "math/scalar.h"
#include "relief/error.h"
#include "relief/io.h"
#include "relief/suggest.h"

namespace relief {

namespace {

constexpr std::array<std::string_view, 3> kWritable = {".exr", ".png", ".hdr"};

void check_output_extension(const std::filesystem::path& file) {
    const std::string extension = get_extension(file);
    if (std::find(kWritable.begin(), kWritable.end(), extension) == kWritable.end())
        throw Error(ErrorKind::usage, {fmt::format("cannot write images of kind '{}'", extension),
                                       file.string(), suggest_word(extension, kWritable)});
}

void check_image(const Image& image, const std::filesystem::path& file) {
    const bool is_whole = image.width > 0 && image.height > 0 && !image.channels.empty() &&
                          image.pixels.size() == size_t(image.width) * image.height * image.channels.size();
    if (!is_whole) throw Error(ErrorKind::failed, {"the image has no pixels or too few", file.string(), ""});
}

/// Channels R, G, B, or the first one three times for an image without them.
std::array<size_t, 3> find_colour_channels(const Image& image) {
    std::array<size_t, 3> result{};
    const std::array<std::string, 3> names = {"R", "G", "B"};
    for (size_t c = 0; c < 3; ++c) {
        const auto found = std::find(image.channels.begin(), image.channels.end(), names[c]);
        if (found != image.channels.end()) result[c] = size_t(found - image.channels.begin());
    }
    return result;
}

void write_exr(const Image& image, const std::filesystem::path& file) {
    OIIO::ImageSpec spec(image.width, image.height, int(image.channels.size()), OIIO::TypeDesc::FLOAT);
    spec.channelnames = image.channels;
    spec.x = image.x0, spec.y = image.y0;
    spec.full_x = 0, spec.full_y = 0;
    spec.full_width = image.full_width > 0 ? image.full_width : image.x0 + image.width;
    spec.full_height = image.full_height > 0 ? image.full_height : image.y0 + image.height;
    for (const auto& [name, value] : image.metadata) spec.attribute(name, value);
    spec.attribute("compression", "zip");
    write_pixels(file, "openexr", spec, OIIO::TypeDesc::FLOAT, image.pixels.data());
}

std::vector<Vec3f> gather_colours(const Image& image) {
    const std::array<size_t, 3> channels = find_colour_channels(image);
    std::vector<Vec3f> colours(size_t(image.width) * image.height);
    for (size_t i = 0; i < colours.size(); ++i) {
        const float* pixel = &image.pixels[i * image.channels.size()];
        colours[i] = {pixel[channels[0]], pixel[channels[1]], pixel[channels[2]]};
    }
    return colours;
}

void write_hdr(const Image& image, const std::filesystem::path& file) {
    const OIIO::ImageSpec spec(image.width, image.height, 3, OIIO::TypeDesc::FLOAT);
    const std::vector<Vec3f> colours = gather_colours(image);
    write_pixels(file, "hdr", spec, OIIO::TypeDesc::FLOAT, colours.data());
}

void write_png(const Image& image, const std::filesystem::path& file) {
    OIIO::ImageSpec spec(image.width, image.height, 3, OIIO::TypeDesc::UINT8);
    spec.attribute("oiio:ColorSpace", "sRGB");
    std::vector<uint8_t> bytes;
    bytes.reserve(3 * size_t(image.width) * image.height);
    for (const Vec3f& colour : gather_colours(image)) {
        const Vec3f shown = scalar::tone_map_filmic(colour);
        for (const float value : {shown.x, shown.y, shown.z})
            bytes.push_back(uint8_t(scalar::encode_srgb(value) * 255.0f + 0.5f));
    }
    write_pixels(file, "png", spec, OIIO::TypeDesc::UINT8, bytes.data());
}

} // namespace

void write_image(const Image& image, const std::filesystem::path& file) {
    check_output_extension(file);
    check_image(image, file);
    const std::string extension = get_extension(file);
    if (extension == ".exr")
        write_exr(image, file);
    else if (extension == ".hdr")
        write_hdr(image, file);
    else
        write_png(image, file);
}

void check_writable(const std::filesystem::path& file) {
    check_output_extension(file);
    check_text_writable(file);
}

} // namespace relief
