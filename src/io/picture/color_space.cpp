#include "io/picture/color_space.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "base/suggest.h"
#include "formulas/tonemap.h"
#include "io/picture/picture_library.h"
#include "relief/error.h"
#include "relief/half.h"

namespace relief {

namespace {

constexpr std::string_view kLinear = "linear", kSrgb = "srgb";

template <size_t n> bool is_one_of(const std::string_view (&names)[n], std::string_view name) {
    return std::find(std::begin(names), std::end(names), name) != std::end(names);
}

template <class Convert> void convert_texels(Texture& texture, const Convert& convert) {
    if (!texture.halves.empty()) {
        texture.floats.resize(texture.halves.size());
        std::ranges::transform(texture.halves, texture.floats.begin(), half_to_float);
        texture.halves = {};
    }
    const size_t count = size_t(texture.width) * texture.height;
    parallel_for("color_space", count, 65536, [&](size_t begin, size_t end) {
        for (size_t k = begin; k < end; ++k) {
            float* texel = &texture.floats[texture.stride * k];
            if (texture.stride == 1) { // grey
                texel[0] = convert(Vec3f{texel[0], texel[0], texel[0]}).x;
                continue;
            }
            const Vec3f color = convert(Vec3f{texel[0], texel[1], texel[2]});
            texel[0] = color.x, texel[1] = color.y, texel[2] = color.z;
        }
    });
}

using ColorChannels = std::array<size_t, 3>;

/// R, G, B of a picture and of its layers.
std::vector<ColorChannels> find_color_channels(const Image& image) {
    std::vector<ColorChannels> found;
    for (const std::string& name : image.channels) {
        if (name != "R" && !name.ends_with(".R")) continue;
        if (name.starts_with("variance") || name.starts_with("Crypto")) continue;
        const std::string layer = name.substr(0, name.size() - 1);
        const auto r = image.find_channel(name), g = image.find_channel(layer + "G"),
                   b = image.find_channel(layer + "B");
        if (g && b) found.push_back({*r, *g, *b});
    }
    return found;
}

void convert_pixels(const ColorTransform& transform, Image& image) {
    const std::vector<ColorChannels> layers = find_color_channels(image);
    const size_t stride = image.channels.size();
    parallel_for("color_space", image.pixels.size() / stride, 65536, [&](size_t begin, size_t end) {
        for (size_t k = begin; k < end; ++k)
            for (const auto& [r, g, b] : layers) {
                float* pixel = &image.pixels[k * stride];
                const Vec3f color = transform.apply({pixel[r], pixel[g], pixel[b]});
                pixel[r] = color.x, pixel[g] = color.y, pixel[b] = color.z;
            }
    });
}

} // namespace

Chromaticities find_chromaticities(std::string_view space) {
    if (space == "acescg") // SMPTE ST 2065-1 and S-2014-004
        return {{0.713f, 0.293f}, {0.165f, 0.830f}, {0.128f, 0.044f}, {0.32168f, 0.33767f}};
    if (space == "aces2065-1") return {{0.7347f, 0.2653f}, {0, 1}, {0.0001f, -0.077f}, {0.32168f, 0.33767f}};
    return {{0.64f, 0.33f}, {0.3f, 0.6f}, {0.15f, 0.06f}, {0.3127f, 0.3290f}}; // ITU-R BT.709
}

void decode_texture(const std::string& space, Texture& texture) {
    if (space == kLinear) return;
    if (space == kSrgb) {
        convert_texels(texture, [](const Vec3f& c) {
            return Vec3f{scalar::decode_srgb(c.x), scalar::decode_srgb(c.y), scalar::decode_srgb(c.z)};
        });
        return;
    }
    const std::unique_ptr<ColorTransform> transform =
        get_picture_library("color_space").make_color_space(space, ColorWay::from_file);
    if (!transform)
        throw Error(
            ErrorKind::bad_input,
            {"no colour space of that name: '" + space + "'", "",
             suggest_word(space, kTextureSpaces) +
                 "; others come from the OpenColorIO configuration that the environment variable OCIO "
                 "names"});
    convert_texels(texture, [&](const Vec3f& color) { return transform->apply(color); });
}

void convert_picture(ColorWay way, Image& image) {
    const auto entry = image.metadata.find(kColorSpaceTag);
    if (entry == image.metadata.end() || entry->second == kLinear) return;
    if (!is_one_of(kPictureSpaces, entry->second))
        throw Error(ErrorKind::bad_input,
                    {"no colour space of pictures has that name: '" + entry->second + "'", "",
                     suggest_word(entry->second, kPictureSpaces)});
    convert_pixels(*get_picture_library("color_space").make_color_space(entry->second, way), image);
}

} // namespace relief
