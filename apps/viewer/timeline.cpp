#include "viewer/timeline.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "relief/shot.h"

namespace relief::viewer {

Timeline::Timeline(std::vector<int> frames, double fps)
    : frames_(std::move(frames)), fps_(fps > 0 ? fps : kUsualFps) {
    std::ranges::sort(frames_);
}

int Timeline::snap(int frame) const {
    if (frames_.empty()) return frame;
    return *std::ranges::min_element(frames_, {}, [&](int listed) { return std::abs(listed - frame); });
}

int Timeline::step(int frame, int direction) const {
    if (!has_range()) return std::clamp(frame + direction, -kMaxFrame, kMaxFrame);
    if (direction > 0) {
        const auto next = std::ranges::upper_bound(frames_, frame);
        return next == frames_.end() ? frames_.back() : *next;
    }
    const auto here = std::ranges::lower_bound(frames_, frame);
    return here == frames_.begin() ? frames_.front() : *(here - 1);
}

void Timeline::play(double now, int frame) {
    if (!has_range()) return;
    is_playing_ = true;
    start_time_ = now;
    start_ = std::clamp(frame, frames_.front(), frames_.back());
}

int Timeline::find_frame(double now) const {
    if (frames_.empty()) return start_;
    const double length = double(frames_.back()) - frames_.front() + 1;
    const double way = start_ - frames_.front() + std::floor(std::max(now - start_time_, 0.0) * fps_);
    const int due = frames_.front() + int(std::fmod(way, length));
    return *(std::ranges::upper_bound(frames_, due) - 1);
}

} // namespace relief::viewer
