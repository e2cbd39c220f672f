#include "viewer/render_loop.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <iterator>
#include <limits>
#include <tuple>
#include <utility>

#include "relief/error.h"

namespace relief::viewer {

namespace {

/// Seconds between two looks at a picture that refines.
constexpr double kPictureInterval = 0.25;

double read_clock() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

bool are_same(const Camera& a, const Camera& b) {
    return a.from == b.from && a.to == b.to && a.up == b.up && a.fov_degrees == b.fov_degrees &&
           a.aperture_radius == b.aperture_radius && a.focus_distance == b.focus_distance &&
           a.shift == b.shift;
}

/// Of all that changes between pictures of a viewer.
bool are_same(const ImageSettings& a, const ImageSettings& b) {
    return a.width == b.width && a.height == b.height && a.spp == b.spp && a.bounces == b.bounces &&
           a.noise == b.noise && a.clamp_indirect == b.clamp_indirect && a.seed == b.seed &&
           a.background == b.background;
}

/// Whether one session can render both: it keeps its engine, surfaces and layers.
bool share_session(const RenderSettings& a, const RenderSettings& b) {
    return a.device.engine == b.device.engine && a.device.index == b.device.index &&
           a.device.threads == b.device.threads && a.surface.level == b.surface.level &&
           a.surface.pixel_error == b.surface.pixel_error && a.image.layers == b.image.layers;
}

ImageSettings make_single_sample(ImageSettings image) {
    image.spp = 1;
    image.noise = 0;
    return image;
}

/// Of pictures under a brush: what remains of 100 ms for the stroke itself.
constexpr ResolutionGovernor::Config kPainting{.target_s = 0.06, .least_scale = 0.125, .first_scale = 0.5};

} // namespace

/// Passes pictures on, and tells the render when nobody waits for it any more.
class RenderLoop::Observer : public RenderObserver {
  public:
    Observer(RenderLoop& loop, const Work& work, Motion motion)
        : loop_(loop), work_(work), motion_(motion), start_(read_clock()) {}

    void on_progress(const Progress& progress) override {
        const std::lock_guard lock(mutex_);
        progress_ = progress;
    }
    bool is_cancelled() const override { return loop_.is_stale_.load(std::memory_order_relaxed); }
    double picture_interval_s() const override {
        return motion_ == Motion::still ? kPictureInterval : std::numeric_limits<double>::infinity();
    }
    void on_picture(Image picture) override { loop_.publish(std::move(picture), *this, false); }

    const Work& work() const { return work_; }
    Motion motion() const { return motion_; }
    double seconds() const { return read_clock() - start_; }
    Progress progress() const {
        const std::lock_guard lock(mutex_);
        return progress_;
    }

