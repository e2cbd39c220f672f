#include "viewer/picture_view.h"
#include "common/vectors.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace relief::viewer {

using namespace vectors;

namespace {

/// Reads one layer of a picture, pixel by pixel.
class LayerPixels {
  public:
    LayerPixels(const Image& image, const char* first_channel)
        : image_(image), channel_(image.find_channel(first_channel)) {}

    bool is_there() const { return channel_.has_value(); }
    float value(size_t pixel, size_t offset = 0) const {
        return image_.pixels[pixel * image_.channels.size() + *channel_ + offset];
    }
    /// Least and greatest of the finite values; 0 and 1 where there are none.
    std::pair<float, float> find_range() const {
        float least = std::numeric_limits<float>::infinity(), most = -least;
        for (size_t pixel = 0; pixel * image_.channels.size() < image_.pixels.size(); ++pixel)
            if (const float v = value(pixel); std::isfinite(v))
                least = std::min(least, v), most = std::max(most, v);
        return least <= most ? std::pair(least, most) : std::pair(0.0f, 1.0f);
    }

  private:
    const Image& image_;
    std::optional<size_t> channel_;
};

template <class Pixel> std::vector<uint8_t> make_bytes(const Image& image, const Pixel& pixel) {
    const size_t count = size_t(image.width) * size_t(image.height);
    std::vector<uint8_t> bytes(4 * count, 255);
    for (size_t k = 0; k < count; ++k) pixel(k, bytes.data() + 4 * k);
    return bytes;
}

void write_bytes(const Vec3f& color, uint8_t* bytes) {
    bytes[0] = round_to_byte(color.x), bytes[1] = round_to_byte(color.y), bytes[2] = round_to_byte(color.z);
}

/// Colours far apart for numbers next to each other.
Vec3f make_object_color(float id) {
    const float turn = id * 0.618034f;
    const auto wave = [&](float shift) {
        const float t = turn + shift;
        return 0.55f + 0.4f * std::cos(6.2831853f * (t - std::floor(t)));
    };
    return {wave(0), wave(1.0f / 3), wave(2.0f / 3)};
}

/// Blue, green, yellow, red.
Vec3f make_heat(float share) {
    const auto ramp = [&](float from, float to) {
        return std::clamp((share - from) / (to - from), 0.0f, 1.0f);
    };
    return {ramp(0.4f, 0.7f), ramp(0, 0.35f) * (1 - ramp(0.7f, 1)), 1 - ramp(0.2f, 0.5f)};
}

std::vector<uint8_t> show_color(const Image& image, float exposure, const DisplayTable& display) {
    const LayerPixels color(image, "R");
    const float gain = std::exp2(exposure);
    return make_bytes(image, [&](size_t k, uint8_t* bytes) {
        display.show(Vec3f{color.value(k, 0), color.value(k, 1), color.value(k, 2)} * gain, bytes);
    });
}

std::vector<uint8_t> show_depth(const Image& image, const LayerPixels& depth) {
    const auto [least, most] = depth.find_range();
    const float nearest = least, reach = std::max(most - least, 1e-6f * most);
    return make_bytes(image, [&](size_t k, uint8_t* bytes) {
        const float z = depth.value(k);
        const float grey = std::isfinite(z) ? 1 - 0.85f * (z - nearest) / reach : 0.0f;
        write_bytes({grey, grey, grey}, bytes);
    });
}

std::vector<uint8_t> show_heat(const Image& image, const LayerPixels& layer) {
    const auto [least, most] = layer.find_range();
    const float from = least, reach = std::max(most - least, 1e-20f);
    return make_bytes(image, [&](size_t k, uint8_t* bytes) {
        write_bytes(make_heat((layer.value(k) - from) / reach), bytes);
    });
}

} // namespace

std::vector<uint8_t> make_view(const Image& image, const ViewSettings& settings,
                               const DisplayTable& display) {
    constexpr const char* kFirst[] = {"R", "N.X", "depth.Z", "uv.X", "id.I", "cost.Y", "samples.Y"};
    const LayerPixels layer(image, kFirst[size_t(settings.view)]);
    const LayerPixels depth(image, "depth.Z");
    const auto has_surface = [&](size_t k) { return depth.is_there() && std::isfinite(depth.value(k)); };
    if (!layer.is_there()) return make_bytes(image, [](size_t, uint8_t* bytes) { write_bytes({}, bytes); });
    switch (settings.view) {
    case View::color:
        return show_color(image, settings.exposure, display);
    case View::depth:
        return show_depth(image, layer);
    case View::cost:
    case View::samples:
        return show_heat(image, layer);
    case View::normal:
        return make_bytes(image, [&](size_t k, uint8_t* bytes) {
            const Vec3f n{layer.value(k, 0), layer.value(k, 1), layer.value(k, 2)};
            write_bytes(has_surface(k) ? n * 0.5f + Vec3f{0.5f, 0.5f, 0.5f} : Vec3f{}, bytes);
        });
    case View::uv:
        return make_bytes(image, [&](size_t k, uint8_t* bytes) {
            write_bytes(has_surface(k) ? Vec3f{layer.value(k, 0), layer.value(k, 1), 0} : Vec3f{}, bytes);
        });
    case View::object:
        break;
    }
    return make_bytes(image, [&](size_t k, uint8_t* bytes) {
        write_bytes(has_surface(k) ? make_object_color(layer.value(k)) : Vec3f{}, bytes);
    });
}

} // namespace relief::viewer
