// How many samples a pixel the next step of a pass adds. A step is traced whole; it adds few samples where a
// time limit is near or somebody waits for a picture, so that no step is left half done.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>

namespace relief {

/// What the current pass lacks.
struct PassRest {
    int begin = 0, end = 1;           ///< samples of the pixels that have least, and at the end of the pass
    uint64_t pixels = 0;              ///< that lack samples in this pass
    uint64_t pixel_samples_ahead = 0; ///< of all pixels, up to the last pass
};

class PassPace {
  public:
    struct Config {
        /// Seconds that a step should last at most, because somebody waits for its end.
        double longest_step_s = std::numeric_limits<double>::infinity();
        /// Whether pictures keep their bits wherever a pass is cut into steps. If not, passes are cut only
        /// when the time limit comes before the end of the render.
        bool keeps_bits = true;
    };

    explicit PassPace(const Config& config) : config_(config) {}

    /// A step has ended, which added so many samples of pixels. Pixels had none before the first one.
    void learn(uint64_t pixel_samples, double seconds, bool is_first);

    /// Samples a pixel of the next step, at least 1 and at most those that the pass lacks; nothing where not
    /// even one sample of each pixel is expected to end in time. `left_s`: until the time limit; infinity:
    /// there is none. A pass from 0 samples begins in any case.
    std::optional<int> choose_count(const PassRest& rest, double left_s) const;

  private:
    int choose_watched_count(const PassRest& rest, double sample_s) const;

    Config config_;
    double rate_s_ = 0; ///< seconds of a sample of a pixel in the last step; 0: not known
    bool is_first_rate_ = false;
};

} // namespace relief
