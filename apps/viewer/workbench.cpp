#include "viewer/workbench.h"

#include <algorithm>
#include <exception>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "relief/aim.h"
#include "relief/error.h"
#include "viewer/surface_point.h"

namespace relief::viewer {

namespace {

/// Seconds without a change after which a picture gets all of its samples; longer while a button is held.
constexpr double kRest = 0.12, kHeldRest = 0.3, kPaintRest = 0.5;
/// Seconds between two looks at files.
constexpr double kWatchInterval = 0.2;
/// Seconds between two changes of the same thing that are taken back together.
constexpr double kChangeInterval = 1;
/// Messages that are kept.
constexpr size_t kMostMessages = 20;
/// Way that flying takes a second, in distances of the target.
constexpr float kFlySpeed = 0.8f;

} // namespace

Workbench::Workbench(const RenderSettings& settings, const PictureDefaults& given,
                     std::function<void()> on_news, const std::filesystem::path& state_folder)
    : settings_(settings),
      given_(given),
      on_news_(on_news),
      state_(state_folder),
      preview_(on_news),
      loop_(std::move(on_news)) {
    settings_.image.layers.assign(std::begin(kViewerLayers), std::end(kViewerLayers));
}

Workbench::~Workbench() {
    if (document_ && !is_discarded_) attempt([&] { state_.keep_now(*document_); });
}

bool Workbench::attempt(const std::function<void()>& body) {
    try {
        body();
        return true;
    } catch (const std::exception& error) {
        passing_message_ = message_ = error.what();
        has_news_ = true;
        return false;
    }
}

void Workbench::set_picture_size(int width, int height) {
    if (width == settings_.image.width && height == settings_.image.height) return;
    settings_.image.width = std::clamp(width, 1, kMaxPictureSize);
    settings_.image.height = std::clamp(height, 1, kMaxPictureSize);
    set_motion(Motion::moving);
}

void Workbench::set_motion(Motion motion) {
    motion_ = motion;
    last_motion_ = now_;
    needs_request_ = has_changed_ = true;
}

void Workbench::change_camera(const std::function<void(OrbitCamera&)>& change) {
    change(camera_);
    has_own_camera_ = true;
    if (document_) document_->set_camera(camera_.get());
    set_motion(Motion::moving);
}

void Workbench::frame_all() { frame(std::nullopt); }

void Workbench::frame_selected() { frame(selected_object_); }

void Workbench::select(std::optional<uint32_t> object) {
    selected_object_ = object;
    has_news_ = true;
}

void Workbench::frame(const std::optional<uint32_t>& object) {
    if (!document_) return;
    attempt([&] {
        Scene scene = document_->scene();
        if (object) scene.objects = {scene.objects.at(*object)};
        AimOptions aim;
        aim.frame_all = true;
        aim_scene(scene, aim, float(settings_.image.width) / float(settings_.image.height));
        change_camera([&](OrbitCamera& camera) { camera.set(scene.camera); });
    });
}

void Workbench::change_settings(const std::function<void(RenderSettings&)>& change) {
    end_message();
    change(settings_);
    needs_snapshot_ = true;
    set_motion(Motion::still);
}

void Workbench::change_document(const std::function<void(Document&)>& change) {
    if (!document_) return;
    end_message();
    const std::vector<std::string> doubts = document_->doubts();
    const bool is_doubt = std::ranges::find(doubts, message_) != doubts.end();
    if (attempt([&] { change(*document_); }) && is_doubt && document_->doubts() != doubts) message_.clear();
    set_motion(Motion::moving);
}

void Workbench::change_value(const std::function<std::optional<SceneValue>(Document&)>& change) {
    if (!document_ || !painter_) return;
    const bool is_new = now_ - last_change_ > kChangeInterval;
    last_change_ = now_;
    change_document([&](Document& document) {
        if (const std::optional<SceneValue> before = change(document)) painter_->note_value(*before, is_new);
    });
}

void Workbench::change_displacement(size_t index, const std::function<void(Displacement&)>& change) {
    change_value([&](Document& document) { return document.change_displacement(index, change); });
}

void Workbench::change_material(size_t index, const std::function<void(Material&)>& change) {
    change_value([&](Document& document) { return document.change_material(index, change); });
}

void Workbench::change_environment(const std::function<void(Environment&)>& change) {
    change_value([&](Document& document) { return document.change_environment(change); });
}

void Workbench::change_light(size_t index, const std::function<void(Light&)>& change) {
    change_value([&](Document& document) { return document.change_light(index, change); });
}

void Workbench::end_message() {
    if (message_ == passing_message_) message_.clear();
}

void Workbench::note_message() {
    if (message_.empty() || (!messages_.empty() && messages_.front() == message_)) return;
    messages_.push_front(message_);
    if (messages_.size() > kMostMessages) messages_.pop_back();
}

bool Workbench::has_edits() const {
    return document_ && (document_->has_changes() || document_->has_strokes_aside());
}

bool Workbench::has_unsaved() const { return has_edits() || (document_ && has_dropped_map_); }

void Workbench::set_tool(Tool tool) {
    tool_ = tool;
    has_news_ = true;
    if (tool == Tool::paint) { // its session is ready when the first stroke begins
        needs_snapshot_ = true;
        needs_request_ = true;
    }
}

void Workbench::send(std::vector<MapEdit> edits) {
    set_motion(Motion::painting);
    request(std::move(edits));
}

void Workbench::undo() {
    if (can_undo()) take_step([&] { return painter_->undo(); });
}

void Workbench::redo() {
    if (can_redo()) take_step([&] { return painter_->redo(); });
}

void Workbench::take_step(const std::function<std::vector<MapEdit>()>& step) {
    last_change_ = -kChangeInterval;
    end_message();
    attempt([&] {
        std::vector<MapEdit> edits = step();
        edits.empty() ? set_motion(Motion::moving) : send(std::move(edits));
    });
}

void Workbench::explain(float x, float y) {
    if (!document_ || explaining_.valid() || x < 0 || y < 0 || x >= float(settings_.image.width) ||
        y >= float(settings_.image.height))
        return;
    explained_pixel_ = Vec2f{x, y};
    explanation_ = {"...", kNoIndex, {}};
    std::shared_ptr<const SharedScene> scene = document_->snapshot();
    RenderSettings settings = settings_;
    settings.image.layers.clear();
    explaining_ = std::async(std::launch::async, [scene, settings, x, y, on_news = on_news_]() {
        cli::PixelExplanation explanation;
        try {
            explanation = cli::explain_pixel(make_whole(*scene), settings, int(x), int(y));
        } catch (const std::exception& error) {
            explanation.text = error.what();
        }
        if (on_news) on_news();
        return explanation;
    });
}

void Workbench::forget_explanation() {
    explanation_ = {};
    explained_pixel_.reset();
}

SessionUse Workbench::choose_use() const {
    if (tool_ == Tool::paint || (painter_ && (painter_->is_active() || painter_->has_strokes())))
        return SessionUse::edits;
    return shot_ ? SessionUse::scenes : SessionUse::views;
}

/// Edits that were made while the request waits are in the snapshot as well; making them again changes
/// nothing.
void Workbench::request(std::vector<MapEdit> edits) {
    needs_request_ = false;
    if (!document_) return;
    if (needs_snapshot_ || snapshot_version_ != document_->version() || !snapshot_) {
        snapshot_ = document_->snapshot();
        snapshot_version_ = document_->version();
        needs_snapshot_ = false;
    }
    RenderRequest request;
    request.scene = snapshot_;
    request.scene_version = (scene_count_ << 32) + snapshot_version_;
    request.settings = settings_;
    request.camera = camera_.get();
    request.motion = motion_;
    request.shot = shot_ ? scene_count_ : 0;
    request.use = choose_use();
    const uint64_t version = loop_.show(request, std::move(edits));
    if (std::exchange(has_changed_, false)) wanted_version_ = version;
    if (std::exchange(has_new_frame_, false)) frame_version_ = version;
}

void Workbench::take_picture() {
    std::shared_ptr<const ShownPicture> picture = loop_.take_picture();
    if (!picture) return;
    picture_ = std::move(picture);
    if (first_picture_time_ < 0) first_picture_time_ = now_;
    has_news_ = true;
    if (denoised_ && denoised_->version != picture_->version) denoised_.reset();
    if (is_denoised_ && picture_->motion == Motion::still)
        preview_.show(picture_);
    else
        preview_.drop();
    finish_output();
}

void Workbench::take_denoised() {
    try {
        const std::shared_ptr<const ShownPicture> denoised = preview_.poll();
        if (!denoised || !picture_ || denoised->version != picture_->version) return;
        denoised_ = denoised;
        has_news_ = true;
        finish_output();
    } catch (const std::exception& error) {
        set_denoised(false);
        passing_message_ = message_ = error.what();
    }
}

const std::shared_ptr<const ShownPicture>& Workbench::shown_picture() const {
    return is_denoised_ && denoised_ ? denoised_ : picture_;
}

bool Workbench::set_denoised(bool is_denoised) {
    if (is_denoised && !attempt([&] { preview_.load(settings_.device.threads); })) return false;
    if (std::exchange(is_denoised_, is_denoised) == is_denoised) return true;
    denoised_.reset();
    preview_.drop();
    change_settings([&](RenderSettings& settings) {
        std::vector<std::string>& layers = settings.image.layers;
        layers.assign(std::begin(kViewerLayers), std::end(kViewerLayers));
        if (is_denoised) layers.insert(layers.end(), std::begin(kDenoiserLayers), std::end(kDenoiserLayers));
    });
    return true;
}

void Workbench::poll_jobs() {
    if (is_ready(loading_)) {
        Loaded loaded = loading_.get();
        if (next_load_)
            start(*std::exchange(next_load_, std::nullopt));
        else
            attempt([&] { adopt(std::move(loaded)); });
    }
    if (is_ready(rereading_)) {
        Reread reread = rereading_.get();
        attempt([&] { adopt(std::move(reread)); });
    }
    if (is_ready(explaining_)) {
        cli::PixelExplanation explanation = explaining_.get();
        if (explained_pixel_) explanation_ = std::move(explanation); // else it was closed meanwhile
        has_news_ = true;
    }
    if (now_ - last_poll_ < kWatchInterval) return;
    last_poll_ = now_;
    if (loading_.valid() || rereading_.valid()) return;
    if (const auto files = watch_.poll(); !files.empty()) reload(files);
}

void Workbench::fly(double seconds) {
    if (drag_.action != DragAction::look) return;
    const auto hold = [&](char key) { return held_keys_.contains(key) ? 1.0f : 0.0f; };
    const float right = hold('D') - hold('A'), up = hold('E') - hold('Q'), forward = hold('W') - hold('S');
    if (right == 0 && up == 0 && forward == 0) return;
    const float way = kFlySpeed * float(std::min(seconds, 0.1)) * (modifiers_.shift ? 3.0f : 1.0f);
    change_camera([&](OrbitCamera& camera) { camera.fly(right * way, up * way, forward * way); });
}

bool Workbench::is_moving() const {
    return motion_ != Motion::still || drag_.action != DragAction::none || timeline_.is_playing() ||
           wanted_frame_;
}

bool Workbench::update(double now) {
    fly(now - std::exchange(now_, now));
    poll_jobs();
    take_picture();
    poll_frames();
    take_denoised();
    if (is_done()) preview_.look();
    if (const std::string error = loop_.state().error; error != last_error_) {
        if (!error.empty() || message_ == last_error_) message_ = error;
        last_error_ = error;
        needs_snapshot_ = true; // the next session begins with all that was painted
        has_news_ = true;
    }
    const double rest = motion_ == Motion::painting        ? kPaintRest
                        : drag_.action != DragAction::none ? kHeldRest
                                                           : kRest;
    const bool is_painted_on = painter_ && painter_->is_active();
    if (motion_ != Motion::still && !is_painted_on && now_ - last_motion_ > rest) {
        motion_ = Motion::still; // what is to be seen stays the same
        needs_request_ = true;
    }
    if (needs_request_) request();
    for (const std::string& error : state_.take_errors()) {
        message_ = fmt::format("what was painted is not kept: {}", error);
        has_news_ = true;
    }
    note_message();
    if (document_ && !is_painted_on) state_.keep_painted(now_, *document_);
    return std::exchange(has_news_, false);
}

bool Workbench::is_shown() const {
    return document_ && !is_loading() && !needs_request_ && !wanted_frame_ && picture_ &&
           picture_->version >= wanted_version_;
}

bool Workbench::is_done() const {
    return is_shown() && motion_ == Motion::still && picture_->is_complete &&
           (!is_denoised_ || (denoised_ && denoised_->is_complete));
}

} // namespace relief::viewer
