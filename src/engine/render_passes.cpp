#include "engine/render_passes.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <vector>

#include "engine/pass_pace.h"
#include "engine/picture_windows.h"

namespace relief {

namespace {

constexpr double kReportInterval = 0.1; ///< seconds between two reports of progress
constexpr double kShownStep = 1;        ///< seconds of a step at most, where pictures are shown more often

} // namespace

PassMonitor::PassMonitor(const RenderControl& control, const ImageSettings& image)
    : control_(control),
      time_limit_s_(image.time_limit_s > 0 ? image.time_limit_s - image.time_reserved_s - control.spent_s
                                           : std::numeric_limits<double>::infinity()) {
    progress_.samples_total = image.spp;
}

void PassMonitor::start(int samples_a_pixel) {
    if (samples_a_pixel > 0) finish_step(samples_a_pixel);
}

void PassMonitor::start_step() {
    is_in_step_ = true;
    step_done_ = 0, step_timer_ = {};
}

void PassMonitor::start_tasks(double fraction, uint64_t pixel_samples) {
    const std::lock_guard lock(mutex_);
    fraction_ = fraction, done_ = 0;
    share_of_sample_ = pixel_samples > 0 ? 1.0 / double(pixel_samples) : 0;
}

void PassMonitor::finish_task(uint64_t pixel_samples, uint64_t rays) {
    done_ += pixel_samples, step_done_ += pixel_samples, rays_ += rays;
    is_unsaved_ = is_unseen_ = true;
    const std::unique_lock lock(mutex_, std::try_to_lock);
    if (lock && timer_.seconds() - progress_.elapsed_s >= kReportInterval) report();
}

void PassMonitor::finish_step(int samples_a_pixel) {
    const std::lock_guard lock(mutex_);
    has_first_pass_ = true, is_in_step_ = false;
    progress_.samples_done = samples_a_pixel;
    report();
}

void PassMonitor::interrupt() {
    if (must_save()) {
        control_.save.call();
        is_unsaved_ = false;
        save_timer_ = {};
    }
    if (must_show()) {
        control_.show.call();
        is_unseen_ = false, has_shown_ = true;
        show_timer_ = {};
    }
}

void PassMonitor::report() {
    if (!control_.observer) return;
    progress_.elapsed_s = timer_.seconds();
    const double limit = time_limit_s_ > 0 ? progress_.elapsed_s / time_limit_s_ : 0;
    const double fraction = fraction_ + double(done_) * share_of_sample_;
    progress_.fraction = std::max(progress_.fraction, std::min(1.0, std::max(fraction, limit)));
    progress_.rays = rays_;
    control_.observer->on_progress(progress_);
}

namespace {

PassPace make_pace(const RenderControl& control, const PassTracer& tracer) {
    PassPace::Config config;
    config.keeps_bits = tracer.keeps_bits();
    if (control.show.call) config.longest_step_s = std::max(kShownStep, control.show.interval_s);
    return PassPace(config);
}

} // namespace

PassReport render_passes(Film& film, const ImageSettings& image, const RenderControl& control, int task_edge,
                         PassTracer& tracer) {
    SamplePlan plan(film, image);
    PassMonitor monitor(control, image);
    PassPace pace = make_pace(control, tracer);
    PassReport report;
    const uint64_t all = count_pixels(film.window()) * uint64_t(image.spp);
    monitor.start(int(film.least_samples()));
    while (plan.start_pass()) {
        if (monitor.is_cancelled()) return report.is_complete = false, report;
        const PassRest rest = plan.find_rest();
        const std::optional<int> count = pace.choose_count(rest, monitor.left_s());
        if (!count) return report;
        const int end = rest.begin + *count;
        tracer.start_step();
        monitor.start_step();
        for (std::vector<SampleTask> tasks = plan.list_tasks(task_edge, end); !tasks.empty();
             tasks = plan.list_tasks(task_edge, end)) {
            monitor.start_tasks(plan.fraction(), all);
            tracer.trace(film, tasks, monitor);
            if (monitor.is_cancelled()) {
                report.is_complete = plan.list_tasks(task_edge).empty() && plan.target() == image.spp;
                return report;
            }
            if (monitor.is_out_of_time()) return report;
            monitor.interrupt();
        }
        if (report.first_image_s == 0) report.first_image_s = monitor.seconds();
        pace.learn(monitor.step_pixel_samples(), monitor.step_seconds(), rest.begin == 0);
        monitor.finish_step(end);
        monitor.interrupt();
    }
    return report;
}

} // namespace relief
