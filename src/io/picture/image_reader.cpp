// read_texture and read_image: pixels as stored.
#include <algorithm>
#include <fstream>
#include <iterator>
#include <memory>
#include <new>
#include <sstream>
#include <utility>

#include "image/texel_layout.h"
#include "io/picture/color_space.h"
#include "io/picture/image_input.h"
#include "relief/error.h"
#include "relief/io.h"

namespace relief {

namespace {

constexpr uint16_t kHalfOne = 0x3c00;

/// Room for all texels: channels that the file lacks are 0, a missing fourth is 1.
template <class T> std::vector<T> make_texels(const Texture& texture, T one) {
    std::vector<T> texels(texture.value_count(), T(0));
    for (size_t i = 3; texture.stride == 4 && i < texels.size(); i += 4) texels[i] = one;
    return texels;
}

/// A data window smaller than the display window is put into its place; what the file leaves out is 0.
template <class T>
void place_in_display_window(const PixelHeader& header, const Texture& texture, std::vector<T>& texels) {
    if (texels.empty()) return;
    const size_t stride = texture.stride;
    std::vector<T> placed(texture.value_count(), T(0));
    for (int y = 0; y < header.height; ++y) {
        const int row = header.y + y - header.full_y;
        if (row < 0 || row >= header.full_height) continue;
        for (int x = 0; x < header.width; ++x) {
            const int column = header.x + x - header.full_x;
            if (column < 0 || column >= header.full_width) continue;
            const auto* source = &texels[stride * (size_t(y) * header.width + x)];
            std::copy(source, source + stride, &placed[texture.find_texel(size_t(column), size_t(row))]);
        }
    }
    texels = std::move(placed);
}

Texture read_pixels(PixelSource& source, const std::string& name) {
    const PixelHeader& header = source.header();
    const int channel_count = int(std::min<size_t>(4, header.channels.size()));
    Texture texture;
    texture.file = name;
    texture.width = uint32_t(header.width);
    texture.height = uint32_t(header.height);
    texture.channel_count = uint32_t(channel_count);
    texture.stride = Texture::choose_stride(header.channels.size());
    texture.source_type = header.type;
    if (texture.source_type == SampleType::float16) {
        texture.halves = make_texels(texture, kHalfOne);
        source.read_halves(channel_count, texture.stride, texture.halves.data());
    } else {
        texture.floats = make_texels(texture, 1.0f);
        source.read_floats(channel_count, texture.stride, texture.floats.data());
    }
    const bool is_whole = header.x == header.full_x && header.y == header.full_y &&
                          header.width == header.full_width && header.height == header.full_height;
    if (!is_whole && has_near_display(header)) {
        texture.width = uint32_t(header.full_width);
        texture.height = uint32_t(header.full_height);
        place_in_display_window(header, texture, texture.floats);
        place_in_display_window(header, texture, texture.halves);
    }
    return texture;
}

void add_remarks(PictureRemarks remarks, Texture& texture) {
    texture.warnings = std::move(remarks.warnings), texture.notes = std::move(remarks.notes);
    texture.is_cube_map = remarks.is_cube_map;
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
    return with_memory_error(file.string(), [&] {
        const PictureName name = split_picture_name(file.string());
        PictureRemarks remarks;
        const std::unique_ptr<PixelSource> source = open_texture(name, remarks);
        Texture texture = read_pixels(*source, file.string());
        std::ranges::move(source->list_warnings(), std::back_inserter(remarks.warnings));
        add_remarks(std::move(remarks), texture);
        std::ifstream stream(name.file, std::ios::binary);
        texture.colour_tag = find_color_tag(stream);
        return texture;
    });
}

Texture parse_texture(std::string_view bytes, const std::string& name) {
    return with_memory_error(name, [&] {
        PictureRemarks remarks;
        const std::unique_ptr<PixelSource> source = open_texture_bytes(bytes, name, remarks);
        Texture texture = read_pixels(*source, name);
        std::ranges::move(source->list_warnings(), std::back_inserter(remarks.warnings));
        add_remarks(std::move(remarks), texture);
        std::istringstream stream{std::string(bytes)};
        texture.colour_tag = find_color_tag(stream);
        return texture;
    });
}

Image read_image(const std::filesystem::path& file) {
    return with_memory_error(file.string(), [&] {
        const std::unique_ptr<PixelSource> source = open_image(file);
        const PixelHeader& header = source->header();
        Image image;
        image.width = header.width, image.height = header.height;
        image.x0 = header.x - header.full_x, image.y0 = header.y - header.full_y;
        image.full_width = header.full_width, image.full_height = header.full_height;
        image.channels = header.channels;
        image.metadata = header.metadata;
        image.source_type = header.type;
        const size_t channel_count = header.channels.size();
        image.pixels.resize(size_t(header.width) * size_t(header.height) * channel_count);
        source->read_floats(int(channel_count), channel_count, image.pixels.data());
        convert_picture(ColorWay::from_file, image);
        return image;
    });
}

} // namespace relief
