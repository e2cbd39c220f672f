// The layers of a picture that say which surface lies under each pixel.
#pragma once

#include <cmath>
#include <cstddef>

#include "relief/image.h"
#include "relief/types.h"

namespace relief::viewer {

class PictureLayers {
  public:
    explicit PictureLayers(const Image& image)
        : image_(image),
          depth_(find("depth.Z")),
          normal_(find("N.X")),
          position_(find("P.X")),
          uv_(find("uv.X")),
          id_(find("id.I")) {}

    /// Whether all of them are there, which everything below needs.
    bool is_complete() const { return is_complete_; }
    bool is_inside(int x, int y) const { return x >= 0 && y >= 0 && x < image_.width && y < image_.height; }
    bool has_surface(int x, int y) const { return is_inside(x, y) && std::isfinite(at(x, y, depth_)); }
    float id(int x, int y) const { return at(x, y, id_); }
    Vec3f position(int x, int y) const { return vector(x, y, position_); }
    Vec3f normal(int x, int y) const { return vector(x, y, normal_); }
    Vec2f uv(int x, int y) const { return {at(x, y, uv_), at(x, y, uv_ + 1)}; }

  private:
    size_t find(const char* name) {
        const auto channel = image_.find_channel(name);
        is_complete_ &= channel.has_value();
        return channel.value_or(0);
    }
    float at(int x, int y, size_t channel) const {
        return image_
            .pixels[(size_t(y) * size_t(image_.width) + size_t(x)) * image_.channels.size() + channel];
    }
    Vec3f vector(int x, int y, size_t channel) const {
        return {at(x, y, channel), at(x, y, channel + 1), at(x, y, channel + 2)};
    }

    const Image& image_;
    bool is_complete_ = true;
    size_t depth_, normal_, position_, uv_, id_;
};

} // namespace relief::viewer
