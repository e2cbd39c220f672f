#include "viewer/event_script.h"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "base/suggest.h"
#include "base/text_reading.h"
#include "common/values.h"
#include "relief/error.h"

namespace relief::viewer {

namespace {

[[noreturn]] void refuse(std::string message, std::string hint = {}) {
    throw Error(ErrorKind::bad_input, {std::move(message), "", std::move(hint)});
}

template <size_t N> void check_keys(const Value& line, const std::array<std::string_view, N>& keys) {
    for (const Member& member : line.members())
        if (std::find(keys.begin(), keys.end(), member.name) == keys.end())
            refuse(fmt::format("unknown key '{}'", member.name), suggest_word(member.name, keys));
}

Vec2f read_point(const Value& value) {
    if (value.kind() != Value::Kind::list || value.size() != 2) refuse("a place is [x, y]");
    return {value[0].get<float>(), value[1].get<float>()};
}

MouseButton read_button(const std::string& text) {
    constexpr std::array<std::pair<std::string_view, MouseButton>, 3> kWords{
        {{"left", MouseButton::left}, {"middle", MouseButton::middle}, {"right", MouseButton::right}}};
    return cli::parse_word("button", text, kWords);
}

Modifiers read_modifiers(const Value& line) {
    Modifiers modifiers;
    if (!line.contains("modifiers")) return modifiers;
    for (const Value& word : line["modifiers"]) {
        constexpr std::array<std::pair<std::string_view, bool Modifiers::*>, 3> kWords{
            {{"shift", &Modifiers::shift}, {"control", &Modifiers::control}, {"alt", &Modifiers::alt}}};
        modifiers.*cli::parse_word("modifiers", word.get<std::string>(), kWords) = true;
    }
    return modifiers;
}

int read_key(const std::string& text) {
    if (text.size() == 1) return text[0] >= 'a' && text[0] <= 'z' ? text[0] - 'a' + 'A' : text[0];
    constexpr std::array<std::pair<std::string_view, int>, 10> kWords{{{"escape", kEscape},
                                                                       {"enter", kEnter},
                                                                       {"f1", kF1},
                                                                       {"f12", kF12},
                                                                       {"left", kLeft},
                                                                       {"right", kRight},
                                                                       {"up", kUp},
                                                                       {"down", kDown},
                                                                       {"home", kHome},
                                                                       {"space", ' '}}};
    return cli::parse_word("key", text, kWords);
}

double check_seconds(double seconds) {
    if (!(seconds >= 0 && seconds <= 3600)) refuse("seconds are from 0 to 3600");
    return seconds;
}

ScriptStep read_wait(const Value& line) {
    check_keys(line, std::array<std::string_view, 1>{"wait"});
    const Value& what = line["wait"];
    if (what.kind() != Value::Kind::text)
        return WaitStep{WaitStep::For::seconds, check_seconds(what.get<double>())};
    constexpr std::array<std::pair<std::string_view, WaitStep::For>, 2> kWords{
        {{"picture", WaitStep::For::shown}, {"done", WaitStep::For::done}}};
    return WaitStep{cli::parse_word("wait", what.get<std::string>(), kWords), 0};
}

ScriptStep read_drag(const Value& line) {
    check_keys(line, std::array<std::string_view, 5>{"drag", "from", "to", "seconds", "modifiers"});
    DragStep drag;
    drag.button = read_button(line["drag"].get<std::string>());
    drag.modifiers = read_modifiers(line);
    drag.from = read_point(line["from"]);
    drag.to = read_point(line["to"]);
    if (line.contains("seconds")) drag.seconds = check_seconds(line["seconds"].get<double>());
    return drag;
}

ScriptStep read_mouse(const Value& line, const char* key, InputEvent::Kind kind) {
    check_keys(line, std::array<std::string_view, 3>{key, "at", "modifiers"});
    InputEvent event;
    event.kind = kind;
    event.modifiers = read_modifiers(line);
    if (kind == InputEvent::Kind::scroll)
        event.amount = line[key].get<float>();
    else
        event.button = read_button(line[key].get<std::string>());
    const Vec2f at = read_point(line["at"]);
    event.x = at.x, event.y = at.y;
    return EventStep{event};
}

ScriptStep read_key_step(const Value& line) {
    check_keys(line, std::array<std::string_view, 2>{"key", "modifiers"});
    InputEvent event;
    event.kind = InputEvent::Kind::key_down;
    event.key = read_key(line["key"].get<std::string>());
    event.modifiers = read_modifiers(line);
    return EventStep{event};
}

ScriptStep read_file(const Value& line, const char* key, FileStep::Kind kind) {
    const char* const more = kind == FileStep::Kind::open       ? "vdm"
                             : kind == FileStep::Kind::drop     ? "vdm"
                             : kind == FileStep::Kind::save_map ? "preset"
                                                                : key;
    check_keys(line, std::array<std::string_view, 2>{key, more});
    return FileStep{kind, line[key].get<std::string>(), line.text_or_empty("vdm"),
                    line.text_or_empty("preset")};
}

ScriptStep read_step(const Value& line) {
    using Kind = InputEvent::Kind;
    using File = FileStep::Kind;
    if (line.contains("wait")) return read_wait(line);
    if (line.contains("drag")) return read_drag(line);
    if (line.contains("press")) return read_mouse(line, "press", Kind::press);
    if (line.contains("release")) return read_mouse(line, "release", Kind::release);
    if (line.contains("scroll")) return read_mouse(line, "scroll", Kind::scroll);
    if (line.contains("key")) return read_key_step(line);
    if (line.contains("set")) {
        check_keys(line, std::array<std::string_view, 1>{"set"});
        if (line["set"].kind() != Value::Kind::record) refuse("set takes a record");
        return SetStep{line["set"]};
    }
    if (line.contains("frame")) {
        check_keys(line, std::array<std::string_view, 1>{"frame"});
        return FrameStep{line["frame"].get<int>()};
    }
    if (line.contains("play")) {
        check_keys(line, std::array<std::string_view, 1>{"play"});
        return PlayStep{check_seconds(line["play"].get<double>())};
    }
    if (line.contains("quit")) {
        check_keys(line, std::array<std::string_view, 1>{"quit"});
        return QuitStep{};
    }
    constexpr std::array<std::pair<const char*, File>, 6> kFiles{{{"open", File::open},
                                                                  {"drop", File::drop},
                                                                  {"screenshot", File::screenshot},
                                                                  {"picture", File::picture},
                                                                  {"save", File::save},
                                                                  {"save_map", File::save_map}}};
    for (const auto& [key, kind] : kFiles)
        if (line.contains(key)) return read_file(line, key, kind);
    refuse("a line says one of: wait, drag, press, release, scroll, key, set, frame, play, open, drop, "
           "screenshot, picture, save, save_map, quit");
}

} // namespace

std::vector<ScriptLine> read_script(std::istream& lines, const std::string& source) {
    const auto check = [&](bool is_read) {
        if (!is_read) throw Error(ErrorKind::bad_input, {"the script cannot be read", source, ""});
    };
    check(lines.good());
    std::vector<ScriptLine> script;
    std::string text;
    for (size_t number = 1; read_line(lines, text); ++number) {
        const size_t start = text.find_first_not_of(" \t\r");
        if (start == std::string::npos || text.compare(start, 2, "//") == 0) continue;
        try {
            const Value line = read_json(text);
            if (line.kind() != Value::Kind::record) refuse("a line is one JSON object");
            script.push_back({number, read_step(line)});
        } catch (const Error& error) {
            throw Error(ErrorKind::bad_input,
                        {error.message(), fmt::format("{}:{}", source, number), error.hint()});
        }
    }
    check(!lines.bad());
    return script;
}

} // namespace relief::viewer
