// write_image and check_writable.
#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "base/suggest.h"
#include "formulas/tonemap.h"
#include "io/file_system.h"
#include "io/picture/image_coders.h"
#include "relief/error.h"
#include "relief/io.h"

namespace relief {

namespace {

constexpr std::array<std::string_view, 3> kWritable = {".exr", ".png", ".hdr"};

void check_output_extension(const std::filesystem::path& file) {
    const std::string extension = get_extension(file);
    if (std::find(kWritable.begin(), kWritable.end(), extension) != kWritable.end()) return;
    std::error_code code;
    const bool is_folder = std::filesystem::is_directory(file, code);
    if (is_folder || !file.has_filename())
        throw Error(ErrorKind::usage, {is_folder ? "is a folder, not a file" : "a picture needs a file name",
                                       file.string(), "add a file name: .exr, .png or .hdr"});
    throw Error(ErrorKind::usage, {fmt::format("cannot write images of kind '{}'", extension), file.string(),
                                   suggest_word(extension, kWritable)});
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

FillRow<Vec3f> make_colour_rows(const Image& image) {
    return [&image, channels = find_colour_channels(image)](int y, std::vector<Vec3f>& row) {
        const float* pixel = &image.pixels[size_t(y) * size_t(image.width) * image.channels.size()];
        for (Vec3f& colour : row) {
            colour = {pixel[channels[0]], pixel[channels[1]], pixel[channels[2]]};
            pixel += image.channels.size();
        }
    };
}

FillRow<uint8_t> make_shown_rows(const Image& image) {
    return [fill_colours = make_colour_rows(image),
            colours = std::vector<Vec3f>(size_t(image.width))](int y, std::vector<uint8_t>& row) mutable {
        fill_colours(y, colours);
        uint8_t* byte = row.data();
        for (const Vec3f& colour : colours) {
            const Vec3f shown = scalar::tone_map_filmic(colour);
            for (const float value : {shown.x, shown.y, shown.z})
                *byte++ = uint8_t(scalar::encode_srgb(value) * 255.0f + 0.5f);
        }
    };
}

} // namespace

void write_image(const Image& image, const std::filesystem::path& file) {
    check_output_extension(file);
    check_image(image, file);
    const std::string extension = get_extension(file);
    write_checked(file, [&](CheckedFile& stream) {
        if (extension == ".exr")
            encode_exr(image, stream);
        else if (extension == ".hdr")
            encode_hdr(image.width, image.height, make_colour_rows(image), stream);
        else
            encode_png(image.width, image.height, make_shown_rows(image), stream);
    });
}

void check_writable(const std::filesystem::path& file) {
    check_output_extension(file);
    check_text_writable(file);
}

} // namespace relief
