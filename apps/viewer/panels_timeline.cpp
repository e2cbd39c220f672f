// The strip below the picture: frames of a scene that differs from one to the next.
#include <algorithm>
#include <optional>

#include <fmt/format.h>
#include <imgui.h>

#include "relief/shot.h"
#include "viewer/panels.h"

namespace relief::viewer {

namespace {

void explain_item(const char* text) {
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", text);
}

bool draw_button(const char* label, const char* meaning) {
    const bool is_pressed = ImGui::Button(label);
    explain_item(meaning);
    ImGui::SameLine();
    return is_pressed;
}

void draw_transport(Workbench& workbench) {
    const Timeline& timeline = workbench.timeline();
    if (!timeline.has_range()) {
        if (draw_button("<", "previous frame (left)")) workbench.step_frame(-1);
        if (draw_button(">", "next frame (right)")) workbench.step_frame(1);
        return;
    }
    if (draw_button("|<", "first frame (shift + left)")) workbench.show_end_frame(-1);
    if (draw_button("<", "previous frame (left)")) workbench.step_frame(-1);
    if (draw_button(timeline.is_playing() ? "pause##play" : "play##play", "plays or pauses (space)"))
        workbench.set_playing(!timeline.is_playing());
    if (draw_button(">", "next frame (right)")) workbench.step_frame(1);
    if (draw_button(">|", "last frame (shift + right)")) workbench.show_end_frame(1);
}

void seek(Workbench& workbench, int frame) {
    workbench.set_playing(false);
    workbench.show_frame(std::clamp(frame, -kMaxFrame, kMaxFrame));
}

} // namespace

void draw_timeline(Workbench& workbench) {
    const std::optional<int> wanted = workbench.wanted_frame();
    if (!wanted) return;
    draw_transport(workbench);
    const Timeline& timeline = workbench.timeline();
    const float letter = ImGui::GetFontSize();
    int frame = *wanted;
    ImGui::SetNextItemWidth(letter * 4);
    if (ImGui::InputInt("##frame", &frame, 0)) seek(workbench, frame);
    explain_item("the frame: a number to type");
    const std::string rate = fmt::format("{:.4g} fps", timeline.fps());
    const float after = ImGui::CalcTextSize(rate.c_str()).x + ImGui::GetStyle().ItemSpacing.x +
                        (workbench.has_own_camera() ? letter * 8.5f : 0.0f);
    if (timeline.has_range()) {
        ImGui::SameLine();
        ImGui::SetNextItemWidth(std::max(ImGui::GetContentRegionAvail().x - after, letter * 4));
        if (ImGui::SliderInt("##timeline", &frame, timeline.frames().front(), timeline.frames().back(), "%d",
                             ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_NoInput))
            seek(workbench, timeline.snap(frame));
    }
    ImGui::SameLine();
    ImGui::TextUnformatted(rate.c_str());
    if (!workbench.has_own_camera()) return;
    ImGui::SameLine();
    if (ImGui::Button("scene camera", {letter * 8, 0})) workbench.take_scene_camera();
    explain_item("looks by the camera of the scene again, which follows its keys");
}

} // namespace relief::viewer
