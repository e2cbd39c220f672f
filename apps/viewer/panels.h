// The panels beside the picture. Each shows a part of the workbench and changes it by the workbench alone.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

#include "viewer/workbench.h"

namespace relief::viewer {

/// What the interface itself keeps.
struct PanelState {
    ViewSettings view;
    std::string display = kDisplayNames[0];
    bool is_display_changed = false;  ///< read and reset by whoever makes the table
    std::string scene_file, map_file; ///< names to save as
    std::string picture_file;         ///< empty: the suggested one
    std::filesystem::path input;      ///< what they belong to
    std::string map_preset;           ///< convention to save a map in; empty: its own
    size_t displacement = 0, material = 0, light = 0;
    /// Of the last renders, in a ring: millions of rays a second, and milliseconds.
    static constexpr size_t kHistory = 120;
    std::array<float, kHistory> rays{}, times{};
    size_t history_count = 0;
    uint64_t last_picture = 0;
};

/// Notes rays and times of renders; called once a frame.
void note_statistics(const RenderState& render, const ShownPicture* picture, PanelState& state);

void draw_file_panel(Workbench& workbench, PanelState& state);
void draw_object_panel(Workbench& workbench);
void draw_displacement_panel(Workbench& workbench, PanelState& state);
void draw_paint_panel(Workbench& workbench);
void draw_camera_panel(Workbench& workbench);
void draw_light_panel(Workbench& workbench, PanelState& state);
void draw_material_panel(Workbench& workbench, PanelState& state);
void draw_render_panel(Workbench& workbench);
void draw_view_panel(PanelState& state);
void draw_statistics_panel(const Workbench& workbench, const PanelState& state);

/// Of a scene with frames: to play, to step, to slide over them. In one line.
void draw_timeline(Workbench& workbench);

/// How far the picture is, and the last message: whole under the mouse, with those before on a click.
/// `indent`: where it begins.
void draw_state(Workbench& workbench, float indent);

/// In the middle of `area`, while nothing is open: what to do, or why a file could not be read.
void draw_empty_view(const Workbench& workbench, const ViewArea& area);

enum class EndAnswer { none, save, leave, stay };
/// Asks what becomes of changes when the viewer ends or opens another file. `file`: what they would be saved
/// as; `leave`: what is done without that.
EndAnswer draw_end_question(const std::string& file, const char* leave);

/// Keys, buttons and panels.
void draw_help(Workbench& workbench);

} // namespace relief::viewer
