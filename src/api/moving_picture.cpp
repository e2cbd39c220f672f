#include "api/moving_picture.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "base/timer.h"
#include "engine/sample_plan.h"

namespace relief {

namespace {

/// Tells of one sample as of a part of the picture.
class SampleObserver : public RenderObserver {
  public:
    SampleObserver(RenderObserver& whole, int samples_total) : whole_(whole) {
        progress_.samples_total = samples_total;
    }

    void start_sample(int sample) { progress_.samples_done = sample, rays_before_ = progress_.rays; }
    void on_progress(const Progress& part) override {
        const double total = double(progress_.samples_total);
        const double fraction = (double(progress_.samples_done) + part.fraction) / total;
        progress_.fraction = std::max(progress_.fraction, std::min(fraction, 1.0));
        progress_.rays = rays_before_ + part.rays;
        progress_.elapsed_s = timer_.seconds();
        Progress told = progress_;
        told.samples_done += part.fraction >= 1;
        whole_.on_progress(told);
    }
    bool is_cancelled() const override { return whole_.is_cancelled(); }

  private:
    RenderObserver& whole_;
    Progress progress_;
    uint64_t rays_before_ = 0; ///< of earlier samples
    Timer timer_;
};

/// Calls what is due between two samples.
class Pauses {
  public:
    explicit Pauses(const RenderControl& control) : control_(control) {}
    void call() {
        if (control_.save.call && save_timer_.seconds() >= control_.save.interval_s)
            control_.save.call(), save_timer_ = {};
        if (control_.show.call && (!has_shown_ || show_timer_.seconds() >= control_.show.interval_s))
            control_.show.call(), show_timer_ = {}, has_shown_ = true;
    }

  private:
    const RenderControl& control_;
    Timer save_timer_, show_timer_;
    bool has_shown_ = false;
};

/// Of the picture up to a sample.
ImageSettings end_with(const ImageSettings& image, int sample) {
    ImageSettings part = image;
    part.spp = sample + 1, part.time_limit_s = 0;
    return part;
}

/// The first sample that some pixel is to have and lacks; image.spp: none. Where noise asks for more samples
/// of a block that had enough before, it lacks earlier ones.
int find_first_lacking(Film& film, const ImageSettings& part) {
    int first = part.spp;
    SamplePlan plan(film, part);
    if (!plan.start_pass()) return first;
    for (const SampleTask& task : plan.list_tasks(SamplePlan::kBlockEdge))
        first = std::min(first, task.first);
    return first;
}

} // namespace

bool render_samples(Film& film, const ImageSettings& image, const RenderControl& control,
                    const MovingStage& stage) {
    const Timer timer;
    std::optional<SampleObserver> observer;
    if (control.observer) observer.emplace(*control.observer, image.spp);
    Pauses pauses(control);
    const double left_s = image.time_limit_s > 0
                              ? image.time_limit_s - image.time_reserved_s - control.spent_s
                              : std::numeric_limits<double>::infinity();
    double before_s = 0;
    for (int last = std::max(film.passes.target - 1, 0); last < image.spp; ++last) {
        for (int sample = find_first_lacking(film, end_with(image, last)); sample <= last; ++sample) {
            if (control.observer && control.observer->is_cancelled()) return false;
            // Which blocks take part was chosen above, for all that they lack.
            ImageSettings part = end_with(image, sample);
            part.noise = 0;
            stage.move(image.first_sample + sample, part);
            if (observer) observer->start_sample(sample);
            if (!stage.render(film, RenderControl(observer ? &*observer : nullptr))) return false;
            pauses.call();
            // The next sample takes about as long as this one.
            const double now_s = timer.seconds(), sample_s = now_s - std::exchange(before_s, now_s);
            if (left_s - now_s < sample_s) return true;
        }
    }
    return true;
}

} // namespace relief
