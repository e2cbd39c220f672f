// Carries out a script in the window that is open, and prints how long things took: one JSON object a line.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "viewer/event_script.h"

namespace relief::viewer {

class ScriptRunner {
  public:
    /// What a script asks of the window.
    struct Host {
        std::function<void(const InputEvent&)> send; ///< an event, as if a user had made it
        std::function<void(const std::filesystem::path&)> take_screenshot; ///< of what is drawn next
        std::function<void(const std::string&)> print;
    };

    ScriptRunner(std::vector<ScriptLine> lines, std::string source, Workbench& workbench, ViewSettings& view,
                 Host host);

    /// Goes on as far as it can; `now` as of Workbench::update. Called after each update. Throws Error with
    /// the line where a step fails, and where it takes ten minutes longer than it says.
    void step(double now);
    bool is_done() const { return next_ == lines_.size(); }
    bool wants_to_end() const { return wants_to_end_; }

  private:
    /// True when the step is done.
    bool run(const WaitStep& wait, double now);
    bool run(const EventStep& step, double now);
    bool run(const DragStep& drag, double now);
    bool run(const SetStep& step, double now);
    bool run(const FileStep& step, double now);
    bool run(const FrameStep& step, double now);
    bool run(const PlayStep& step, double now);
    bool run(const QuitStep& step, double now);
    void print_step(const char* step, Value more);
    void send_mouse(const DragStep& drag, InputEvent::Kind kind, float share);

    std::vector<ScriptLine> lines_;
    std::string source_;
    Workbench& workbench_;
    ViewSettings& view_;
    Host host_;
    size_t next_ = 0;
    bool has_started_ = false, wants_to_end_ = false, has_printed_first_ = false;
    double start_ = 0, change_ = 0; ///< of this step; of the last event or change
    uint64_t pictures_before_ = 0;
    std::set<int> played_; ///< frames of this step
};

} // namespace relief::viewer
