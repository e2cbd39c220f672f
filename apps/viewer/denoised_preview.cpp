#include "viewer/denoised_preview.h"

#include <chrono>
#include <exception>
#include <utility>

#include "common/denoiser_search.h"

namespace relief::viewer {

namespace {

template <class Result> bool has_ended(const std::future<Result>& job) {
    return job.valid() && job.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

} // namespace

DenoisedPreview::~DenoisedPreview() { drop(); }

void DenoisedPreview::look() {
    if (std::exchange(has_looked_, true)) return;
    looking_ = std::async(std::launch::async, [on_news = on_news_] {
        bool is_there = true;
        try {
            cli::load_denoiser(1);
        } catch (const std::exception&) {
            is_there = false;
        }
        if (on_news) on_news();
        return is_there;
    });
}

void DenoisedPreview::load(int threads) {
    if (denoiser_) return;
    denoiser_ = std::make_shared<const Denoiser>(cli::load_denoiser(threads));
    has_looked_ = is_there_ = true;
}

void DenoisedPreview::show(std::shared_ptr<const ShownPicture> picture) {
    wanted_ = std::move(picture);
    start();
}

void DenoisedPreview::drop() {
    wanted_.reset();
    is_stale_ = true;
}

void DenoisedPreview::start() {
    if (!wanted_ || !denoiser_ || working_.valid()) return;
    is_stale_ = false;
    working_ = std::async(std::launch::async,
                          [this, noisy = std::exchange(wanted_, nullptr),
                           denoiser = denoiser_]() -> std::shared_ptr<const ShownPicture> {
                              auto picture = std::make_shared<ShownPicture>(*noisy);
                              std::exception_ptr failure;
                              bool is_whole = false;
                              try {
                                  is_whole =
                                      denoiser->denoise(picture->image, [this] { return is_stale_.load(); });
                              } catch (...) {
                                  failure = std::current_exception();
                              }
                              if (on_news_) on_news_();
                              if (failure) std::rethrow_exception(failure);
                              return is_whole ? picture : nullptr;
                          });
}

std::shared_ptr<const ShownPicture> DenoisedPreview::poll() {
    if (has_ended(looking_)) is_there_ |= looking_.get();
    std::shared_ptr<const ShownPicture> denoised;
    if (has_ended(working_)) denoised = working_.get();
    start();
    return denoised;
}

} // namespace relief::viewer
