// A tracer sized to the device's memory: a smaller ray capacity is slower, but does not change results.
#pragma once

#include <functional>
#include <memory>
#include <utility>

#include "relief/error.h"
#include "vulkan/tracer.h"
#include "vulkan/work_statistics.h"

namespace relief::vulkan {

/// Ray capacity: preferred, and the minimum that is still useful.
struct RayPlaces {
    uint32_t wished, least;
};

/// A tracer and the worker that feeds it. Not thread safe.
template <class Worker> class SizedTracer {
  public:
    using MakeTracer = std::function<std::unique_ptr<Tracer>(uint32_t rays)>;
    using MakeWorker = std::function<std::unique_ptr<Worker>(Tracer&)>;

    SizedTracer() = default;
    /// Halves the capacity until tracer and worker fit. Throws Error{out_of_memory} if the minimum does not.
    SizedTracer(RayPlaces places, MakeTracer make_tracer, MakeWorker make_worker)
        : least_(places.least), make_tracer_(std::move(make_tracer)), make_worker_(std::move(make_worker)) {
        make(places.wished);
    }

    /// False when default constructed, and after run() has thrown for lack of memory.
    explicit operator bool() const { return worker_ != nullptr; }

    /// Runs work(Worker&). Out of memory: retries with new ones, at half the capacity if none succeeded.
    template <class Work> void run(const Work& work) {
        for (;;) {
            try {
                work(*worker_);
                is_proven_ = true;
                return;
            } catch (const Error& error) {
                if (error.kind() != ErrorKind::out_of_memory) throw;
                const uint32_t rays = is_proven_ ? rays_ : rays_ / 2;
                retire();
                if (rays < least_) throw;
                make(rays);
            }
        }
    }

    /// Adds the statistics of all tracers and workers so far.
    void add_statistics(Statistics& statistics) const {
        Statistics current;
        if (tracer_) tracer_->add_statistics(current);
        if constexpr (requires { worker_->add_statistics(current); })
            if (worker_) worker_->add_statistics(current);
        add_work(statistics, retired_);
        add_work(statistics, current);
    }

  private:
    void retire() {
        Statistics sum;
        add_statistics(sum);
        retired_ = std::move(sum);
        worker_.reset();
        tracer_.reset();
    }

    void make(uint32_t rays) {
        for (is_proven_ = false;; rays /= 2) {
            try {
                tracer_ = make_tracer_(rays);
                worker_ = make_worker_(*tracer_);
                rays_ = rays;
                return;
            } catch (const Error& error) {
                tracer_.reset();
                if (error.kind() != ErrorKind::out_of_memory || rays / 2 < least_) throw;
            }
        }
    }

    uint32_t rays_ = 0, least_ = 0;
    bool is_proven_ = false; ///< some work has succeeded at this capacity
    MakeTracer make_tracer_;
    MakeWorker make_worker_;
    std::unique_ptr<Tracer> tracer_;
    std::unique_ptr<Worker> worker_;
    Statistics retired_; ///< statistics of discarded tracers and workers
};

} // namespace relief::vulkan
