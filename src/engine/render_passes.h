// What both engines do around the tracing of samples: passes, progress, cancellation, time limits,
// checkpoints and pictures so far.
#pragma once

#include <atomic>
#include <mutex>
#include <span>

#include "base/timer.h"
#include "engine/engine.h"
#include "engine/sample_plan.h"

namespace relief {

/// Follows one render. Thread safe, apart from what render_passes() calls.
class PassMonitor {
  public:
    PassMonitor(const RenderControl& control, const ImageSettings& image);

    bool is_cancelled() const { return control_.observer && control_.observer->is_cancelled(); }
    /// Whether tracing is to end before the next task, or within one where that is possible.
    bool must_stop() const { return is_cancelled() || is_out_of_time() || must_save() || must_show(); }
    bool is_out_of_time() const { return has_first_pass_ && left_s() <= 0; }
    /// Until the time limit; infinity: there is none.
    double left_s() const { return time_limit_s_ - timer_.seconds(); }
    /// A task is done: so many samples and rays. Reports progress now and then.
    void finish_task(uint64_t pixel_samples, uint64_t rays);

    /// The film has so many samples of each pixel already.
    void start(int samples_a_pixel);
    void start_step();
    /// Of the samples that are to be traced for a picture, `fraction` of `pixel_samples` are there.
    void start_tasks(double fraction, uint64_t pixel_samples);
    void finish_step(int samples_a_pixel);
    /// Saves and shows what is due. Never twice without a task between.
    void interrupt();
    double seconds() const { return timer_.seconds(); }
    /// Of the current step.
    double step_seconds() const { return step_timer_.seconds(); }
    uint64_t step_pixel_samples() const { return step_done_; }

  private:
    void report();
    bool must_save() const {
        return control_.save.call && is_unsaved_ && save_timer_.seconds() >= control_.save.interval_s;
    }
    bool must_show() const {
        const bool is_whole = !is_in_step_ || step_timer_.seconds() >= kLongStep;
        return control_.show.call && has_first_pass_ && is_unseen_ && is_whole &&
               (!has_shown_ || show_timer_.seconds() >= control_.show.interval_s);
    }

    /// Seconds from which on pictures of a step that is not whole are shown.
    static constexpr double kLongStep = 2;

    const RenderControl& control_;
    double time_limit_s_; ///< for this render; infinity: none
    bool has_first_pass_ = false, has_shown_ = false, is_in_step_ = false;
    std::atomic<bool> is_unsaved_{false}, is_unseen_{false}; ///< samples since the last call
    std::atomic<uint64_t> done_{0}, step_done_{0}, rays_{0}; ///< pixel samples: of a list of tasks, of a step
    double fraction_ = 0, share_of_sample_ = 0;
    std::mutex mutex_;
    Progress progress_;
    Timer timer_, step_timer_, save_timer_, show_timer_;
};

/// The part of an engine that traces.
class PassTracer {
  public:
    virtual ~PassTracer() = default;
    /// No ray is being traced: before each step of a pass.
    virtual void start_step() {}
    /// See PassPace::Config.
    virtual bool keeps_bits() const = 0;
    /// Traces tasks until all are done or monitor.must_stop(). All pixels of a block of SamplePlan then have
    /// the same number of samples.
    virtual void trace(Film& film, std::span<const SampleTask> tasks, PassMonitor& monitor) = 0;
};

struct PassReport {
    bool is_complete = true;  ///< false: cancelled
    double first_image_s = 0; ///< until each pixel had a sample that lacked one; 0: cancelled before
};

/// Adds to a film what it lacks, pass by pass, in tasks of at most `task_edge` pixels a side. `image` is that
/// of the render.
PassReport render_passes(Film& film, const ImageSettings& image, const RenderControl& control, int task_edge,
                         PassTracer& tracer);

} // namespace relief
