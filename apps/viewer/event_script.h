// A session with the viewer as lines of JSON, for tests and demonstrations (docs/viewer.md lists them).
#pragma once

#include <cstddef>
#include <filesystem>
#include <istream>
#include <string>
#include <variant>
#include <vector>

#include "common/report.h"
#include "viewer/brush.h"
#include "viewer/input_event.h"
#include "viewer/workbench.h"

namespace relief::viewer {

/// `shown`: a picture of the newest state; `done`: one with all samples; `seconds`: of the clock.
struct WaitStep {
    enum class For { shown, done, seconds };
    For what = For::shown;
    double seconds = 0;
};

/// One event, at once.
struct EventStep {
    InputEvent event;
};

/// A button pressed, moved along a line for so long, and released. Pictures on the way are counted.
struct DragStep {
    MouseButton button = MouseButton::left;
    Modifiers modifiers;
    Vec2f from{}, to{}; ///< pixels of the window
    double seconds = 0.5;
};

/// A change of the document or of how it is seen, as by a panel.
struct SetStep {
    Value values; ///< a record
};

struct FileStep {
    enum class Kind { open, drop, screenshot, picture, save, save_map };
    Kind kind = Kind::open;
    std::filesystem::path file;
    std::filesystem::path map; ///< of an opened or dropped mesh
    std::string preset;        ///< of a saved map: empty: its own convention
};

/// Another frame, until it was read.
struct FrameStep {
    int frame = 1;
};

/// Plays for so long, from the frame that is shown.
struct PlayStep {
    double seconds = 1;
};

struct QuitStep {};

using ScriptStep =
    std::variant<WaitStep, EventStep, DragStep, SetStep, FileStep, FrameStep, PlayStep, QuitStep>;

/// A line with its number, for messages.
struct ScriptLine {
    size_t number = 0;
    ScriptStep step;
};

/// Reads all lines; empty ones, and those that begin with //, say nothing. Throws Error{bad_input} with
/// `source` and the line, and where nothing can be read.
std::vector<ScriptLine> read_script(std::istream& lines, const std::string& source);

/// Applies a SetStep. Throws Error{bad_input} for keys and values that mean nothing.
void apply_values(const Value& values, Workbench& workbench, ViewSettings& view);

} // namespace relief::viewer
