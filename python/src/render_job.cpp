#include "render_job.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <limits>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "exit_gate.h"
#include "pictures.h"

namespace nb = nanobind;

namespace relief::python {

namespace {

/// Between the thread that renders and the one that waits: the newest of each kind is kept.
class Mailbox final : public RenderObserver {
  public:
    struct News {
        std::optional<Progress> progress;
        std::optional<double> prepared;
        std::optional<Image> picture;
        bool is_done = false;
    };

    explicit Mailbox(const RenderCallbacks& callbacks)
        : picture_interval_s_(callbacks.on_picture.is_none() ? std::numeric_limits<double>::infinity()
                                                             : callbacks.picture_interval_s) {}

    void on_progress(const Progress& progress) override {
        const std::lock_guard lock(mutex_);
        news_.progress = progress;
        changed_.notify_all();
    }
    void on_preparation(double fraction) override {
        const std::lock_guard lock(mutex_);
        news_.prepared = fraction;
    }
    bool is_cancelled() const override { return is_cancelled_; }
    double picture_interval_s() const override { return picture_interval_s_; }
    void on_picture(Image picture) override {
        const std::lock_guard lock(mutex_);
        news_.picture = std::move(picture);
        changed_.notify_all();
    }

    void cancel() { is_cancelled_ = true; }
    void finish() {
        const std::lock_guard lock(mutex_);
        news_.is_done = true;
        changed_.notify_all();
    }
    /// What came since the last call; waits for some, but not for long.
    News take(std::chrono::milliseconds most) {
        std::unique_lock lock(mutex_);
        changed_.wait_for(lock, most, [&] { return news_.progress || news_.picture || news_.is_done; });
        const bool is_done = news_.is_done;
        News news = std::exchange(news_, {});
        news_.is_done = is_done;
        return news;
    }

  private:
    const double picture_interval_s_;
    std::atomic<bool> is_cancelled_{false};
    std::mutex mutex_;
    std::condition_variable changed_;
    News news_;
};

/// The thread that renders, and what came of it.
class Worker {
  public:
    Worker(const std::function<RenderResult(RenderObserver&)>& work, Mailbox& mailbox)
        : mailbox_(mailbox), thread_([this, &work] {
              try {
                  result_ = work(mailbox_);
              } catch (...) {
                  failure_ = std::current_exception();
              }
              mailbox_.finish();
          }) {}
    ~Worker() {
        if (!thread_.joinable()) return;
        mailbox_.cancel();
        const nb::gil_scoped_release release;
        thread_.join();
    }
    Worker(const Worker&) = delete;
    Worker& operator=(const Worker&) = delete;

    /// Waits for the end; null: `work` has returned.
    std::exception_ptr find_failure() {
        thread_.join();
        return failure_;
    }
    RenderResult take_result() { return std::move(result_); }

  private:
    Mailbox& mailbox_;
    RenderResult result_;
    std::exception_ptr failure_;
    std::thread thread_; // the last: it uses the others
};

nb::object take_exception(const nb::python_error& error) {
    nb::object value = nb::borrow(error.value());
    if (error.traceback().is_valid()) PyException_SetTraceback(value.ptr(), error.traceback().ptr());
    return value;
}

/// Runs callbacks and handlers of signals until the render is over.
class Waiter {
  public:
    Waiter(Mailbox& mailbox, const RenderCallbacks& callbacks) : mailbox_(mailbox), callbacks_(callbacks) {
        latest_.samples_total = callbacks.samples_total, latest_.prepared = 0;
    }

    void wait() {
        constexpr std::chrono::milliseconds kPatience(50);
        for (Mailbox::News news; !news.is_done;) {
            {
                const nb::gil_scoped_release release;
                news = mailbox_.take(kPatience);
            }
            if (is_gate_closing()) mailbox_.cancel();
            handle([&] { check_signals(); });
            if (failure_.is_valid() || interrupts_ > 0) continue;
            follow_progress(news);
            if (news.picture)
                call(callbacks_.on_picture, [&] { return make_picture(std::move(*news.picture)); });
        }
    }

    /// Null where nothing went wrong. `has_picture`: an interrupt alone is none then.
    nb::object find_failure(bool has_picture) const {
        if (failure_.is_valid()) return failure_;
        return interrupts_ > 0 && !has_picture ? interrupt_ : nb::none();
    }

  private:
    static constexpr int kLooksACall = 2; ///< of on_progress while there is nothing new

    /// Repeats the last report, so that a callback that wants to cancel need not wait long.
    void follow_progress(const Mailbox::News& news) {
        if (news.prepared && !has_begun_) latest_.prepared = *news.prepared, is_untold_ = true;
        if (news.progress || news.picture) has_begun_ = true, latest_.prepared = 1;
        if (news.progress) static_cast<Progress&>(latest_) = *news.progress;
        if (news.is_done ? !news.progress && !is_untold_ : !news.progress && ++looks_ % kLooksACall != 0)
            return;
        is_untold_ = false;
        call(callbacks_.on_progress, [&] { return nb::cast(latest_); });
    }

    template <class Body> void handle(const Body& body) {
        try {
            body();
        } catch (const nb::python_error& error) {
            mailbox_.cancel();
            const bool is_interrupt = error.matches(PyExc_KeyboardInterrupt);
            if (is_interrupt && interrupts_++ == 0)
                interrupt_ = take_exception(error);
            else if (!failure_.is_valid())
                failure_ = take_exception(error);
        }
    }
    static void check_signals() {
        if (PyErr_CheckSignals() != 0) throw nb::python_error();
    }
    template <class Make> void call(const nb::object& callback, const Make& make) {
        if (callback.is_none()) return;
        handle([&] {
            if (callback(make()).ptr() == Py_False) mailbox_.cancel();
        });
    }

    Mailbox& mailbox_;
    const RenderCallbacks& callbacks_;
    int interrupts_ = 0, looks_ = 0;
    bool has_begun_ = false;
    bool is_untold_ = false; ///< the preparation has gone on since the last call
    JobProgress latest_;
    nb::object interrupt_, failure_;
};

} // namespace

JobReport run_job(const std::function<RenderResult(RenderObserver&)>& work,
                  const RenderCallbacks& callbacks) {
    Mailbox mailbox(callbacks);
    Waiter waiter(mailbox, callbacks);
    Worker worker(work, mailbox);
    waiter.wait();
    const std::exception_ptr failure = worker.find_failure();
    JobReport report;
    report.result = worker.take_result();
    report.failure = waiter.find_failure(report.result.whole_samples > 0);
    if (failure && report.failure.is_none()) std::rethrow_exception(failure);
    return report;
}

void run_step(const std::function<void(RenderObserver&)>& work, const nb::object& on_progress,
              int samples_total) {
    const auto run = [&](RenderObserver& observer) {
        work(observer);
        return RenderResult();
    };
    const JobReport report = run_job(run, {on_progress, nb::none(), 0.5, samples_total});
    if (report.failure.is_none()) return;
    PyErr_SetObject(reinterpret_cast<PyObject*>(Py_TYPE(report.failure.ptr())), report.failure.ptr());
    throw nb::python_error();
}

} // namespace relief::python
