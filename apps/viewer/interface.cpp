#include "viewer/interface.h"

#include <algorithm>
#include <chrono>
#include <exception>

#include <fmt/format.h>
#include <imgui.h>

#include "viewer/signals.h"

namespace relief::viewer {

namespace {

/// Frames that widgets need to come to rest after an event.
constexpr int kRestFrames = 3;
/// Seconds of waiting where nothing happens; files are looked at in between.
constexpr double kIdleWait = 0.1, kMovingWait = 0.008;

double read_seconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

constexpr ImGuiWindowFlags kFixed = ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize |
                                    ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoTitleBar;

/// Of what is drawn over the picture.
constexpr ImU32 kMarkColor = IM_COL32(255, 200, 60, 220), kPathColor = IM_COL32(90, 200, 255, 200);

} // namespace

Interface::Interface(Window& window, Workbench& workbench, std::optional<std::pair<int, int>> fixed_size)
    : window_(window), workbench_(workbench), fixed_size_(fixed_size) {
    state_.is_display_changed = true;
}

void Interface::poll_display() {
    if (next_display_.valid()) {
        if (next_display_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
        display_ = next_display_.get();
        needs_texture_ = true;
    }
    // Not before there is a picture: the libraries of a display transform would delay it.
    if (!state_.is_display_changed || !workbench_.picture()) return;
    state_.is_display_changed = false;
    next_display_ = std::async(std::launch::async, [name = state_.display] {
        DisplayTable table; // the curve of sRGB alone where its libraries are missing
        try {
            table = DisplayTable(name);
        } catch (const std::exception&) {
        }
        Window::wake();
        return table;
    });
}

void Interface::place_picture() {
    const float scale = window_.content_scale();
    const float free_width = std::max(1.0f, float(window_.width()) - kPanelWidth * scale);
    const int below = kLineHeight + (workbench_.frame() ? kTimelineHeight : 0);
    const float free_height = std::max(1.0f, float(window_.height()) - float(below) * scale);
    const float ratio = window_.pixel_ratio();
    if (!fixed_size_) {
        area_ = {0, 0, free_width, free_height};
        workbench_.set_picture_size(int(free_width * ratio), int(free_height * ratio));
    } else {
        const auto [width, height] = *fixed_size_;
        const float fit = std::min({free_width / float(width), free_height / float(height), 1.0f / ratio});
        area_.width = float(width) * fit, area_.height = float(height) * fit;
        area_.x = (free_width - area_.width) / 2, area_.y = (free_height - area_.height) / 2;
        workbench_.set_picture_size(width, height);
    }
    workbench_.set_area(area_);
}

void Interface::refresh_texture() {
    const auto& picture = workbench_.shown_picture();
    if (!picture) return;
    const bool is_same_view =
        texture_view_.view == state_.view.view && texture_view_.exposure == state_.view.exposure;
    if (picture == texture_picture_ && is_same_view && !needs_texture_) return;
    texture_picture_ = picture;
    texture_view_ = state_.view;
    needs_texture_ = false;
    window_.upload(make_view(picture->image, state_.view, display_), picture->image.width,
                   picture->image.height);
}

void Interface::draw_picture() {
    if (!texture_picture_) return;
    ImDrawList* const list = ImGui::GetBackgroundDrawList();
    const ImVec2 corner{area_.x, area_.y}, end{area_.x + area_.width, area_.y + area_.height};
    list->AddImage(window_.texture(), corner, end);
    list->PushClipRect(corner, end);
    draw_paths(*list);
    list->PopClipRect();
    const ImU32 line = kMarkColor;
    if (workbench_.tool() != Tool::paint || ImGui::GetIO().WantCaptureMouse) return;
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    if (mouse.x >= corner.x && mouse.x < end.x && mouse.y >= corner.y && mouse.y < end.y)
        list->AddCircle(mouse,
                        workbench_.brush().radius * area_.width / float(workbench_.settings().image.width),
                        line, 48, 1.5f);
}

/// Of the pixel that is explained, as the picture's camera sees them.
void Interface::draw_paths(ImDrawList& list) {
    const ImageSettings& image = workbench_.settings().image;
    const auto place = [&](const Vec2f& pixel) {
        return ImVec2{area_.x + pixel.x / float(image.width) * area_.width,
                      area_.y + pixel.y / float(image.height) * area_.height};
    };
    const auto& paths = workbench_.explanation().paths;
    if (paths.empty()) {
        if (const auto& pixel = workbench_.explained_pixel(); pixel && workbench_.is_explaining())
            list.AddCircle(place(*pixel), 6, kMarkColor, 16, 1.5f);
        return;
    }
    const Camera& camera = texture_picture_->camera;
    const auto project = [&](const Vec3f& a, const Vec3f& b) {
        return project_line(camera, a, b, image.width, image.height);
    };
    for (const std::vector<Vec3f>& path : paths)
        for (size_t k = 1; k < path.size(); ++k) {
            const bool is_of_camera = k == 1;
            if (is_of_camera && path[0] == camera.from) continue; // a point
            if (const auto line = project(path[k - 1], path[k]))
                list.AddLine(place(line->first), place(line->second), is_of_camera ? kMarkColor : kPathColor,
                             1.5f);
        }
    if (const auto hit = project(paths[0][1], paths[0][1]))
        list.AddCircle(place(hit->first), 6, kMarkColor, 16, 1.5f);
}

void Interface::draw_panels() {
    workbench_.set_output(
        state_.picture_file,
        {{"relief:display", state_.display}, {"relief:exposure", fmt::format("{:g}", state_.view.exposure)}});
    const float scale = window_.content_scale(), width = kPanelWidth * scale;
    ImGui::SetNextWindowPos({float(window_.width()) - width, 0});
    ImGui::SetNextWindowSize({width, float(window_.height())});
    if (ImGui::Begin("Panels", nullptr, kFixed)) {
        ImGui::PushItemWidth(width * 0.52f);
        draw_file_panel(workbench_, state_);
        draw_view_panel(state_);
        draw_object_panel(workbench_);
        draw_displacement_panel(workbench_, state_);
        draw_paint_panel(workbench_);
        draw_camera_panel(workbench_);
        draw_light_panel(workbench_, state_);
        draw_material_panel(workbench_, state_);
        draw_render_panel(workbench_);
        draw_statistics_panel(workbench_, state_);
        ImGui::PopItemWidth();
    }
    ImGui::End();
}

void Interface::draw_timeline_strip() {
    if (!workbench_.frame()) return;
    const float scale = window_.content_scale();
    ImGui::SetNextWindowPos({0, float(window_.height()) - (kLineHeight + kTimelineHeight) * scale});
    ImGui::SetNextWindowSize({float(window_.width()) - kPanelWidth * scale, kTimelineHeight * scale});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {6 * scale, 5 * scale});
    if (ImGui::Begin("Timeline", nullptr, kFixed | ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoNav))
        draw_timeline(workbench_);
    ImGui::End();
    ImGui::PopStyleVar();
}

void Interface::draw_line() {
    const float scale = window_.content_scale(), height = kLineHeight * scale;
    ImGui::SetNextWindowPos({0, float(window_.height()) - height});
    ImGui::SetNextWindowSize({float(window_.width()) - kPanelWidth * scale, height});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {6 * scale, 4 * scale});
    if (ImGui::Begin("Line", nullptr, kFixed | ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoNav))
        draw_state(workbench_, 150 * scale);
    ImGui::End();
    ImGui::PopStyleVar();
}

