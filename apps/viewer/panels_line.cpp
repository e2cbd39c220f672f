// The line of state below the picture with its messages, the question at the end, and help.
#include <algorithm>
#include <string>

#include <imgui.h>

#include "viewer/panels.h"

namespace relief::viewer {

namespace {

constexpr const char* kKeyTexts[][2] = {
    {"left button", "turns; a click selects and explains; paints where that is chosen"},
    {"middle button", "turns; with shift moves, with control zooms (as Blender)"},
    {"alt + left, middle, right", "turns, moves, zooms (as Maya: panel Camera)"},
    {"right button", "looks around; with W A S D Q E flies, with shift faster"},
    {"control + click", "brings what is there into the middle, and into focus"},
    {"wheel, + and -", "nearer, farther"},
    {"arrows", "turn; with a timeline left and right show the frame before and after"},
    {"shift + left, right", "first and last frame of a timeline"},
    {"space", "plays a timeline, or pauses it"},
    {". and Home", "show the object that was clicked on; all objects"},
    {"B", "paint or look"},
    {"[ and ]", "smaller and larger brush"},
    {"control + Z, control + Y", "undo, redo: strokes, changes of maps, materials and lights"},
    {"S", "saves the scene, and painted maps beside it"},
    {"F12", "writes the picture once all its samples are there: .exr, or .png as it is seen"},
    {"control + Q", "ends"},
    {"Escape", "closes what explains a pixel, and this help"},
    {"drop files", "a scene or mesh opens, with its map; a map goes onto the mesh, an .hdr is the light"},
};

constexpr const char* kPanels[][2] = {
    {"File", "what is open, and the names to save it under"},
    {"View", "colour or a layer of the picture, exposure, display transform"},
    {"Objects", "what the scene holds; selects, and brings into the middle"},
    {"Displacement", "how a map is meant: preset, axes, scale, midlevel; saves maps"},
    {"Paint", "brushes for the map, their size and strength; undo"},
    {"Camera", "where it stands, lens and focus; mouse as in Blender or Maya"},
    {"Light", "environment and lights"},
    {"Material", "colour, roughness and metal"},
    {"Render", "samples, noise, bounces, levels, engine"},
    {"Statistics", "speed and memory of the last renders"},
};

template <size_t N> void draw_table(const char* name, const char* const (&lines)[N][2]) {
    if (!ImGui::BeginTable(name, 2, ImGuiTableFlags_SizingFixedFit)) return;
    for (const auto& [key, meaning] : lines) {
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(key);
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(meaning);
    }
    ImGui::EndTable();
}

void draw_samples(const Workbench& workbench) {
    const auto& picture = workbench.picture();
    if (!workbench.document() || !picture) return;
    if (picture->image.width < picture->full_width) {
        ImGui::Text("preview, %.0f %% size", 100.0 * picture->image.width / picture->full_width);
        return;
    }
    const int total = workbench.settings().image.spp;
    ImGui::Text("%d of %d samples", picture->is_complete ? total : std::min(picture->samples, total), total);
}

void draw_wrapped(const std::string& text, float width) {
    ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + width);
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopTextWrapPos();
}

} // namespace

void draw_state(Workbench& workbench, float indent) {
    draw_samples(workbench);
    ImGui::SameLine(indent);
    if (workbench.message().empty()) return;
    const float width = ImGui::GetContentRegionAvail().x;
    ImGui::TextUnformatted(workbench.message().c_str());
    if (ImGui::IsItemHovered() && ImGui::CalcTextSize(workbench.message().c_str()).x > width) {
        ImGui::BeginTooltip();
        draw_wrapped(workbench.message(), width);
        ImGui::EndTooltip();
    }
    if (ImGui::IsItemClicked()) ImGui::OpenPopup("messages");
    if (!ImGui::BeginPopup("messages")) return;
    for (const std::string& message : workbench.messages()) draw_wrapped(message, width);
    ImGui::EndPopup();
}

void draw_empty_view(const Workbench& workbench, const ViewArea& area) {
    if (workbench.document() || workbench.is_loading()) return;
    const float width = area.width * 0.7f;
    ImGui::SetNextWindowPos({area.x + area.width / 2, area.y + area.height / 2}, ImGuiCond_Always,
                            {0.5f, 0.5f});
    ImGui::SetNextWindowSize({width, 0});
    constexpr ImGuiWindowFlags kFlags = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoInputs |
                                        ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoSavedSettings;
    if (ImGui::Begin("Empty", nullptr, kFlags)) {
        ImGui::PushStyleColor(ImGuiCol_Text, ImVec4(1.0f, 0.75f, 0.3f, 1.0f));
        draw_wrapped(workbench.load_error(), width);
        ImGui::PopStyleColor();
        draw_wrapped("Drop a scene or a mesh here, with its map. F1 lists keys.", width);
    }
    ImGui::End();
}

EndAnswer draw_end_question(const std::string& file, const char* leave) {
    EndAnswer answer = EndAnswer::none;
    constexpr const char* kTitle = "Not everything is saved";
    if (!ImGui::IsPopupOpen(kTitle)) ImGui::OpenPopup(kTitle);
    const ImVec2 middle = ImGui::GetMainViewport()->GetCenter();
    ImGui::SetNextWindowPos(middle, ImGuiCond_Appearing, {0.5f, 0.5f});
    if (!ImGui::BeginPopupModal(kTitle, nullptr, ImGuiWindowFlags_AlwaysAutoResize)) return answer;
    ImGui::Text("Save what was changed as %s?", file.c_str());
    // Not with the key that chose what is asked about.
    const bool is_entered = !ImGui::IsWindowAppearing() && ImGui::IsKeyPressed(ImGuiKey_Enter, false);
    if (ImGui::Button("save") || is_entered) answer = EndAnswer::save;
    ImGui::SameLine();
    if (ImGui::Button(leave)) answer = EndAnswer::leave;
    ImGui::SameLine();
    if (ImGui::Button("cancel") || ImGui::IsKeyPressed(ImGuiKey_Escape)) answer = EndAnswer::stay;
    if (answer != EndAnswer::none) ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
    return answer;
}

void draw_help(Workbench& workbench) {
    bool is_shown = true;
    ImGui::SetNextWindowPos({40, 40}, ImGuiCond_Appearing);
    if (ImGui::Begin("Keys, buttons and panels (F1)", &is_shown,
                     ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse)) {
        draw_table("keys", kKeyTexts);
        ImGui::Separator();
        draw_table("panels", kPanels);
    }
    ImGui::End();
    if (!is_shown) workbench.show_help(false);
}

} // namespace relief::viewer
