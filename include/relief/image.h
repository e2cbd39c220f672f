// Images with named channels, textures with raw texels; comparing and merging finished images. All functions
// are thread safe.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace relief {

/// How the samples of a file were stored before they were read.
enum class SampleType { uint8, uint16, uint32, float16, float32 };

/// An image with any number of layers: interleaved 32-bit floats, row 0 at the top. The pixels cover the data
/// window [x0, x0 + width) x [y0, y0 + height) of a display window [0, full_width) x [0, full_height).
struct Image {
    int width = 0, height = 0;
    int x0 = 0, y0 = 0;
    int full_width = 0, full_height = 0;
    std::vector<std::string> channels;           ///< "R", "depth.Z", ...: one name per channel, all distinct
    std::vector<float> pixels;                   ///< width * height * channels.size()
    std::map<std::string, std::string> metadata; ///< header entries, e.g. "relief:seed"
    SampleType source_type = SampleType::float32;

    /// Index of a channel by its full name; nullopt if absent.
    std::optional<size_t> find_channel(const std::string& name) const;
    /// (x, y) in display-window pixels; must lie inside the data window.
    float& at(int x, int y, size_t channel);
    float at(int x, int y, size_t channel) const;
};

/// Entry of the header of every rendered picture: which samples it holds, "A:B".
inline constexpr const char* kRenderedTag = "relief:samples";

/// Texture::colour_tag of a PNG file whose header says that its values are linear.
inline constexpr const char* kLinearTag = "gAMA chunk of linear values";

/// Texels as stored in the file, never colour converted: four interleaved channels (missing ones are 0, a
/// missing fourth is 1; `channel_count` is the number in the file), row 0 at the top. Exactly one of `floats`
/// and `halves` is filled.
struct Texture {
    uint32_t width = 0, height = 0;
    uint32_t channel_count = 0;
    SampleType source_type = SampleType::float32;
    /// Values a texel in `floats` and `halves`: 4, where channels that the file lacks are 0 and a missing
    /// fourth is 1; or, of textures with 3 channels or 1, as many as there are channels.
    uint32_t stride = 4;
    std::vector<float> floats;    ///< value_count() of them, or empty; integers are scaled to [0, 1]
    std::vector<uint16_t> halves; ///< likewise, IEEE 754 binary16 bits
    std::string file;             ///< for messages
    /// What in the file marks the values as colours ("sRGB chunk"), kRenderedTag: as a picture of Relief's
    /// own; empty: nothing.
    std::string colour_tag;
    /// How the file was read where that is in doubt, as layers that were left out; and where it is not.
    std::vector<std::string> warnings, notes;
    bool is_cube_map = false; ///< six faces of a cube, and no picture of a sphere's surroundings
    /// The least stride for so many channels.
    static constexpr uint32_t choose_stride(size_t channel_count) {
        return channel_count == 1 || channel_count == 3 ? uint32_t(channel_count) : 4;
    }
    /// Values that all texels have, row by row, and 4 - stride zeros, so that four can be read from each
    /// texel on.
    size_t value_count() const { return size_t(stride) * width * height + (4 - stride); }
    /// Where the values of the texel in column x and row y begin.
    size_t find_texel(size_t x, size_t y) const { return stride * (y * width + x); }
    /// Bytes of texel data.
    size_t byte_count() const { return floats.size() * sizeof(float) + halves.size() * sizeof(uint16_t); }
};

/// Difference of two images in one layer.
struct ImageDifference {
    size_t pixels = 0;         ///< pixels compared
    size_t one_only = 0;       ///< pixels that are finite in one image only
    size_t over_threshold = 0; ///< pixels whose difference is above the threshold, one_only included
    double max = 0, mean = 0, rms = 0;
};

/// Compares layer `layer` ("" is R, G, B) of two images with the same data window. Differences are relative
/// to the larger value for "depth", absolute for all other layers; `threshold` is in the same unit. Throws
/// Error{bad_input} when windows or channels differ.
ImageDifference compare_images(const Image& a, const Image& b, const std::string& layer, double threshold);

/// Merges tiles and sample ranges of one picture; the result equals one render of all samples, up to
/// rounding. Colour, alpha, light, albedo and cost are means weighted by the parts' "samples.Y"; P and uv are
/// weighted by the samples that hit, which are A times samples; depth is the minimum, id that of the nearest
/// hit (without a depth layer: of the lowest sample range that hit); variance is that of the combined mean;
/// ranks of Cryptomatte are made anew from the shares of all parts. N, N_camera and Ng are approximate: parts
/// hold unit vectors, so their renormalised mean weighted by hits differs from that of all samples where the
/// normals within a pixel vary. Pixels that no part covers are 0, their depth infinity. Parts carry
/// "relief:samples" = "A:B" and, unless one sample range covers each whole part, the layer "samples". Throws
/// Error{bad_input} for parts of different pictures (scene hash, seed, size, channels, "relief:settings") or
/// overlapping sample ranges of a pixel.
Image merge_images(std::span<const Image> parts);

/// Samples [first_sample, last_sample) that pixels [x0, x1) x [y0, y1) of the display window lack.
struct PictureGap {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    int first_sample = 0, last_sample = 0;
    friend bool operator==(const PictureGap&, const PictureGap&) = default;
};

/// What `parts`, as merge_images takes them, leave out of a whole picture: of the window that
/// "relief:whole_window" names, else of their data window where all have the same one, else of the display
/// window; and of the samples from 0 to "relief:whole_samples", or to the last that any part has. A part
/// with "samples.Y" counts by its least pixel, within each window that no edge of another part crosses. By
/// rows. Throws Error{bad_input} for a part without "relief:samples".
std::vector<PictureGap> find_gaps(std::span<const Image> parts);

} // namespace relief
