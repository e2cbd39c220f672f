#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <tuple>

#include <fmt/format.h>

#include "base/text_difference.h"
#include "image/cryptomatte.h"
#include "image/sample_range.h"
#include "image/shadow_alpha.h"
#include "relief/error.h"
#include "relief/image.h"

namespace relief {

namespace {

const char* const kSettingsKey = "relief:settings";       ///< bounces, levels and the like
const char* const kInterruptedKey = "relief:interrupted"; ///< pixels lack some of these samples

/// One part with its sample range and the channel of its sample counts.
struct Part {
    const Image* image = nullptr;
    size_t index = 0; ///< position in the input, for messages
    int first = 0, last = 0;
    std::optional<size_t> samples_channel, alpha_channel, shadow_channel;
};

/// One pixel of one part.
struct PartPixel {
    const float* values = nullptr;
    int first = 0; ///< lowest sample
    uint32_t count = 0;
    double hits = 0; ///< samples that hit a surface
    size_t part = 0;
};

enum class Rule { mean, mean_of_hits, direction, variance, samples, depth, id, matte };

[[noreturn]] void throw_bad(size_t part, const std::string& message, const std::string& hint) {
    throw Error(ErrorKind::bad_input, {message, fmt::format("part {}", part + 1), hint});
}

/// First of the three of the layer shadow, which stand together.
std::optional<size_t> find_shadow_channel(const Image& image) {
    const std::optional<size_t> first = image.find_channel(kShadowChannels[0]);
    if (!first) return std::nullopt;
    for (size_t k = 1; k < std::size(kShadowChannels); ++k)
        if (image.find_channel(kShadowChannels[k]) != *first + k) return std::nullopt;
    return first;
}

double find_shadow(const float* values, size_t channel) {
    return find_shadow_alpha(values[channel], values[channel + 1], values[channel + 2]);
}

Part make_part(const Image& image, size_t index) {
    Part part{&image,
              index,
              0,
              0,
              image.find_channel("samples.Y"),
              image.find_channel("A"),
              find_shadow_channel(image)};
    std::tie(part.first, part.last) = read_sample_range(image, index);
    if (!part.samples_channel && image.metadata.contains(kInterruptedKey))
        throw_bad(
            index,
            fmt::format(
                "its render was interrupted: how many of the samples {}:{} a pixel has, it does not say",
                part.first, part.last),
            "render it again, or all parts with image.layers = samples");
    return part;
}

void check_same_picture(const Image& first, const Image& image, size_t index) {
    if (image.full_width != first.full_width || image.full_height != first.full_height)
        throw_bad(index,
                  fmt::format("its picture is {}x{} pixels, that of part 1 {}x{}", image.full_width,
                              image.full_height, first.full_width, first.full_height),
                  "parts of one picture have the same image.width and image.height");
    if (image.channels != first.channels)
        throw_bad(index, "its channels differ from those of part 1",
                  "render all parts with the same image.layers");
    for (const char* key : {"relief:seed", "relief:scene_hash", "relief:background"})
        if (read_entry(image, key) != read_entry(first, key))
            throw_bad(index,
                      fmt::format("its {} is {}, that of part 1 {}", key, read_entry(image, key),
                                  read_entry(first, key)),
                      "parts must come from one scene, one seed and one background");
    // Older versions did not say it.
    const std::string settings = read_entry(image, kSettingsKey);
    const std::string expected = read_entry(first, kSettingsKey);
    if (!settings.empty() && !expected.empty() && settings != expected)
        throw_bad(index, "it was rendered otherwise than part 1: " + describe_difference(settings, expected),
                  "render all parts with the same settings");
}

/// As Film::resolve makes the layers; a layer that is not named is a mean over all samples.
Rule find_rule(const std::string& channel) {
    if (channel == "samples.Y") return Rule::samples;
    const std::string layer = channel.substr(0, channel.find('.'));
    if (layer == "variance") return Rule::variance;
    if (layer == "depth") return Rule::depth;
    if (layer == "id") return Rule::id;
    if (layer == "P" || layer == "uv") return Rule::mean_of_hits;
    if (layer == "N" || layer == "N_camera" || layer == "Ng") return Rule::direction;
    return Rule::mean;
}

/// Index of the colour channel whose variance a channel holds.
size_t find_mean_channel(const Image& image, size_t variance_channel) {
    const std::string& name = image.channels[variance_channel];
    return image.find_channel(name.substr(name.find('.') + 1)).value_or(variance_channel);
}

Image make_empty_union(std::span<const Image> parts) {
    int x0 = parts[0].x0, y0 = parts[0].y0, x1 = x0, y1 = y0;
    for (const Image& part : parts) {
        x0 = std::min(x0, part.x0), y0 = std::min(y0, part.y0);
        x1 = std::max(x1, part.x0 + part.width), y1 = std::max(y1, part.y0 + part.height);
    }
    Image result;
    result.width = x1 - x0, result.height = y1 - y0;
    result.x0 = x0, result.y0 = y0;
    result.full_width = parts[0].full_width, result.full_height = parts[0].full_height;
    result.channels = parts[0].channels;
    result.metadata = parts[0].metadata;
    result.source_type = parts[0].source_type;
    result.pixels.resize(size_t(result.width) * size_t(result.height) * result.channels.size());
    return result;
}

/// Pixels of the parts at (x, y) that have samples, lowest range first.
void gather(const std::vector<Part>& parts, int x, int y, std::vector<PartPixel>& found) {
    found.clear();
    for (const Part& part : parts) {
        const Image& image = *part.image;
        if (x < image.x0 || x >= image.x0 + image.width || y < image.y0 || y >= image.y0 + image.height)
            continue;
        const size_t pixel = size_t(y - image.y0) * size_t(image.width) + size_t(x - image.x0);
        const float* values = image.pixels.data() + pixel * image.channels.size();
        const uint32_t count = part.samples_channel ? uint32_t(std::lround(values[*part.samples_channel]))
                                                    : uint32_t(part.last - part.first);
        double alpha = part.alpha_channel ? double(values[*part.alpha_channel]) : 1.0;
        if (part.shadow_channel) alpha -= find_shadow(values, *part.shadow_channel);
        if (count > 0) found.push_back({values, part.first, count, std::round(alpha * count), part.index});
    }
    std::ranges::stable_sort(found, [](const PartPixel& a, const PartPixel& b) { return a.first < b.first; });
    for (size_t k = 1; k < found.size(); ++k)
        if (int64_t(found[k - 1].first) + found[k - 1].count > found[k].first)
            throw_bad(found[k].part,
                      fmt::format("samples {}:{} of pixel ({}, {}) are in part {} already", found[k].first,
                                  found[k].first + int64_t(found[k].count), x, y, found[k - 1].part + 1),
                      "give each sample range and tile once");
}

double compute_mean(const std::vector<PartPixel>& pixels, size_t channel) {
    double sum = 0, weight = 0;
    for (const PartPixel& pixel : pixels) {
        sum += double(pixel.values[channel]) * pixel.count;
        weight += pixel.count;
    }
    return sum / weight;
}

/// Variance of the joint mean: the parts' sums of squares are recovered from their variances and means.
double compute_variance(const std::vector<PartPixel>& pixels, size_t variance_channel, size_t mean_channel) {
    if (pixels.size() == 1) return pixels[0].values[variance_channel];
    const double mean = compute_mean(pixels, mean_channel);
    double deviations = 0, n = 0;
    for (const PartPixel& pixel : pixels) {
        const double count = pixel.count, offset = pixel.values[mean_channel] - mean;
        deviations += pixel.values[variance_channel] * count * (count - 1) + count * offset * offset;
        n += count;
    }
    return deviations / (n * (n - 1));
}

double compute_mean_of_hits(const std::vector<PartPixel>& pixels, size_t channel) {
    if (pixels.size() == 1) return pixels[0].values[channel];
    double sum = 0, weight = 0;
    for (const PartPixel& pixel : pixels) {
        sum += double(pixel.values[channel]) * pixel.hits;
        weight += pixel.hits;
    }
    return weight > 0 ? sum / weight : 0;
}

/// The part whose first hit is nearest; ties go to the lowest id, as in Film.
const PartPixel& find_nearest(const std::vector<PartPixel>& pixels, size_t depth_channel, size_t id_channel) {
    return *std::ranges::min_element(pixels, [&](const PartPixel& a, const PartPixel& b) {
        const float x = a.values[depth_channel], y = b.values[depth_channel];
        return x < y || (x == y && a.values[id_channel] < b.values[id_channel]);
    });
}

float find_id(const std::vector<PartPixel>& pixels, std::optional<size_t> depth_channel, size_t channel) {
    if (depth_channel) return find_nearest(pixels, *depth_channel, channel).values[channel];
    for (const PartPixel& pixel : pixels)
        if (pixel.values[channel] != 0) return pixel.values[channel];
    return 0;
}

/// Rule that combines a channel of the parts.
struct ChannelRules {
    explicit ChannelRules(const Image& image)
        : depth_channel(image.find_channel("depth.Z")),
          alpha_channel(image.find_channel("A")),
          shadow_channel(find_shadow_channel(image)) {
        for (size_t c = 0; c < image.channels.size(); ++c) {
            rules.push_back(find_rule(image.channels[c]));
            mean_channels.push_back(rules[c] == Rule::variance ? find_mean_channel(image, c) : c);
            if (rules[c] == Rule::direction && image.channels[c].ends_with(".X") &&
                c + 2 < image.channels.size())
                direction_starts.push_back(c);
        }
        for (const char* layer : {kObjectMattes, kMaterialMattes}) add_mattes(image, layer);
    }
    void add_mattes(const Image& image, const char* layer) {
        std::vector<size_t> channels;
        for (const std::string& name : name_matte_channels(layer))
            if (const std::optional<size_t> channel = image.find_channel(name)) channels.push_back(*channel);
        if (channels.size() != 2 * kMatteRanks) return;
        for (const size_t channel : channels) rules[channel] = Rule::matte;
        matte_layers.push_back(std::move(channels));
    }

