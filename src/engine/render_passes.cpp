#include "engine/render_passes.h"

#include <algorithm>

namespace relief {

namespace {

constexpr double kReportInterval = 0.1; ///< seconds between two reports of progress

} // namespace

PassMonitor::PassMonitor(const RenderControl& control, const ImageSettings& image)
    : control_(control), time_limit_s_(image.time_limit_s) {
    progress_.samples_total = image.spp;
}

bool PassMonitor::is_out_of_time() const {
    return time_limit_s_ > 0 && has_first_pass_ && timer_.seconds() >= time_limit_s_;
}

void PassMonitor::start(int samples_a_pixel) {
    if (samples_a_pixel > 0) finish_pass(samples_a_pixel);
}

void PassMonitor::start_pass(double fraction, uint64_t pixel_samples) {
    const std::lock_guard lock(mutex_);
    fraction_ = fraction, done_ = 0;
    share_of_sample_ = pixel_samples > 0 ? 1.0 / double(pixel_samples) : 0;
}

void PassMonitor::finish_task(uint64_t pixel_samples, uint64_t rays) {
    done_ += pixel_samples, rays_ += rays;
    is_unsaved_ = is_unseen_ = true;
    const std::unique_lock lock(mutex_, std::try_to_lock);
    if (lock && timer_.seconds() - progress_.elapsed_s >= kReportInterval) report();
}

void PassMonitor::finish_pass(int samples_a_pixel) {
    const std::lock_guard lock(mutex_);
    has_first_pass_ = true;
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

PassReport render_passes(Film& film, const ImageSettings& image, const RenderControl& control, int task_edge,
                         PassTracer& tracer) {
    SamplePlan plan(film, image);
    PassMonitor monitor(control, image);
    PassReport report;
    const uint64_t all = uint64_t(film.window().x1 - film.window().x0) *
                         uint64_t(film.window().y1 - film.window().y0) * uint64_t(image.spp);
    monitor.start(int(film.least_samples()));
    while (plan.start_pass()) {
        if (monitor.is_cancelled()) return report.is_complete = false, report;
        tracer.start_pass();
        for (std::vector<SampleTask> tasks = plan.list_tasks(task_edge); !tasks.empty();
             tasks = plan.list_tasks(task_edge)) {
            monitor.start_pass(plan.fraction(), all);
            tracer.trace(film, tasks, monitor);
            if (monitor.is_cancelled()) {
                report.is_complete = plan.list_tasks(task_edge).empty() && plan.target() == image.spp;
                return report;
            }
            if (monitor.is_out_of_time()) return report;
            monitor.interrupt();
        }
        if (report.first_image_s == 0) report.first_image_s = monitor.seconds();
        monitor.finish_pass(plan.target());
        monitor.interrupt();
    }
    return report;
}

} // namespace relief
