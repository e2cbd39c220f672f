// What is seen in the window: the picture, the panels, a line of state; and the loop that keeps it going.
#pragma once

#include <cstdint>
#include <filesystem>
#include <future>
#include <memory>
#include <optional>
#include <utility>

#include "viewer/panels.h"
#include "viewer/script_runner.h"
#include "viewer/window.h"

struct ImDrawList;

namespace relief::viewer {

class Interface {
  public:
    /// `fixed_size`: of the picture; nothing: it fills what the panels leave.
    Interface(Window& window, Workbench& workbench, std::optional<std::pair<int, int>> fixed_size);

    /// Until the user, the script or a signal ends it. `script` may be null. `start`: of the clock that
    /// steady_clock is.
    void run(ScriptRunner* script, double start);
    ViewSettings& view() { return state_.view; }

    /// Pixels beside and below the picture, at a content scale of 1.
    static constexpr int kPanelWidth = 340, kLineHeight = 26, kTimelineHeight = 32;

  private:
    void place_picture();
    void refresh_texture();
    void draw();
    void draw_picture();
    void draw_paths(ImDrawList& list);
    void draw_panels();
    void draw_timeline_strip();
    void draw_line();
    void draw_explanation();
    void poll_display();
    bool settle(EndAnswer answer, const std::filesystem::path& file);
    std::filesystem::path find_scene_file() const;
    void ask_at_end();
    void ask_to_open();
    bool has_ended();

    Window& window_;
    Workbench& workbench_;
    std::optional<std::pair<int, int>> fixed_size_;
    PanelState state_;
    ViewArea area_;
    std::shared_ptr<const ShownPicture> texture_picture_;
    ViewSettings texture_view_;
    bool needs_texture_ = true;
    bool is_asking_ = false, may_end_ = false; ///< at the end, what becomes of changes
    DisplayTable display_;
    std::future<DisplayTable> next_display_; ///< being made
};

} // namespace relief::viewer
