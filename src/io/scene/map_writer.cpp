// write_map: displacement maps as data, never toned or converted.
#include <cmath>

#include <Imath/half.h>
#include <fmt/format.h>

#include "base/progress.h"
#include "image/texel_layout.h"
#include "io/file_system.h"
#include "io/picture/image_coders.h"
#include "io/scene/asset_cache.h"
#include "io/scene/tile_names.h"
#include "relief/error.h"
#include "relief/io.h"

namespace relief {

namespace {

void check_kind(const Displacement& map, const std::filesystem::path& file, MapSamples samples) {
    const std::string extension = get_lower_extension(file);
    const auto refuse = [&](const std::string& message, const char* hint) {
        throw Error(ErrorKind::usage, {message, file.string(), hint});
    };
    if (extension != ".exr" && extension != ".png")
        refuse(fmt::format("cannot write maps of kind '{}'", extension), "known: .exr, .png");
    if ((extension == ".png") != (samples == MapSamples::uint16))
        refuse("samples and kind of file do not go together", ".exr holds half or float, .png uint16");
    if (map.is_udim && !has_tile_token(file.string()))
        refuse("the map has tiles", "put <UDIM> into the name, which stands for 1001, 1002, ...");
    if (!map.is_udim && has_tile_token(file.string()))
        refuse("the map has no tiles", "leave <UDIM> out of the name");
}

/// Throws where a value does not fit the samples, before anything is written.
void check_values(const Texture& texture, const std::filesystem::path& file, MapSamples samples) {
    constexpr float kLargestHalf = 65504;
    if (samples == MapSamples::float32) return;
    const float low = samples == MapSamples::uint16 ? 0 : -kLargestHalf;
    const float high = samples == MapSamples::uint16 ? 1 : kLargestHalf;
    for (uint32_t y = 0; y < texture.height; ++y)
        for (uint32_t x = 0; x < texture.width; ++x)
            for (uint32_t c = 0; c < 3; ++c) {
                const float value = get_texel(texture, x, y, c);
                if (value >= low && value <= high) continue;
                throw Error(ErrorKind::bad_input,
                            {fmt::format("{:g} does not fit into samples of [{:g}, {:g}]", value, low, high),
                             fmt::format("{}, pixel ({}, {})", file.string(), x, y),
                             "say another midlevel or a larger scale, or write 32-bit floats"});
            }
}

/// The same texels as floats or as halves.
Texture make_coded(const Texture& texture, MapSamples samples) {
    Texture result;
    result.width = texture.width, result.height = texture.height;
    result.channel_count = texture.channel_count, result.stride = texture.stride;
    const size_t count = texture.value_count();
    if (samples == MapSamples::float16)
        result.halves.resize(count);
    else
        result.floats.resize(count);
    for (size_t k = 0; k < count; ++k)
        if (samples == MapSamples::float16)
            result.halves[k] = Imath::half(load_value(texture, k)).bits();
        else
            result.floats[k] = load_value(texture, k);
    return result;
}

void write_png_map(const Texture& texture, CheckedFile& stream) {
    const uint32_t channels = texture.channel_count == 1 ? 1 : 3;
    const auto fill_row = [&](int y, std::vector<uint8_t>& row) {
        size_t at = 0;
        for (uint32_t x = 0; x < texture.width; ++x)
            for (uint32_t c = 0; c < channels; ++c) {
                const auto value = uint32_t(std::lround(get_texel(texture, x, uint32_t(y), c) * 65535.0f));
                row[at++] = uint8_t(value >> 8), row[at++] = uint8_t(value & 0xff);
            }
    };
    encode_png(int(texture.width), int(texture.height),
               {.channels = int(channels), .bits = 16, .meaning = PngMeaning::data}, fill_row, stream);
}

void write_tile(const Texture& texture, const std::filesystem::path& file, MapSamples samples) {
    check_values(texture, file, samples);
    if (samples == MapSamples::uint16) {
        write_checked(file, [&](CheckedFile& stream) { write_png_map(texture, stream); });
        return;
    }
    const Texture coded = make_coded(texture, samples);
    write_checked(file, [&](CheckedFile& stream) { encode_exr(coded, stream); });
}

} // namespace

void write_map(const Displacement& map, const std::filesystem::path& file, MapSamples samples,
               const ProgressFunction& on_progress) {
    check_kind(map, file, samples);
    ProgressCounter counter(on_progress, map.tiles.size());
    for (const MapTile& tile : map.tiles) {
        write_tile(*tile.texture, make_tile_name(file, tile.udim), samples);
        counter.add(1);
    }
}

} // namespace relief
