#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "relief/error.h"
#include "relief/image.h"

namespace relief {

namespace {

struct ChannelPair {
    size_t a, b;
};

[[noreturn]] void throw_mismatch(const std::string& message, const std::string& hint) {
    throw Error(ErrorKind::bad_input, {message, "compare", hint});
}

bool belongs_to(const std::string& channel, const std::string& layer) {
    if (layer.empty()) return channel == "R" || channel == "G" || channel == "B";
    return channel == layer || channel.compare(0, layer.size() + 1, layer + ".") == 0;
}

std::vector<ChannelPair> find_pairs(const Image& a, const Image& b, const std::string& layer) {
    std::vector<ChannelPair> pairs;
    size_t count_in_b = 0;
    for (const std::string& name : b.channels) count_in_b += belongs_to(name, layer);
    for (size_t k = 0; k < a.channels.size(); ++k) {
        if (!belongs_to(a.channels[k], layer)) continue;
        const auto other = b.find_channel(a.channels[k]);
        if (!other) throw_mismatch(fmt::format("the second image has no channel {}", a.channels[k]), "");
        pairs.push_back({k, *other});
    }
    const std::string shown = layer.empty() ? "colour" : layer;
    if (pairs.empty())
        throw_mismatch(fmt::format("the first image has no layer {}", shown), "render it with image.layers");
    if (pairs.size() != count_in_b)
        throw_mismatch(fmt::format("the images have different channels in layer {}", shown), "");
    return pairs;
}

double compute_difference(double a, double b, bool is_relative) {
    const double difference = std::fabs(a - b);
    if (!is_relative || difference == 0) return difference;
    return difference / std::max(std::fabs(a), std::fabs(b));
}

} // namespace

ImageDifference compare_images(const Image& a, const Image& b, const std::string& layer, double threshold) {
    if (a.width != b.width || a.height != b.height || a.x0 != b.x0 || a.y0 != b.y0)
        throw_mismatch(fmt::format("the data windows differ: {}x{} at ({}, {}) and {}x{} at ({}, {})",
                                   a.width, a.height, a.x0, a.y0, b.width, b.height, b.x0, b.y0),
                       "render both with the same image.width and image.height, and the same image.crop");
    const std::vector<ChannelPair> pairs = find_pairs(a, b, layer);
    const bool is_relative = layer == "depth" || layer == "depth.Z";
    ImageDifference result;
    result.pixels = size_t(a.width) * size_t(a.height);
    double sum = 0, sum_of_squares = 0;
    for (size_t p = 0; p < result.pixels; ++p) {
        double difference = 0;
        bool is_one_only = false;
        for (const ChannelPair& pair : pairs) {
            const float va = a.pixels[p * a.channels.size() + pair.a];
            const float vb = b.pixels[p * b.channels.size() + pair.b];
            is_one_only |= std::isfinite(va) != std::isfinite(vb);
            if (std::isfinite(va) && std::isfinite(vb))
                difference = std::max(difference, compute_difference(va, vb, is_relative));
        }
        result.one_only += is_one_only;
        result.over_threshold += is_one_only || difference > threshold;
        if (is_one_only) continue;
        result.max = std::max(result.max, difference);
        sum += difference;
        sum_of_squares += difference * difference;
    }
    const size_t compared = result.pixels - result.one_only;
    if (compared > 0)
        result.mean = sum / double(compared), result.rms = std::sqrt(sum_of_squares / double(compared));
    return result;
}

} // namespace relief
