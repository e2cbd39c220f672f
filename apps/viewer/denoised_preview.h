// Pictures without noise while they refine, by Open Image Denoise, in a thread of its own.
#pragma once

#include <atomic>
#include <functional>
#include <future>
#include <memory>

#include "relief/denoise.h"
#include "viewer/render_loop.h"

namespace relief::viewer {

/// All functions are called by one thread, and none but load() and the destructor waits.
class DenoisedPreview {
  public:
    /// `on_news` is called by the thread that denoises when poll() has something to do.
    explicit DenoisedPreview(std::function<void()> on_news) : on_news_(std::move(on_news)) {}
    /// Cancels what is being denoised, and waits for that.
    ~DenoisedPreview();

    /// Looks for the library, in a thread; is_there() says what came of it.
    void look();
    bool is_there() const { return is_there_; }
    /// Loads it, where that was not done yet. Throws as load_denoiser.
    void load(int threads);

    /// The picture to denoise next, with the layers of kDenoiserLayers; it replaces one that waits.
    void show(std::shared_ptr<const ShownPicture> picture);
    /// Nothing is wanted any more.
    void drop();
    /// The last picture that was denoised, if there is one since the last call; starts the next. Throws what
    /// denoising threw.
    std::shared_ptr<const ShownPicture> poll();

  private:
    void start();

    std::function<void()> on_news_;
    std::shared_ptr<const Denoiser> denoiser_;
    std::shared_ptr<const ShownPicture> wanted_;
    std::atomic<bool> is_stale_{false};
    bool has_looked_ = false, is_there_ = false;
    std::future<bool> looking_;
    std::future<std::shared_ptr<const ShownPicture>> working_; ///< null where it was cancelled
};

} // namespace relief::viewer
