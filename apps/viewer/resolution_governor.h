// Chooses the size of pictures while the camera moves, so that they come fast enough.
#pragma once

#include <utility>

namespace relief::viewer {

class ResolutionGovernor {
  public:
    struct Config {
        double target_s = 0.042;     ///< of a picture, seconds: 20 a second with some room for showing it
        double least_scale = 0.0625; ///< of width and height, (0, 1]
        double first_scale = 0.25;   ///< before any picture was timed
    };

    ResolutionGovernor() : ResolutionGovernor(Config()) {}
    explicit ResolutionGovernor(const Config& config) : config_(config), scale_(config.first_scale) {}

    /// Width and height of the next picture of a whole size, at least one pixel.
    std::pair<int, int> choose_size(int width, int height) const;

    /// A picture of the last size took so many seconds.
    void learn(double seconds);

    double scale() const { return scale_; }

  private:
    Config config_;
    double scale_;
};

} // namespace relief::viewer
