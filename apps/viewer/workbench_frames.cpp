// Workbench: frames of a scene that differs from one to the next.
#include <exception>
#include <utility>

#include <fmt/format.h>

#include "viewer/workbench.h"

namespace relief::viewer {

std::optional<int> Workbench::frame() const {
    return document_ && shot_ ? document_->input().frame : std::nullopt;
}

bool Workbench::show_frame(int frame) {
    if (!this->frame()) return false;
    end_message();
    wanted_frame_.reset();
    if (frame != this->frame()) wanted_frame_ = frame;
    has_news_ = true;
    read_frame();
    return true;
}

void Workbench::step_frame(int direction) {
    timeline_.pause();
    if (const std::optional<int> from = wanted_frame()) show_frame(timeline_.step(*from, direction));
}

void Workbench::show_end_frame(int direction) {
    timeline_.pause();
    if (timeline_.has_range())
        show_frame(direction < 0 ? timeline_.frames().front() : timeline_.frames().back());
}

void Workbench::set_playing(bool is_playing) {
    has_news_ = true;
    if (is_playing && frame())
        timeline_.play(now_, *frame());
    else
        timeline_.pause();
}

void Workbench::take_scene_camera() {
    if (!document_) return;
    change_camera([&](OrbitCamera& camera) { camera.set(scene_camera_); });
    has_own_camera_ = false;
}

bool Workbench::has_picture() const {
    return !has_new_frame_ && ((picture_ && picture_->version >= frame_version_) || !last_error_.empty());
}

/// A frame is not shown before there is a picture of the one before: else there would never be one.
void Workbench::poll_frames() {
    const bool is_ready_for_next = has_picture() && !is_loading() && !(painter_ && painter_->is_active());
    if (timeline_.is_playing() && !wanted_frame_ && !reading_frame_.valid() && is_ready_for_next)
        if (const int due = timeline_.find_frame(now_); due != frame()) wanted_frame_ = due;
    if (is_ready(reading_frame_)) {
        const bool is_wanted = wanted_frame_ == reading_number_;
        if (wanted_frame_ && is_ready_for_next) {
            ReadFrame read = reading_frame_.get();
            attempt([&] { adopt(std::move(read)); });
        } else if (!is_wanted) {
            reading_frame_.get(); // nobody waits for it
        }
    }
    read_frame();
}

void Workbench::read_frame() {
    if (!wanted_frame_ || reading_frame_.valid() || is_loading()) return;
    reading_number_ = *wanted_frame_;
    reading_frame_ = std::async(std::launch::async, [shot = shot_, number = reading_number_,
                                                     known = document_->content(), on_news = on_news_] {
        ReadFrame read{shot, number, std::nullopt, {}};
        try {
            read.frame = shot->read(number, known);
        } catch (const std::exception& error) {
            read.error = error.what();
        }
        if (on_news) on_news();
        return read;
    });
}

void Workbench::adopt(ReadFrame read) {
    if (read.shot != shot_) return; // another file was opened meanwhile
    has_news_ = true;
    if (wanted_frame_ == read.number) wanted_frame_.reset();
    if (!read.frame) {
        timeline_.pause();
        passing_message_ = message_ = fmt::format("frame {}: {}", read.number, read.error);
        return;
    }
    drop_output("another frame is shown");
    const bool is_view = !read.frame->scene;
    const int left_frame = *frame();
    scene_camera_ = read.frame->camera;
    const FrameStrokes strokes = document_->show_frame(std::move(*read.frame));
    if (!has_own_camera_) camera_.set(scene_camera_);
    document_->set_camera(camera_.get());
    if (is_view && has_own_camera_) return; // nothing that is seen differs
    if (!is_view) {
        strokes.has_other_maps ? painter_->forget() : painter_->follow_frame();
        if (selected_object_ && *selected_object_ >= document_->scene().objects.size())
            selected_object_.reset();
        watch_files();
    }
    forget_explanation();
    has_new_frame_ = true;
    set_motion(Motion::moving);
    tell_strokes(left_frame, strokes);
    if (!strokes.left.empty())
        strokes_message_ = message_;
    else if (message_ == strokes_message_ && !document_->has_strokes_aside())
        message_.clear();
}

void Workbench::tell_strokes(int left_frame, const FrameStrokes& strokes) {
    const std::filesystem::path& input = document_->input().file;
    for (const std::string& name : strokes.returned)
        for (const Displacement& map : document_->scene().displacements)
            if (map.name == name) state_.take_back(input, map, *frame());
    for (const Displacement& map : strokes.left) {
        message_ = fmt::format("what was painted on '{}' is not saved; it comes back with frame {}", map.name,
                               left_frame);
        if (const std::filesystem::path kept = state_.set_aside(input, map, left_frame); !kept.empty())
            message_ += fmt::format(", and is kept as {}", kept.string());
    }
}

} // namespace relief::viewer
