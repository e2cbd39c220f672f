// What a drag of the mouse does, as in other programs.
#pragma once

#include "viewer/input_event.h"

namespace relief::viewer {

enum class NavigationPreset { blender, maya };
/// `tool`: of the tool that is chosen, which is to turn where none is.
enum class DragAction { none, tool, focus, orbit, pan, dolly, look };

/// Blender: middle button turns, with shift moves, with control zooms. Maya: alt with the left, middle and
/// right button. In both the right button alone looks around, and control with the left one focuses.
inline DragAction choose_action(NavigationPreset preset, MouseButton button, const Modifiers& modifiers) {
    if (preset == NavigationPreset::maya && modifiers.alt) {
        if (button == MouseButton::left) return DragAction::orbit;
        return button == MouseButton::middle ? DragAction::pan : DragAction::dolly;
    }
    if (preset == NavigationPreset::blender && button == MouseButton::middle) {
        if (modifiers.shift) return DragAction::pan;
        return modifiers.control ? DragAction::dolly : DragAction::orbit;
    }
    if (button == MouseButton::right) return DragAction::look;
    if (button == MouseButton::middle) return DragAction::none;
    return modifiers.control ? DragAction::focus : DragAction::tool;
}

} // namespace relief::viewer
