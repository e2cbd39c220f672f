#include "viewer/script_runner.h"

#include <algorithm>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "relief/error.h"
#include "relief/io.h"

namespace relief::viewer {

namespace {

constexpr double kMostWait = 600;

/// Seconds that a step says itself.
double get_seconds(const ScriptStep& step) {
    if (const auto* const drag = std::get_if<DragStep>(&step)) return drag->seconds;
    if (const auto* const play = std::get_if<PlayStep>(&step)) return play->seconds;
    const auto* const wait = std::get_if<WaitStep>(&step);
    return wait ? wait->seconds : 0;
}

/// Whether a step needs the scene that is being read: until it is there, changes would be lost.
bool needs_scene(const ScriptStep& step) {
    if (std::holds_alternative<WaitStep>(step) || std::holds_alternative<QuitStep>(step)) return false;
    const auto* const file = std::get_if<FileStep>(&step);
    return !file || file->kind == FileStep::Kind::save || file->kind == FileStep::Kind::save_map;
}

} // namespace

ScriptRunner::ScriptRunner(std::vector<ScriptLine> lines, std::string source, Workbench& workbench,
                           ViewSettings& view, Host host)
    : lines_(std::move(lines)),
      source_(std::move(source)),
      workbench_(workbench),
      view_(view),
      host_(std::move(host)) {}

void ScriptRunner::print_step(const char* step, Value more) {
    Value line = {{"line", lines_[next_].number}, {"step", step}};
    line.update(more);
    host_.print(write_json(line));
}

void ScriptRunner::step(double now) {
    if (!has_printed_first_ && workbench_.time_of_first_picture() >= 0) {
        has_printed_first_ = true;
        host_.print(write_json(Value{{"first_picture_s", workbench_.time_of_first_picture()}}));
    }
    while (!is_done()) {
        if (!has_started_ && needs_scene(lines_[next_].step) && workbench_.is_loading()) return;
        if (!std::exchange(has_started_, true)) {
            start_ = now;
            pictures_before_ = workbench_.render_state().picture_count;
        }
        bool is_over = false;
        try {
            if (now - start_ > get_seconds(lines_[next_].step) + kMostWait)
                throw Error(ErrorKind::failed, {"this takes longer than ten minutes", "", ""});
            is_over = std::visit([&](const auto& step) { return run(step, now); }, lines_[next_].step);
        } catch (const Error& error) {
            const ErrorKind kind = error.kind() == ErrorKind::usage ? ErrorKind::bad_input : error.kind();
            throw Error(kind, {error.message(),
                               fmt::format("{}:{}{}{}", source_, lines_[next_].number,
                                           error.where().empty() ? "" : ": ", error.where()),
                               error.hint()});
        }
        if (!is_over) return;
        ++next_;
        has_started_ = false;
        // What follows sees the state that this step leads to.
        if (!is_done() && !std::holds_alternative<SetStep>(lines_[next_].step)) return;
    }
}

bool ScriptRunner::run(const WaitStep& wait, double now) {
    if (wait.what == WaitStep::For::seconds) return now - start_ >= wait.seconds;
    const RenderState state = workbench_.render_state();
    if (!workbench_.is_loading() && (!state.error.empty() || !workbench_.document()))
        throw Error(ErrorKind::failed,
                    {workbench_.message().empty() ? "nothing is open" : workbench_.message(), "", ""});
    const bool is_done = wait.what == WaitStep::For::done;
    if (!(is_done ? workbench_.is_done() : workbench_.is_shown())) return false;
    print_step(is_done ? "done" : "picture", {{"waited_s", now - start_},
                                              {"since_change_s", now - change_},
                                              {"since_start_s", now},
                                              {"width", workbench_.picture()->image.width},
                                              {"height", workbench_.picture()->image.height}});
    return true;
}

bool ScriptRunner::run(const EventStep& step, double now) {
    change_ = now;
    host_.send(step.event);
    if (step.event.kind == InputEvent::Kind::key_down) {
        InputEvent released = step.event;
        released.kind = InputEvent::Kind::key_up;
        host_.send(released);
    }
    return true;
}

void ScriptRunner::send_mouse(const DragStep& drag, InputEvent::Kind kind, float share) {
    InputEvent event;
    event.kind = kind;
    event.button = drag.button;
    event.modifiers = drag.modifiers;
    event.x = drag.from.x + (drag.to.x - drag.from.x) * share;
    event.y = drag.from.y + (drag.to.y - drag.from.y) * share;
    host_.send(event);
}

bool ScriptRunner::run(const DragStep& drag, double now) {
    using Kind = InputEvent::Kind;
    if (now == start_) {
        send_mouse(drag, Kind::move, 0);
        send_mouse(drag, Kind::press, 0);
        if (drag.seconds > 0) return false;
    }
    const double share = drag.seconds > 0 ? std::min((now - start_) / drag.seconds, 1.0) : 1;
    send_mouse(drag, Kind::move, float(share));
    change_ = now;
    if (share < 1) return false;
    send_mouse(drag, Kind::release, 1);
    const uint64_t pictures = workbench_.render_state().picture_count - pictures_before_;
    print_step("drag", {{"seconds", now - start_},
                        {"pictures", pictures},
                        {"pictures_per_second", now > start_ ? double(pictures) / (now - start_) : 0.0},
                        {"scale", workbench_.render_state().picture_scale}});
    return true;
}

bool ScriptRunner::run(const SetStep& step, double now) {
    change_ = now;
    apply_values(step.values, workbench_, view_);
    return true;
}

bool ScriptRunner::run(const FileStep& step, double now) {
    const auto require = [&](bool is_done) {
        if (!is_done) throw Error(ErrorKind::failed, {workbench_.message(), step.file.string(), ""});
    };
    switch (step.kind) {
    case FileStep::Kind::open: {
        SceneInput input{step.file, {}, {}};
        input.mesh.displacement_map = step.map;
        change_ = now;
        workbench_.open(input);
        return true;
    }
    case FileStep::Kind::drop:
        change_ = now;
        workbench_.drop(step.map.empty() ? std::vector{step.file} : std::vector{step.file, step.map});
        return true;
    case FileStep::Kind::screenshot:
        host_.take_screenshot(step.file);
        return true;
    case FileStep::Kind::picture:
        if (!workbench_.picture()) throw Error(ErrorKind::failed, {"there is no picture yet", "", ""});
        write_image(workbench_.shown_picture()->image, step.file);
        return true;
    case FileStep::Kind::save:
        require(workbench_.save(step.file));
        return true;
    case FileStep::Kind::save_map:
        require(workbench_.document() && !workbench_.document()->scene().displacements.empty() &&
                workbench_.save_map(0, step.file, step.preset));
        return true;
    }
    return true;
}

bool ScriptRunner::run(const FrameStep& step, double now) {
    if (now == start_) {
        change_ = now;
        if (!workbench_.show_frame(step.frame))
            throw Error(ErrorKind::bad_input, {"nothing in the scene depends on the frame", "frame", ""});
    }
    if (workbench_.wanted_frame() != workbench_.frame()) return false;
    if (workbench_.frame() != step.frame) throw Error(ErrorKind::failed, {workbench_.message(), "", ""});
    return true;
}

bool ScriptRunner::run(const PlayStep& step, double now) {
    if (now == start_) {
        change_ = now;
        if (!workbench_.timeline().has_range())
            throw Error(ErrorKind::bad_input, {"the scene has no frames to play", "play", ""});
        played_.clear();
        workbench_.set_playing(true);
    }
    played_.insert(*workbench_.frame());
    if (now - start_ < step.seconds) return false;
    workbench_.set_playing(false);
    if (workbench_.wanted_frame() != workbench_.frame()) return false; // what is being read is shown too
    print_step("play", {{"seconds", now - start_},
                        {"frames", played_.size()},
                        {"frame", *workbench_.frame()},
                        {"pictures", workbench_.render_state().picture_count - pictures_before_}});
    return true;
}

bool ScriptRunner::run(const QuitStep&, double) {
    wants_to_end_ = true;
    return true;
}

} // namespace relief::viewer
