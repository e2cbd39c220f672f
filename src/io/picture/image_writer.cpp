// write_image and check_writable.
#include <algorithm>
#include <array>
#include <optional>

#include <fmt/format.h>

#include "base/suggest.h"
#include "io/file_system.h"
#include "io/picture/color_space.h"
#include "io/picture/display_transform.h"
#include "io/picture/image_coders.h"
#include "relief/error.h"
#include "relief/io.h"

namespace relief {

namespace {

constexpr std::array<std::string_view, 3> kWritable = {".exr", ".png", ".hdr"};

void check_output_extension(const std::filesystem::path& file) {
    const std::string extension = get_lower_extension(file);
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
std::array<size_t, 3> find_color_channels(const Image& image) {
    std::array<size_t, 3> result{};
    const std::array<std::string, 3> names = {"R", "G", "B"};
    for (size_t c = 0; c < 3; ++c) {
        const auto found = std::find(image.channels.begin(), image.channels.end(), names[c]);
        if (found != image.channels.end()) result[c] = size_t(found - image.channels.begin());
    }
    return result;
}

FillRow<Vec3f> make_color_rows(const Image& image) {
    return [&image, channels = find_color_channels(image)](int y, std::vector<Vec3f>& row) {
        const float* pixel = &image.pixels[size_t(y) * size_t(image.width) * image.channels.size()];
        for (Vec3f& color : row) {
            color = {pixel[channels[0]], pixel[channels[1]], pixel[channels[2]]};
            pixel += image.channels.size();
        }
    };
}

/// What of a pixel is shown: of a film without background its own colour, to be laid over another.
class ShownPixel {
  public:
    ShownPixel(const Image& image, const DisplaySettings& settings)
        : settings_(settings),
          channels_(find_color_channels(image)),
          alpha_channel_(image.find_channel("A")),
          is_over_(settings.is_transparent || settings.background) {}

    /// The values of pixel (x, y) of the display window: three, or four for a transparent film. Returns the
    /// byte after them.
    uint8_t* write(const float* pixel, uint32_t x, uint32_t y, uint8_t* byte) const {
        Vec3f color{pixel[channels_[0]], pixel[channels_[1]], pixel[channels_[2]]};
        const float alpha = is_over_ ? std::clamp(pixel[*alpha_channel_], 0.0f, 1.0f) : 1;
        if (alpha > 0 && alpha < 1) color = color * (1 / alpha);
        const float dither = find_dither(x, y);
        Vec3f shown{};
        if (settings_.bits == 8) shown = lay_over(estimate_color(color, settings_), alpha);
        if (settings_.bits != 8 || is_in_doubt(shown, dither))
            shown = lay_over(show_color(color, settings_), alpha);
        for (const float value : {shown.x, shown.y, shown.z}) byte = write_value(value, dither, byte);
        return settings_.is_transparent ? write_value(alpha, dither, byte) : byte;
    }

  private:
    /// In (0, 1), spread evenly over the picture: a lattice of the plastic number (Roberts 2018, "The
    /// Unreasonable Effectiveness of Quasirandom Sequences"). Slow gradients keep their mean in place of
    /// bands.
    static float find_dither(uint32_t x, uint32_t y) {
        constexpr uint32_t kStepX = 3242174889u, kStepY = 2447445414u; // 2^32 / 1.3247..., and again
        return float((x * kStepX + y * kStepY) >> 8) * 0x1p-24f;
    }
    Vec3f lay_over(const Vec3f& shown, float alpha) const {
        return settings_.background ? shown * alpha + *settings_.background * (1 - alpha) : shown;
    }
    /// In steps of the stored values; the whole part is stored. Values of whole steps stay what they are.
    float find_step(float value, float dither) const {
        constexpr float kMargin = 0.004f;
        const float greatest = float((1 << settings_.bits) - 1);
        return value * greatest + kMargin + dither * (1 - 2 * kMargin);
    }
    /// The exact value may be stored as another byte than its estimate.
    bool is_in_doubt(const Vec3f& estimate, float dither) const {
        constexpr float kDoubt = 255 * kEstimateTolerance + 1e-4f; // and what is lost by rounding
        const auto is_near_border = [&](float value) {
            const float step = find_step(value, dither);
            return uint32_t(step - kDoubt) != uint32_t(step + kDoubt);
        };
        return is_near_border(estimate.x) || is_near_border(estimate.y) || is_near_border(estimate.z);
    }
    uint8_t* write_value(float value, float dither, uint8_t* byte) const {
        const auto stored = uint32_t(find_step(value, dither));
        if (settings_.bits == 16) *byte++ = uint8_t(stored >> 8);
        *byte++ = uint8_t(stored);
        return byte;
    }

    DisplaySettings settings_;
    std::array<size_t, 3> channels_;
    std::optional<size_t> alpha_channel_;
    bool is_over_;
};

void encode_shown_png(const Image& image, CheckedFile& stream) {
    const DisplaySettings settings = read_display_settings(image);
    const ShownPixel shown(image, settings);
    const PngKind kind{settings.is_transparent ? 4 : 3, settings.bits,
                       settings.transform == DisplayTransform::raw ? PngMeaning::linear : PngMeaning::srgb};
    encode_png(
        image.width, image.height, kind,
        [&](int y, std::vector<uint8_t>& row) {
            const size_t channels = image.channels.size();
            const float* pixel = &image.pixels[size_t(y) * size_t(image.width) * channels];
            uint8_t* byte = row.data();
            for (int x = 0; x < image.width; ++x, pixel += channels)
                byte = shown.write(pixel, uint32_t(image.x0 + x), uint32_t(image.y0 + y), byte);
        },
        stream);
}

} // namespace

void write_image(const Image& image, const std::filesystem::path& file) {
    check_output_extension(file);
    check_image(image, file);
    const std::string extension = get_lower_extension(file);
    std::optional<Image> converted; // to the space that the header names
    if (extension == ".exr" && image.metadata.contains(kColorSpaceTag))
        convert_picture(ColorWay::to_file, converted.emplace(image));
    write_checked(file, [&](CheckedFile& stream) {
        if (extension == ".exr")
            encode_exr(converted ? *converted : image, stream);
        else if (extension == ".hdr")
            encode_hdr(image.width, image.height, make_color_rows(image), stream);
        else
            encode_shown_png(image, stream);
    });
}

void check_tone_map(const std::string& name) {
    if (std::find(std::begin(kDisplayTransforms), std::end(kDisplayTransforms), name) ==
        std::end(kDisplayTransforms))
        throw Error(ErrorKind::usage,
                    {"no display transform of that name", name, suggest_word(name, kDisplayTransforms)});
    Image image;
    image.metadata["relief:display"] = name;
    read_display_settings(image);
}

void check_writable(const std::filesystem::path& file) {
    check_output_extension(file);
    check_text_writable(file);
}

} // namespace relief
