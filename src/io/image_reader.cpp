// read_texture and read_image: pixels as stored.
#include <algorithm>

#include <fmt/format.h>

#include "io/image_input.h"
#include "relief/error.h"
#include "relief/io.h"

namespace relief {

namespace {

const char* const kIncompleteHint = "the file is incomplete: export or copy it again";
constexpr uint16_t kHalfOne = 0x3c00;

template <class T>
void read_texels(ImageInput& image, const OIIO::TypeDesc& type, T one, std::vector<T>& texels) {
    const size_t count = size_t(image.spec.width) * image.spec.height;
    const int channels = std::min(4, image.spec.nchannels);
    texels.assign(4 * count, T(0));
    for (size_t i = 0; i < count; ++i) texels[4 * i + 3] = one;
    if (!image.input->read_image(0, 0, 0, channels, type, texels.data(), OIIO::stride_t(4 * sizeof(T))))
        image.fail("cannot be read: " + image.input->geterror(), kIncompleteHint);
}

/// A data window smaller than the display window is put into its place; what the file leaves out is 0.
template <class T> void place_in_display_window(const OIIO::ImageSpec& spec, std::vector<T>& texels) {
    if (texels.empty()) return;
    std::vector<T> placed(4 * size_t(spec.full_width) * spec.full_height, T(0));
    for (int y = 0; y < spec.height; ++y) {
        const int row = spec.y + y - spec.full_y;
        if (row < 0 || row >= spec.full_height) continue;
        for (int x = 0; x < spec.width; ++x) {
            const int column = spec.x + x - spec.full_x;
            if (column < 0 || column >= spec.full_width) continue;
            const auto* source = &texels[4 * (size_t(y) * spec.width + x)];
            std::copy(source, source + 4, &placed[4 * (size_t(row) * spec.full_width + column)]);
        }
    }
    texels = std::move(placed);
}

Texture read_pixels(ImageInput image) {
    const OIIO::ImageSpec& spec = image.spec;
    Texture texture;
    texture.file = image.name;
    texture.width = uint32_t(spec.width);
    texture.height = uint32_t(spec.height);
    texture.channel_count = uint32_t(std::min(4, spec.nchannels));
    texture.source_type = get_sample_type(spec.format);
    if (texture.source_type == SampleType::float16)
        read_texels(image, OIIO::TypeDesc::HALF, kHalfOne, texture.halves);
    else
        read_texels(image, OIIO::TypeDesc::FLOAT, 1.0f, texture.floats);

    const bool is_whole = spec.x == spec.full_x && spec.y == spec.full_y && spec.width == spec.full_width &&
                          spec.height == spec.full_height;
    if (!is_whole && has_near_display(spec)) {
        place_in_display_window(spec, texture.floats);
        place_in_display_window(spec, texture.halves);
        texture.width = uint32_t(spec.full_width);
        texture.height = uint32_t(spec.full_height);
    }
    return texture;
}

/// Header entries of other programs' making (compression, library hints) are not the picture's.
bool is_own_metadata(const std::string& name) {
    return name != "compression" && !name.starts_with("oiio:") && !name.starts_with("openexr:");
}

template <class Read> auto with_memory_error(const std::string& name, const Read& read) {
    try {
        return read();
    } catch (const std::bad_alloc&) {
        throw Error(ErrorKind::out_of_memory,
                    {"not enough memory for this image", name, "use a smaller image"});
    }
}

} // namespace

Texture read_texture(const std::filesystem::path& file) {
    return with_memory_error(file.string(), [&] { return read_pixels(open_image(file)); });
}

Texture parse_texture(std::string_view bytes, const std::string& name) {
    return with_memory_error(name, [&] { return read_pixels(open_image_bytes(bytes, name)); });
}

Image read_image(const std::filesystem::path& file) {
    return with_memory_error(file.string(), [&] {
        ImageInput source = open_image(file);
        const OIIO::ImageSpec& spec = source.spec;
        Image image;
        image.width = spec.width, image.height = spec.height;
        image.x0 = spec.x - spec.full_x, image.y0 = spec.y - spec.full_y;
        image.full_width = spec.full_width, image.full_height = spec.full_height;
        image.channels = spec.channelnames;
        image.source_type = get_sample_type(spec.format);
        image.pixels.resize(size_t(spec.width) * spec.height * spec.nchannels);
        if (!source.input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, image.pixels.data()))
            source.fail("cannot be read: " + source.input->geterror(), kIncompleteHint);
        for (const OIIO::ParamValue& entry : spec.extra_attribs) {
            const std::string name = entry.name().string();
            if (entry.type() == OIIO::TypeString && is_own_metadata(name))
                image.metadata[name] = entry.get_string();
        }
        return image;
    });
}

} // namespace relief