void Interface::draw_explanation() {
    if (workbench_.explanation().text.empty()) return;
    ImGui::SetNextWindowPos({10, 10}, ImGuiCond_Always);
    ImGui::SetNextWindowBgAlpha(0.75f);
    if (ImGui::Begin("Pixel", nullptr,
                     kFixed | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoInputs))
        ImGui::TextUnformatted(workbench_.explanation().text.c_str());
    ImGui::End();
}

/// What was not saved is saved, all of it, or may go.
bool Interface::settle(EndAnswer answer, const std::filesystem::path& file) {
    if (answer == EndAnswer::leave) return true;
    return answer == EndAnswer::save && workbench_.save(file) && !workbench_.has_unsaved();
}

std::filesystem::path Interface::find_scene_file() const {
    return state_.scene_file.empty() ? workbench_.suggest_file(".json")
                                     : std::filesystem::path(state_.scene_file);
}

void Interface::ask_to_open() {
    const std::filesystem::path file = find_scene_file();
    const EndAnswer answer = draw_end_question(file.filename().string(), "open without saving");
    if (answer == EndAnswer::none) return;
    settle(answer, file) ? workbench_.open_asked() : workbench_.forget_asked();
}

void Interface::ask_at_end() {
    const std::filesystem::path file = find_scene_file();
    const EndAnswer answer = draw_end_question(file.filename().string(), "end without saving");
    if (answer == EndAnswer::none) return;
    is_asking_ = false;
    may_end_ = settle(answer, file);
    if (answer == EndAnswer::leave) workbench_.discard();
}

/// Somebody wants to end, and nothing is lost by it, or it is meant.
bool Interface::has_ended() {
    const bool is_wanted = window_.should_close() || workbench_.wants_to_end();
    if (is_wanted && workbench_.has_unsaved()) is_asking_ = true;
    if (is_wanted && !is_asking_) return true;
    window_.refuse_close();
    workbench_.set_wants_to_end(false);
    return may_end_;
}

void Interface::draw() {
    refresh_texture();
    window_.begin_frame();
    draw_picture();
    draw_panels();
    draw_timeline_strip();
    draw_line();
    draw_empty_view(workbench_, area_);
    draw_explanation();
    if (workbench_.is_help_shown()) draw_help(workbench_);
    if (is_asking_)
        ask_at_end();
    else if (workbench_.is_asked_to_open())
        ask_to_open();
    window_.end_frame();
}

void Interface::run(ScriptRunner* script, double start) {
    int frames = kRestFrames;
    while (get_signal() == 0 && !has_ended() && !(script && script->wants_to_end())) {
        const bool is_busy = workbench_.is_moving() || (script && !script->is_done());
        window_.wait_events(frames > 0 ? 0 : is_busy ? kMovingWait : kIdleWait);
        place_picture();
        const double now = read_seconds() - start;
        if (script) script->step(now);
        for (const InputEvent& event : window_.take_events()) {
            workbench_.handle(event);
            // A camera that is dragged is drawn when a picture comes: drawing takes time from rendering.
            if (event.kind != InputEvent::Kind::move || !window_.is_dragging()) frames = kRestFrames;
        }
        if (workbench_.update(now)) frames = std::max(frames, 1);
        note_statistics(workbench_.render_state(), workbench_.picture().get(), state_);
        poll_display();
        const ImGuiIO& io = ImGui::GetIO();
        const bool is_at_rest = frames == 0 && !needs_texture_ && !is_asking_ &&
                                !workbench_.is_asked_to_open() && !io.WantCaptureMouse && !io.WantTextInput;
        if (is_at_rest && !window_.has_screenshot_to_take()) continue;
        draw();
        frames = std::max(frames - 1, 0);
    }
}

} // namespace relief::viewer