  private:
    RenderLoop& loop_;
    const Work& work_;
    Motion motion_;
    double start_;
    mutable std::mutex mutex_;
    Progress progress_;
};

RenderLoop::RenderLoop(std::function<void()> on_news)
    : on_news_(std::move(on_news)), painting_governor_(kPainting), thread_([this] { run(); }) {}

RenderLoop::~RenderLoop() {
    {
        const std::lock_guard lock(mutex_);
        must_end_ = true;
        is_stale_ = true;
    }
    has_work_.notify_all();
    thread_.join();
}

/// A picture of a moving camera is soon done, and if the next one ended it there would be none.
bool RenderLoop::may_cancel(const RenderRequest& next) const {
    return rendered_motion_ && (*rendered_motion_ == Motion::still || next.scene_version != rendered_scene_);
}

uint64_t RenderLoop::show(const RenderRequest& request, std::vector<MapEdit> edits) {
    uint64_t version = 0;
    {
        const std::lock_guard lock(mutex_);
        if (request.scene_version != wanted_.scene_version) edits_.clear();
        wanted_ = request;
        std::move(edits.begin(), edits.end(), std::back_inserter(edits_));
        version = ++version_;
        if (may_cancel(request)) is_stale_ = true;
    }
    has_work_.notify_all();
    return version;
}

std::shared_ptr<const ShownPicture> RenderLoop::take_picture() {
    const std::lock_guard lock(mutex_);
    return std::exchange(picture_, nullptr);
}

RenderState RenderLoop::state() const {
    const std::lock_guard lock(mutex_);
    return state_;
}

void RenderLoop::tell() {
    if (on_news_) on_news_();
}

std::optional<RenderLoop::Work> RenderLoop::await_work() {
    std::unique_lock lock(mutex_);
    rendered_motion_.reset();
    const bool was_busy = std::exchange(state_.is_busy, false);
    const auto is_due = [&] { return must_end_ || (version_ != started_version_ && wanted_.scene); };
    if (was_busy && !is_due()) {
        lock.unlock();
        tell();
        lock.lock();
    }
    has_work_.wait(lock, is_due);
    if (must_end_) return std::nullopt;
    is_stale_ = false;
    started_version_ = version_;
    rendered_motion_ = wanted_.motion;
    rendered_scene_ = wanted_.scene_version;
    state_.is_busy = true;
    return Work{wanted_, std::exchange(edits_, {}), version_};
}

void RenderLoop::run() {
    while (const std::optional<Work> work = await_work()) {
        std::string error;
        try {
            render(*work);
        } catch (const std::exception& failure) {
            error = failure.what();
            session_.reset(); // whatever state it was left in
        }
        {
            const std::lock_guard lock(mutex_);
            state_.error = error;
        }
        tell();
    }
}

ImageSettings RenderLoop::make_first_image(const RenderRequest& request) const {
    ImageSettings image = make_single_sample(request.settings.image);
    std::tie(image.width, image.height) = governor_.choose_size(image.width, image.height);
    return image;
}

void RenderLoop::start_session(const RenderRequest& request) {
    session_.reset(); // so that there are not two
    RenderSettings settings = request.settings;
    settings.image = make_first_image(request);
    Scene scene = make_whole(*request.scene);
    scene.camera = request.camera;
    session_ = std::make_unique<Session>(std::move(scene), settings, request.use);
    session_use_ = request.use;
    session_shot_ = request.shot;
    session_settings_ = settings;
    has_shown_session_ = false;
}

/// Surfaces, maps and trees of what is the same stay as they are. False: the session cannot follow.
bool RenderLoop::change_scene(const RenderRequest& request) {
    SceneUpdate update;
    update.scene = make_next(*request.scene, session_meshes_);
    update.scene->camera = update.camera = request.camera;
    update.scene_hash = request.scene->scene.hash;
    const ImageSettings image = make_first_image(request);
    try {
        session_->change_scene(std::move(update), image);
    } catch (const Error&) { // a new one says what is wrong, if anything is
        return false;
    }
    session_settings_.image = image;
    return true;
}

void RenderLoop::prepare(const RenderRequest& request) {
    const bool is_usable = session_ && share_session(session_settings_, request.settings) &&
                           (request.use == session_use_ || request.use == SessionUse::views);
    if (is_usable && session_scene_ == request.scene_version) return;
    const bool is_next = is_usable && request.use == SessionUse::scenes && request.shot != 0 &&
                         request.shot == session_shot_ && !session_->is_far_away();
    if (!is_next || !change_scene(request)) start_session(request);
    session_scene_ = request.scene_version;
    session_meshes_ = request.scene->meshes;
    session_camera_ = request.camera;
    is_seen_ = false;
}

void RenderLoop::render(const Work& work) {
    const RenderRequest& request = work.request;
    prepare(request);
    is_seen_ &= work.edits.empty() && are_same(request.camera, seen_camera_);
    for (const MapEdit& edit : work.edits) session_->edit(edit);
    if (request.motion == Motion::painting) return render_painting(work);
    painting_size_ = {};
    if (request.motion == Motion::moving) return render_preview(work);
    // Also of a camera that came to rest before there was a picture of it.
    if (!is_seen_) render_preview(work);
    if (!is_stale_) render_pass(work, request.settings.image, request.motion);
}

/// Of direct light: what other surfaces reflect changes everywhere with each dab.
void RenderLoop::render_painting(const Work& work) {
    ImageSettings image = make_single_sample(work.request.settings.image);
    if (painting_size_.first == 0) painting_size_ = painting_governor_.choose_size(image.width, image.height);
    std::tie(image.width, image.height) = painting_size_;
    image.bounces = 0;
    const double start = read_clock();
    render_pass(work, image, Motion::painting);
    painting_governor_.learn(read_clock() - start);
}

void RenderLoop::render_preview(const Work& work) {
    ImageSettings image = make_single_sample(work.request.settings.image);
    std::tie(image.width, image.height) = governor_.choose_size(image.width, image.height);
    const double start = read_clock();
    render_pass(work, image, Motion::moving);
    // The first one of a session builds trees that later ones find.
    if (has_shown_session_) governor_.learn(read_clock() - start);
    has_shown_session_ = true;
    const std::lock_guard lock(mutex_);
    state_.picture_scale = governor_.scale();
}

void RenderLoop::render_pass(const Work& work, const ImageSettings& image, Motion motion) {
    Observer observer(*this, work, motion);
    if (!are_same(session_camera_, work.request.camera) || !are_same(session_settings_.image, image)) {
        session_->change_view(work.request.camera, image);
        session_camera_ = work.request.camera;
        session_settings_.image = image;
    }
    RenderResult result = session_->render(&observer);
    auto statistics = std::make_shared<const Statistics>(std::move(result.statistics));
    {
        const std::lock_guard lock(mutex_);
        state_.statistics = std::move(statistics);
    }
    if (!result.is_complete) return;
    publish(std::move(result.image), observer, motion == Motion::still);
}

void RenderLoop::publish(Image image, const Observer& observer, bool is_complete) {
    const Work& work = observer.work();
    const Progress progress = observer.progress();
    is_seen_ = true;
    seen_camera_ = work.request.camera;
    auto picture = std::make_shared<ShownPicture>();
    picture->image = std::move(image);
    picture->camera = work.request.camera;
    picture->full_width = work.request.settings.image.width;
    picture->full_height = work.request.settings.image.height;
    picture->version = work.version;
    picture->motion = observer.motion();
    picture->is_complete = is_complete;
    picture->samples = progress.samples_done;
    picture->seconds = observer.seconds();
    {
        const std::lock_guard lock(mutex_);
        ++state_.picture_count;
        state_.progress = progress;
        picture_ = std::move(picture);
    }
    tell();
}

} // namespace relief::viewer
