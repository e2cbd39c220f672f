// Workbench: what the mouse and the keys do.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

#include "viewer/surface_point.h"
#include "viewer/workbench.h"

namespace relief::viewer {

namespace {

/// Radians a width of the picture when it is turned by the mouse; radians a key press.
constexpr float kTurn = 4, kKeyTurn = 0.1f;
/// Factor of the distance a step of the wheel or a key.
constexpr float kDollyStep = 0.85f;
/// Pixels that a click may move.
constexpr float kClickReach = 3;
/// Keys that act again while they are held.
constexpr int kRepeating[] = {kLeft, kRight, kUp, kDown, '+', '=', '-', '[', ']'};

/// Of those others tell none, though a modifier is held.
bool tells_modifiers(InputEvent::Kind kind) {
    using Kind = InputEvent::Kind;
    return kind == Kind::press || kind == Kind::release || kind == Kind::key_down || kind == Kind::key_up;
}

} // namespace

Vec2f Workbench::to_picture(float x, float y) const {
    return {(x - area_.x) / area_.width * float(settings_.image.width),
            (y - area_.y) / area_.height * float(settings_.image.height)};
}

void Workbench::handle(const InputEvent& event) {
    using Kind = InputEvent::Kind;
    has_news_ |= event.kind != Kind::move || tool_ == Tool::paint;
    if (tells_modifiers(event.kind)) modifiers_ = event.modifiers;
    switch (event.kind) {
    case Kind::press:
        return press(event);
    case Kind::move:
        return move(event);
    case Kind::release:
        return release(event);
    case Kind::scroll:
        return change_camera([&](OrbitCamera& camera) { camera.dolly(std::pow(kDollyStep, event.amount)); });
    case Kind::key_down:
        return press_key(event);
    case Kind::key_up:
        held_keys_.erase(event.key);
        return;
    case Kind::drop:
        ask_to_open(event.files);
    }
}

void Workbench::press(const InputEvent& event) {
    if (drag_.action != DragAction::none) return; // a second button
    drag_ = {choose_action(navigation_, event.button, event.modifiers),
             event.button,
             event.x,
             event.y,
             event.x,
             event.y};
    if (drag_.action == DragAction::focus && picture_) {
        const Vec2f at = to_picture(event.x, event.y);
        if (const auto point = find_surface_point(*picture_, at.x, at.y))
            change_camera([&](OrbitCamera& camera) { camera.focus(point->position); });
    }
    if (drag_.action != DragAction::tool || tool_ != Tool::paint || !painter_ || !picture_) return;
    const Vec2f at = to_picture(event.x, event.y);
    attempt([&] {
        std::vector<MapEdit> edits = painter_->begin(brush_, *picture_, at.x, at.y);
        if (!painter_->is_active()) return;
        timeline_.pause();
        end_message();
        send(std::move(edits));
    });
}

void Workbench::move(const InputEvent& event) {
    if (drag_.action == DragAction::none) return;
    drag_.has_moved |= std::hypot(event.x - drag_.start_x, event.y - drag_.start_y) > kClickReach;
    if (drag_.has_moved) drag_to(event);
}

void Workbench::drag_to(const InputEvent& event) {
    const float dx = event.x - drag_.x, dy = event.y - drag_.y;
    drag_.x = event.x, drag_.y = event.y;
    DragAction action = drag_.action;
    if (action == DragAction::tool && tool_ == Tool::look) action = DragAction::orbit;
    const float turn = kTurn / area_.width;
    switch (action) {
    case DragAction::orbit:
        return change_camera([&](OrbitCamera& camera) { camera.orbit(-dx * turn, dy * turn); });
    case DragAction::look:
        return change_camera([&](OrbitCamera& camera) { camera.look(dx * turn / 2, -dy * turn / 2); });
    case DragAction::pan:
        return change_camera([&](OrbitCamera& camera) { camera.pan(-dx / area_.height, dy / area_.height); });
    case DragAction::dolly:
        return change_camera(
            [&](OrbitCamera& camera) { camera.dolly(std::exp((dy - dx) * 2 / area_.height)); });
    case DragAction::tool:
        if (painter_ && painter_->is_active() && picture_) {
            const Vec2f at = to_picture(event.x, event.y);
            attempt([&] {
                std::vector<MapEdit> edits = painter_->move(*picture_, at.x, at.y);
                if (!edits.empty()) send(std::move(edits));
            });
        }
        return;
    case DragAction::focus:
    case DragAction::none:
        return;
    }
}

void Workbench::release(const InputEvent& event) {
    if (drag_.action == DragAction::none || event.button != drag_.button) return;
    const Drag drag = std::exchange(drag_, {});
    if (painter_ && painter_->is_active()) {
        painter_->end();
        last_motion_ = now_;
        return;
    }
    if (drag.action != DragAction::tool || tool_ != Tool::look || drag.has_moved) return;
    const Vec2f at = to_picture(event.x, event.y);
    if (picture_) {
        const auto point = find_surface_point(*picture_, at.x, at.y);
        select(point ? std::optional(point->object) : std::nullopt);
    }
    explain(at.x, at.y);
}

void Workbench::press_key(const InputEvent& event) {
    held_keys_.insert(event.key);
    if (event.modifiers.control) {
        if (event.key == 'Z') event.modifiers.shift ? redo() : undo();
        if (event.key == 'Y') redo();
        if (event.key == 'Q') wants_to_end_ = true;
        return;
    }
    if (drag_.action == DragAction::look) return; // letters fly
    if (event.is_repeat && std::ranges::find(kRepeating, event.key) == std::end(kRepeating)) return;
    if (press_command(event.key) || press_frame_key(event)) return;
    const auto orbit = [&](float right, float up) {
        change_camera([&](OrbitCamera& camera) { camera.orbit(right * kKeyTurn, up * kKeyTurn); });
    };
    const auto dolly = [&](float steps) {
        change_camera([&](OrbitCamera& camera) { camera.dolly(std::pow(kDollyStep, steps)); });
    };
    switch (event.key) {
    case kLeft:
        return orbit(-1, 0);
    case kRight:
        return orbit(1, 0);
    case kUp:
        return orbit(0, 1);
    case kDown:
        return orbit(0, -1);
    case '+':
    case '=':
        return dolly(1);
    case '-':
        return dolly(-1);
    default:
        return;
    }
}

bool Workbench::press_frame_key(const InputEvent& event) {
    if (!frame() || (event.key != kLeft && event.key != kRight)) return false;
    const int direction = event.key == kLeft ? -1 : 1;
    event.modifiers.shift ? show_end_frame(direction) : step_frame(direction);
    return true;
}

bool Workbench::press_command(int key) {
    switch (key) {
    case 'S':
        save(suggest_file(".json"));
        return true;
    case ' ':
        set_playing(!timeline_.is_playing());
        return true;
    case 'B':
        set_tool(tool_ == Tool::look ? Tool::paint : Tool::look);
        return true;
    case '.':
        frame_selected();
        return true;
    case kHome:
        frame_all();
        return true;
    case '[':
        brush_.radius = std::max(1.0f, brush_.radius * 0.8f);
        return true;
    case ']':
        brush_.radius = std::min(1000.0f, brush_.radius * 1.25f);
        return true;
    case kF1:
        is_help_shown_ = !is_help_shown_;
        return true;
    case kF12:
        write_picture();
        return true;
    case kEscape:
        is_help_shown_ = false;
        forget_explanation();
        selected_object_.reset();
        return true;
    default:
        return false;
    }
}

} // namespace relief::viewer
