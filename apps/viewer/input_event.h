// What a user does, whoever tells it: the window, a script, a test, a browser.
#pragma once

#include <filesystem>
#include <vector>

namespace relief::viewer {

enum class MouseButton { left, middle, right };

struct Modifiers {
    bool shift = false, control = false, alt = false;
    friend bool operator==(const Modifiers&, const Modifiers&) = default;
};

/// Keys are the letters and signs on them in upper case of ASCII, or one of these. `kModifier`: shift,
/// control or alt, which one by the modifiers of its event.
enum Key : int { kEscape = 256, kEnter, kF1, kF12, kLeft, kRight, kUp, kDown, kHome, kModifier };

struct InputEvent {
    enum class Kind { move, press, release, scroll, key_down, key_up, drop };
    Kind kind = Kind::move;
    float x = 0, y = 0; ///< pixels of the window, from its top left
    MouseButton button = MouseButton::left;
    Modifiers modifiers;
    int key = 0;
    bool is_repeat = false;                   ///< of a key that is held
    float amount = 0;                         ///< of scrolling, away from the user
    std::vector<std::filesystem::path> files; ///< dropped ones
};

} // namespace relief::viewer
