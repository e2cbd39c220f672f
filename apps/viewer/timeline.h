// The frames of a scene in their order, and which of them is due while they play.
#pragma once

#include <vector>

namespace relief::viewer {

class Timeline {
  public:
    static constexpr double kUsualFps = 24; ///< of files that say none

    Timeline() = default;
    /// `frames`: those that the scene file names, in any order; may be empty.
    Timeline(std::vector<int> frames, double fps);

    /// Rising.
    const std::vector<int>& frames() const { return frames_; }
    double fps() const { return fps_; }
    /// There is something to slide over and to play.
    bool has_range() const { return frames_.size() > 1; }

    /// The frame named nearest; the same one where none is named.
    int snap(int frame) const;
    /// The next frame named in this direction, +1 or -1; at the ends the last one. Of no range: the number.
    int step(int frame, int direction) const;

    /// Plays from a frame on; of no range nothing. `now`: seconds of any clock that goes on.
    void play(double now, int frame);
    void pause() { is_playing_ = false; }
    bool is_playing() const { return is_playing_; }
    /// The frame that is due, from the first one again after the last.
    int find_frame(double now) const;

  private:
    std::vector<int> frames_;
    double fps_ = kUsualFps;
    bool is_playing_ = false;
    double start_time_ = 0;
    int start_ = 1;
};

} // namespace relief::viewer