    std::vector<Rule> rules;
    std::vector<size_t> mean_channels;
    std::vector<size_t> direction_starts;          ///< first of three channels
    std::vector<std::vector<size_t>> matte_layers; ///< channels of each Cryptomatte layer, rank by rank
    std::optional<size_t> depth_channel, alpha_channel, shadow_channel;
};

/// That of what was hit is a mean; that of shadows comes from means that are merged.
double merge_alpha(const std::vector<PartPixel>& pixels, size_t alpha_channel, size_t shadow_channel) {
    double hits = 0, weight = 0;
    std::array<double, 3> shadow{};
    for (const PartPixel& pixel : pixels) {
        hits +=
            (double(pixel.values[alpha_channel]) - find_shadow(pixel.values, shadow_channel)) * pixel.count;
        weight += pixel.count;
        for (size_t k = 0; k < 3; ++k) shadow[k] += double(pixel.values[shadow_channel + k]) * pixel.count;
    }
    return (hits + find_shadow_alpha(shadow[0], shadow[1], shadow[2])) / weight;
}

double merge_channel(const std::vector<PartPixel>& pixels, const ChannelRules& rules, size_t channel) {
    switch (rules.rules[channel]) {
    case Rule::mean:
        return compute_mean(pixels, channel);
    case Rule::mean_of_hits:
    case Rule::direction:
        return compute_mean_of_hits(pixels, channel);
    case Rule::variance:
        return compute_variance(pixels, channel, rules.mean_channels[channel]);
    case Rule::depth:
        return find_nearest(pixels, channel, channel).values[channel];
    case Rule::id:
        return find_id(pixels, rules.depth_channel, channel);
    case Rule::matte: // merge_mattes, all ranks together
        return pixels[0].values[channel];
    case Rule::samples:
        break;
    }
    double count = 0;
    for (const PartPixel& pixel : pixels) count += pixel.count;
    return count;
}

/// Shares of one id are added, in samples, and all are ranked anew.
void merge_mattes(const std::vector<PartPixel>& pixels, const std::vector<size_t>& channels, float* target) {
    std::vector<MatteShare> shares;
    double sample_count = 0;
    for (const PartPixel& pixel : pixels) {
        sample_count += pixel.count;
        for (size_t k = 0; k < channels.size(); k += 2) {
            const uint32_t id = std::bit_cast<uint32_t>(pixel.values[channels[k]]);
            const double samples = std::round(double(pixel.values[channels[k + 1]]) * pixel.count);
            const auto found = std::ranges::find(shares, id, &MatteShare::id);
            if (found != shares.end())
                found->samples += samples;
            else
                shares.push_back({id, samples});
        }
    }
    std::array<float, 2 * kMatteRanks> ranks;
    write_matte_ranks(shares, sample_count, ranks.data());
    for (size_t k = 0; k < channels.size(); ++k) target[channels[k]] = ranks[k];
}

void merge_pixel(const std::vector<PartPixel>& pixels, const ChannelRules& rules, float* target) {
    for (size_t c = 0; c < rules.rules.size(); ++c) target[c] = float(merge_channel(pixels, rules, c));
    if (pixels.size() == 1) return;
    if (rules.alpha_channel && rules.shadow_channel)
        target[*rules.alpha_channel] =
            float(merge_alpha(pixels, *rules.alpha_channel, *rules.shadow_channel));
    for (const std::vector<size_t>& channels : rules.matte_layers) merge_mattes(pixels, channels, target);
    for (const size_t start : rules.direction_starts) {
        float* const v = target + start;
        const double length = std::sqrt(double(v[0]) * v[0] + double(v[1]) * v[1] + double(v[2]) * v[2]);
        for (size_t k = 0; k < 3 && length > 0; ++k) v[k] = float(v[k] / length);
    }
}

/// What parts say of the whole picture, where those that say it agree.
void keep_if_common(std::span<const Image> images, const std::string& key, Image& result) {
    std::string said;
    for (const Image& image : images) {
        const std::string own = read_entry(image, key);
        if (!own.empty() && !said.empty() && own != said) {
            result.metadata.erase(key);
            return;
        }
        if (!own.empty()) said = own;
    }
    if (!said.empty()) result.metadata[key] = said;
}

} // namespace

Image merge_images(std::span<const Image> images) {
    if (images.empty())
        throw Error(ErrorKind::usage, {"there is nothing to merge", "merge", "name the parts"});
    std::vector<Part> parts;
    int first = std::numeric_limits<int>::max(), last = 0;
    for (size_t k = 0; k < images.size(); ++k) {
        check_same_picture(images[0], images[k], k);
        parts.push_back(make_part(images[k], k));
        first = std::min(first, parts.back().first), last = std::max(last, parts.back().last);
    }
    Image result = make_empty_union(images);
    result.metadata[kRenderedTag] = fmt::format("{}:{}", first, last);
    for (const Image& image : images)
        if (image.metadata.contains(kInterruptedKey)) result.metadata[kInterruptedKey] = "yes";
    for (const char* key : {"relief:whole_window", "relief:whole_samples"})
        keep_if_common(images, key, result);
    const ChannelRules rules(result);
    std::vector<PartPixel> pixels;
    float* target = result.pixels.data();
    for (int y = result.y0; y < result.y0 + result.height; ++y)
        for (int x = result.x0; x < result.x0 + result.width; ++x, target += result.channels.size()) {
            gather(parts, x, y, pixels);
            if (!pixels.empty())
                merge_pixel(pixels, rules, target);
            else if (rules.depth_channel)
                target[*rules.depth_channel] = std::numeric_limits<float>::infinity();
        }
    return result;
}

} // namespace relief
