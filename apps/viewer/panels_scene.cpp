// Panels of what a scene holds: displacement, camera, lights, materials, files.
#include <algorithm>
#include <array>
#include <filesystem>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "common/whole_names.h"
#include "relief/convert.h"
#include "viewer/conventions.h"
#include "viewer/panels.h"

namespace relief::viewer {

namespace {

/// A list to choose one of several named things; nothing where there is one alone.
template <class Items> void choose_item(const char* label, const Items& items, size_t& index) {
    index = std::min(index, items.empty() ? 0 : items.size() - 1);
    if (items.size() < 2 || !ImGui::BeginCombo(label, items[index].name.c_str())) return;
    for (size_t k = 0; k < items.size(); ++k) {
        ImGui::PushID(int(k));
        if (ImGui::Selectable(items[k].name.c_str(), k == index)) index = k;
        ImGui::PopID();
    }
    ImGui::EndCombo();
}

/// One number for all three where they are the same.
bool edit_factors(const char* label, Vec3f& factors, float speed) {
    if (factors.x == factors.y && factors.y == factors.z) {
        if (!ImGui::DragFloat(label, &factors.x, speed, 0, 0, "%.4g")) return false;
        factors.y = factors.z = factors.x;
        return true;
    }
    return ImGui::DragFloat3(label, &factors.x, speed, 0, 0, "%.4g");
}

/// Three lists, one a channel: -x ... +z or -t ... +n.
bool edit_axes(Displacement& map) {
    const bool is_tangent = map.space == DisplacementSpace::tangent;
    const char* const words[] = {is_tangent ? "+t" : "+x", is_tangent ? "-t" : "-x",
                                 is_tangent ? "+b" : "+y", is_tangent ? "-b" : "-y",
                                 is_tangent ? "+n" : "+z", is_tangent ? "-n" : "-z"};
    constexpr const char* kChannels[] = {"R", "G", "B"};
    bool is_changed = false;
    for (size_t c = 0; c < 3; ++c) {
        int choice = 2 * map.axes.axis[c] + (map.axes.sign[c] < 0 ? 1 : 0);
        if (c > 0) ImGui::SameLine();
        ImGui::SetNextItemWidth(ImGui::GetFontSize() * 4);
        if (!ImGui::Combo(kChannels[c], &choice, words, 6)) continue;
        set_axis(map.axes, c, uint8_t(choice / 2), choice % 2 ? int8_t(-1) : int8_t(1));
        is_changed = true;
    }
    return is_changed;
}

bool edit_word(const char* label, const char* const* words, int count, int& choice) {
    return ImGui::Combo(label, &choice, words, count);
}

/// `now`: the one that the map has, empty: none. Returns what was chosen, else nothing.
std::string choose_preset(const std::string& now) {
    std::string chosen;
    if (!ImGui::BeginCombo("preset", now.empty() ? "of a program ..." : now.c_str())) return chosen;
    for (const char* preset : kPresets)
        if (ImGui::Selectable(preset, preset == now)) chosen = preset;
    ImGui::EndCombo();
    return chosen;
}

/// True where something of the convention changed.
bool edit_convention(Displacement& map) {
    constexpr const char* kSpaces[] = {"tangent", "object", "world"};
    constexpr const char* kWraps[] = {"clamp", "repeat", "mirror", "black"};
    bool is_changed = false;
    if (map.type == DisplacementType::vector) {
        int space = int(map.space);
        if (edit_word("space", kSpaces, 3, space)) map.space = DisplacementSpace(space), is_changed = true;
        is_changed |= edit_axes(map);
    }
    is_changed |= edit_factors("scale", map.scale, 0.01f);
    if (edit_factors("midlevel", map.midlevel, 0.005f)) map.has_midlevel = is_changed = true;
    int wrap = int(map.wrap);
    if (edit_word("wrap", kWraps, 4, wrap)) map.wrap = WrapMode(wrap), is_changed = true;
    is_changed |= ImGui::Checkbox("flip v", &map.flip_v);
    return is_changed;
}

/// What speaks against how maps are meant: found while they were read, and by the last render.
void draw_doubts(const Workbench& workbench) {
    ImGui::PushStyleColor(ImGuiCol_Text, ImVec4(1.0f, 0.75f, 0.3f, 1.0f));
    for (const std::string& doubt : workbench.document()->doubts()) ImGui::TextWrapped("%s", doubt.c_str());
    for (const std::string& warning : workbench.render_state().statistics->warnings)
        ImGui::TextWrapped("%s", cli::name_map_keys(warning).c_str());
    ImGui::PopStyleColor();
}

/// Saves the chosen map by itself, for this scene or another program.
void draw_map_file(Workbench& workbench, PanelState& state) {
    if (!ImGui::TreeNode("save the map")) return;
    if (state.map_file.empty()) state.map_file = workbench.suggest_file("-map.exr").string();
    ImGui::InputText("##map", &state.map_file);
    constexpr const char* kSame = "convention as it is";
    if (ImGui::BeginCombo("##convention", state.map_preset.empty() ? kSame : state.map_preset.c_str())) {
        if (ImGui::Selectable(kSame)) state.map_preset.clear();
        for (const char* preset : kPresets)
            if (ImGui::Selectable(preset)) state.map_preset = preset;
        ImGui::EndCombo();
    }
    ImGui::SameLine();
    if (ImGui::Button("save map")) workbench.save_map(state.displacement, state.map_file, state.map_preset);
    ImGui::TreePop();
}

} // namespace

void draw_file_panel(Workbench& workbench, PanelState& state) {
    if (!ImGui::CollapsingHeader("File", ImGuiTreeNodeFlags_DefaultOpen)) return;
    if (ImGui::BeginCombo("##recent", "open again ...")) {
        for (const std::filesystem::path& file : workbench.list_recent())
            if (ImGui::Selectable(file.string().c_str())) workbench.ask_to_open({file});
        ImGui::EndCombo();
    }
    if (!workbench.document()) return;
    const Document& document = *workbench.document();
    if (state.input != document.input().file) {
        state.input = document.input().file;
        state.scene_file.clear(), state.map_file.clear(), state.picture_file.clear();
    }
    ImGui::TextUnformatted(document.input().file.filename().string().c_str());
    ImGui::SameLine();
    ImGui::TextDisabled("%s", workbench.has_unsaved() ? "changed"
                              : document.is_saved()   ? "saved"
                                                      : "as it was read");
    if (state.scene_file.empty()) state.scene_file = workbench.suggest_file(".json").string();
    const bool is_entered =
        ImGui::InputText("##scene", &state.scene_file, ImGuiInputTextFlags_EnterReturnsTrue);
    ImGui::SameLine();
    if (ImGui::Button("save (S)") || is_entered) workbench.save(state.scene_file);
    ImGui::InputTextWithHint("##picture", workbench.suggest_file(".exr").filename().string().c_str(),
                             &state.picture_file);
    ImGui::SameLine();
    if (ImGui::Button("write (F12)")) workbench.write_picture();
}

void draw_object_panel(Workbench& workbench) {
    if (!workbench.document() || !ImGui::CollapsingHeader("Objects")) return;
    const Scene& scene = workbench.document()->scene();
    const float row = ImGui::GetTextLineHeightWithSpacing();
    const float rows = float(std::clamp(scene.objects.size(), size_t(1), size_t(8)));
    if (ImGui::BeginChild("objects", {0, row * rows + 4})) {
        ImGuiListClipper clipper;
        clipper.Begin(int(scene.objects.size()));
        while (clipper.Step())
            for (int k = clipper.DisplayStart; k < clipper.DisplayEnd; ++k) {
                const Object& object = scene.objects[size_t(k)];
                const bool is_selected = workbench.selected_object() == uint32_t(k);
                const std::string name = object.name.empty() ? fmt::format("object {}", k) : object.name;
                ImGui::PushID(k);
                if (ImGui::Selectable(name.c_str(), is_selected))
                    workbench.select(is_selected ? std::nullopt : std::optional(uint32_t(k)));
                ImGui::PopID();
            }
    }
    ImGui::EndChild();
    if (const auto& selected = workbench.selected_object(); selected && *selected < scene.objects.size()) {
        const Object& object = scene.objects[*selected];
        const auto tell = [](const char* what, const auto& items, uint32_t index) {
            if (index != kNoIndex) ImGui::TextDisabled("%s %s", what, items[index].name.c_str());
        };
        tell("mesh", scene.meshes, object.mesh);
        tell("displacement", scene.displacements, object.displacement);
        tell("material", scene.materials, object.material);
    }
    if (ImGui::Button("frame selected (.)")) workbench.frame_selected();
    ImGui::SameLine();
    if (ImGui::Button("frame all (Home)")) workbench.frame_all();
}

void draw_displacement_panel(Workbench& workbench, PanelState& state) {
    if (!workbench.document() || workbench.document()->scene().displacements.empty() ||
        !ImGui::CollapsingHeader("Displacement", ImGuiTreeNodeFlags_DefaultOpen))
        return;
    const auto& maps = workbench.document()->scene().displacements;
    choose_item("map", maps, state.displacement);
    Displacement map = maps[state.displacement];
    bool is_changed = false;
    std::string chosen;
    if (map.type == DisplacementType::vector) {
        chosen = choose_preset(workbench.document()->find_preset(state.displacement));
        if (!chosen.empty()) apply_preset(chosen, map), is_changed = true;
    }
    is_changed |= edit_convention(map);
    if (map.type == DisplacementType::vector)
        ImGui::TextDisabled("axes %s", format_map_axes(map.axes, map.space).c_str());
    draw_doubts(workbench);
    draw_map_file(workbench, state);
    if (!is_changed) return;
    workbench.change_displacement(state.displacement, [&](Displacement& changed) { changed = map; });
    if (!chosen.empty()) workbench.document()->note_preset(state.displacement, chosen);
}

void draw_camera_panel(Workbench& workbench) {
    if (!ImGui::CollapsingHeader("Camera")) return;
    Camera camera = workbench.camera().get();
    bool is_changed = ImGui::DragFloat3("from", &camera.from.x, 0.01f, 0, 0, "%.4g");
    is_changed |= ImGui::DragFloat3("to", &camera.to.x, 0.01f, 0, 0, "%.4g");
    is_changed |= ImGui::SliderFloat("angle", &camera.fov_degrees, 1, 120, "%.1f degrees");
    is_changed |= ImGui::DragFloat("aperture radius", &camera.aperture_radius, 0.001f, 0, 1e6f, "%.4g");
    if (camera.aperture_radius > 0)
        is_changed |= ImGui::DragFloat("focus distance", &camera.focus_distance, 0.01f, 1e-4f, 1e6f, "%.4g");
    camera.fov_degrees = std::clamp(camera.fov_degrees, 1.0f, 170.0f);
    camera.aperture_radius = std::max(camera.aperture_radius, 0.0f);
    camera.focus_distance = std::max(camera.focus_distance, 1e-4f);
    if (is_changed) workbench.change_camera([&](OrbitCamera& orbit) { orbit.set(camera); });
    ImGui::BeginDisabled(!workbench.has_own_camera());
    if (ImGui::Button("camera of the scene")) workbench.take_scene_camera();
    ImGui::EndDisabled();
    int preset = int(workbench.navigation());
    constexpr const char* kPresetNames[] = {"as Blender", "as Maya"};
    if (ImGui::Combo("mouse", &preset, kPresetNames, 2)) workbench.navigation() = NavigationPreset(preset);
}

void draw_light_panel(Workbench& workbench, PanelState& state) {
    if (!workbench.document() || !ImGui::CollapsingHeader("Light")) return;
    const Scene& scene = workbench.document()->scene();
    if (scene.environment) {
        Environment changed = *scene.environment;
        bool is_changed =
            ImGui::DragFloat("sky rotation", &changed.rotate_degrees, 1, -360, 360, "%.0f degrees");
        is_changed |= ImGui::DragFloat("sky strength", &changed.strength, 0.01f, 0, 1e6f, "%.3g");
        changed.strength = std::max(changed.strength, 0.0f);
        if (is_changed)
            workbench.change_environment([&](Environment& environment) { environment = changed; });
    }
    if (scene.lights.empty()) return;
    state.light = std::min(state.light, scene.lights.size() - 1);
    int index = int(state.light);
    if (scene.lights.size() > 1 && ImGui::SliderInt("light", &index, 0, int(scene.lights.size()) - 1))
        state.light = size_t(std::clamp(index, 0, int(scene.lights.size()) - 1));
    Light light = scene.lights[state.light];
    bool is_changed = ImGui::DragFloat("light strength", &light.strength, 0.01f, 0, 1e9f, "%.3g");
    is_changed |= ImGui::ColorEdit3("light colour", &light.color.x, ImGuiColorEditFlags_Float);
    if (light.type != LightType::point)
        is_changed |= ImGui::DragFloat3("direction", &light.direction.x, 0.01f, 0, 0, "%.3g");
    if (light.type != LightType::sun)
        is_changed |= ImGui::DragFloat3("position", &light.position.x, 0.01f, 0, 0, "%.3g");
    light.strength = std::max(light.strength, 0.0f);
    if (is_changed) workbench.change_light(state.light, [&](Light& changed) { changed = light; });
}

void draw_material_panel(Workbench& workbench, PanelState& state) {
    if (!workbench.document() || workbench.document()->scene().materials.empty() ||
        !ImGui::CollapsingHeader("Material"))
        return;
    const auto& materials = workbench.document()->scene().materials;
    choose_item("material", materials, state.material);
    Material material = materials[state.material];
    bool is_changed = ImGui::ColorEdit3("base colour", &material.base_color.x, ImGuiColorEditFlags_Float);
    is_changed |= ImGui::SliderFloat("roughness", &material.roughness, 0, 1, "%.2f");
    is_changed |= ImGui::SliderFloat("metallic", &material.metallic, 0, 1, "%.2f");
    const auto limit = [](float& value) { value = std::clamp(value, 0.0f, 1.0f); };
    for (float* value : {&material.base_color.x, &material.base_color.y, &material.base_color.z,
                         &material.roughness, &material.metallic})
        limit(*value);
    if (is_changed) workbench.change_material(state.material, [&](Material& changed) { changed = material; });
}

} // namespace relief::viewer
