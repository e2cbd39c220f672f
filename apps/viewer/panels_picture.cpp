// Panels of how a scene is rendered, seen and painted; statistics.
#include <algorithm>
#include <array>
#include <iterator>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "relief/devices.h"
#include "viewer/panels.h"

namespace relief::viewer {

namespace {

void draw_bytes(const char* name, uint64_t bytes, uint64_t total) {
    const float share = total > 0 ? float(double(bytes) / double(total)) : 0;
    ImGui::ProgressBar(share, {ImGui::GetFontSize() * 8, 0},
                       fmt::format("{:.1f} MiB", double(bytes) / 1048576).c_str());
    ImGui::SameLine();
    ImGui::TextUnformatted(name);
}

/// The last values from left to right.
void draw_history(const char* label, const std::array<float, PanelState::kHistory>& values, size_t count,
                  const char* format) {
    if (count == 0) return;
    const int shown = int(std::min(count, values.size()));
    const int first = count > values.size() ? int(count % values.size()) : 0;
    const float last = values[(count - 1) % values.size()];
    const float most = *std::max_element(values.begin(), values.end());
    ImGui::PlotLines(label, values.data(), shown, first, fmt::format(fmt::runtime(format), last).c_str(), 0,
                     most * 1.1f, {0, ImGui::GetFontSize() * 3});
}

} // namespace

void note_statistics(const RenderState& render, const ShownPicture* picture, PanelState& state) {
    if (render.picture_count == state.last_picture || !picture) return;
    state.last_picture = render.picture_count;
    const Statistics& s = *render.statistics;
    const double rays = double(s.camera_rays + s.shadow_rays + s.bounce_rays);
    const size_t at = state.history_count++ % PanelState::kHistory;
    // Times of stages are those of all threads together.
    const double seconds = s.top_traversal_s + s.bottom_build_s + s.bottom_traversal_s + s.shade_s + s.film_s;
    state.rays[at] = seconds > 0 ? float(1e-6 * rays / seconds * std::max(s.threads, 1)) : 0;
    state.times[at] = float(1e3 * picture->seconds);
}

void draw_paint_panel(Workbench& workbench) {
    if (!workbench.document() || workbench.document()->scene().displacements.empty() ||
        !ImGui::CollapsingHeader("Paint", ImGuiTreeNodeFlags_DefaultOpen))
        return;
    bool is_painting = workbench.tool() == Tool::paint;
    if (ImGui::Checkbox("paint with the left button (B)", &is_painting))
        workbench.set_tool(is_painting ? Tool::paint : Tool::look);
    Brush& brush = workbench.brush();
    constexpr const char* kBrushes[] = {"push", "grab", "smooth", "erase"};
    int kind = int(brush.kind);
    if (ImGui::Combo("brush", &kind, kBrushes, 4)) brush.kind = BrushKind(kind);
    ImGui::SliderFloat("radius ([ ])", &brush.radius, 1, 400, "%.0f pixels");
    if (brush.kind != BrushKind::grab) ImGui::SliderFloat("strength", &brush.strength, -1, 1, "%.2f");
    ImGui::BeginDisabled(!workbench.can_undo());
    if (ImGui::Button("undo")) workbench.undo();
    ImGui::EndDisabled();
    ImGui::SameLine();
    ImGui::BeginDisabled(!workbench.can_redo());
    if (ImGui::Button("redo")) workbench.redo();
    ImGui::EndDisabled();
}

void draw_render_panel(Workbench& workbench) {
    if (!ImGui::CollapsingHeader("Render")) return;
    RenderSettings changed = workbench.settings();
    bool is_changed = false;
    static const bool has_devices = !vulkan_devices().empty();
    if (has_devices) {
        int engine = int(changed.device.engine);
        constexpr const char* kEngines[] = {"cpu", "vulkan"};
        if (ImGui::Combo("engine", &engine, kEngines, 2)) {
            changed.device.engine = EngineKind(engine);
            is_changed = true;
        }
    }
    if (bool is_denoised = workbench.is_denoised();
        workbench.has_denoiser() && ImGui::Checkbox("denoise", &is_denoised)) {
        workbench.set_denoised(is_denoised);
        return;
    }
    is_changed |= ImGui::InputInt("samples", &changed.image.spp, 16, 64);
    is_changed |= ImGui::SliderFloat("noise", &changed.image.noise, 0, 0.2f, "up to %.3f");
    is_changed |= ImGui::SliderInt("bounces", &changed.image.bounces, 0, 16);
    is_changed |= ImGui::SliderFloat("pixel error", &changed.surface.pixel_error, 0.25f, 8, "%.2f pixels",
                                     ImGuiSliderFlags_Logarithmic);
    bool is_automatic = changed.surface.level == kAutoLevel;
    if (ImGui::Checkbox("levels by size on the screen", &is_automatic)) {
        changed.surface.level = is_automatic ? kAutoLevel : 4;
        is_changed = true;
    }
    if (!is_automatic) is_changed |= ImGui::SliderInt("level", &changed.surface.level, 0, 8);
    changed.image.spp = std::clamp(changed.image.spp, 1, kMaxSamples);
    changed.image.noise = std::clamp(changed.image.noise, 0.0f, 1.0f);
    changed.image.bounces = std::clamp(changed.image.bounces, 0, kMaxBounces);
    changed.surface.pixel_error = std::clamp(changed.surface.pixel_error, 0.05f, 100.0f);
    changed.surface.level = std::clamp(changed.surface.level, kAutoLevel, kMaxLevel);
    if (is_changed) workbench.change_settings([&](RenderSettings& settings) { settings = changed; });
}

void draw_view_panel(PanelState& state) {
    if (!ImGui::CollapsingHeader("View", ImGuiTreeNodeFlags_DefaultOpen)) return;
    int view = int(state.view.view);
    if (ImGui::Combo("shown", &view, kViewNames, int(std::size(kViewNames)))) state.view.view = View(view);
    if (state.view.view != View::color) return;
    ImGui::SliderFloat("exposure", &state.view.exposure, -8, 8, "%.1f stops");
    // No part of a scene.
    if (state.view.exposure != 0) ImGui::TextDisabled("of a render: --exposure %g", state.view.exposure);
    if (!ImGui::BeginCombo("display", state.display.c_str())) return;
    for (const char* name : kDisplayNames)
        if (ImGui::Selectable(name, state.display == name))
            state.display = name, state.is_display_changed = true;
    ImGui::EndCombo();
}

void draw_statistics_panel(const Workbench& workbench, const PanelState& state) {
    if (!ImGui::CollapsingHeader("Statistics")) return;
    const RenderState render = workbench.render_state();
    const Statistics& s = *render.statistics;
    draw_history("rays", state.rays, state.history_count, "{:.2f} million a second");
    draw_history("picture", state.times, state.history_count, "{:.0f} ms");
    ImGui::Text("%s, %s", s.engine.c_str(), (s.engine == "cpu" ? s.isa : s.device).c_str());
    ImGui::Text("%llu patches, %llu triangles", static_cast<unsigned long long>(s.patches),
                static_cast<unsigned long long>(s.triangles));
    ImGui::Text("patch trees: %llu built, %llu reused", static_cast<unsigned long long>(s.bottom_built),
                static_cast<unsigned long long>(s.bottom_reused));
    const uint64_t total = s.geometry_bytes + s.structures_bytes + s.displacement_bytes +
                           s.bottom_cache_bytes + s.ray_buffers_bytes;
    draw_bytes("geometry", s.geometry_bytes, total);
    draw_bytes("scene trees", s.structures_bytes, total);
    draw_bytes("maps", s.displacement_bytes, total);
    draw_bytes("patch trees", s.bottom_cache_bytes, total);
    draw_bytes("rays", s.ray_buffers_bytes, total);
}

} // namespace relief::viewer
