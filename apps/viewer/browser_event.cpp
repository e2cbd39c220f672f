#include <algorithm>
#include <exception>
#include <iterator>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/report.h"
#include "viewer/browser_server.h"

namespace relief::viewer {

namespace {

/// Bytes of a message from outside; more is no event.
constexpr size_t kMostBytes = 1024;

bool is_true(const Value& event, const char* name) {
    return event.contains(name) && event[name].kind() == Value::Kind::truth && event[name].get<bool>();
}

std::vector<InputEvent> make_browser_event(const Value& event) {
    using Kind = InputEvent::Kind;
    constexpr std::pair<std::string_view, Kind> kKinds[] = {{"press", Kind::press},
                                                            {"move", Kind::move},
                                                            {"release", Kind::release},
                                                            {"scroll", Kind::scroll},
                                                            {"key", Kind::key_down}};
    constexpr std::pair<std::string_view, int> kKeys[] = {{"left", kLeft}, {"right", kRight},  {"up", kUp},
                                                          {"down", kDown}, {"+", '+'},         {"-", '-'},
                                                          {".", '.'},      {"escape", kEscape}};
    InputEvent made;
    const std::string name = event["kind"].get<std::string>();
    const auto* const kind = std::ranges::find(kKinds, name, &std::pair<std::string_view, Kind>::first);
    if (kind == std::end(kKinds)) return {};
    made.kind = kind->second;
    made.x = std::clamp(event["x"].get<float>(), -1.0f, 2.0f);
    made.y = std::clamp(event["y"].get<float>(), -1.0f, 2.0f);
    made.modifiers = {is_true(event, "shift"), is_true(event, "control"), is_true(event, "alt")};
    const int button = event["button"].get<int>();
    made.button = button == 1 ? MouseButton::middle : button == 2 ? MouseButton::right : MouseButton::left;
    if (made.kind == Kind::scroll) made.amount = std::clamp(event["amount"].get<float>(), -10.0f, 10.0f);
    if (made.kind != Kind::key_down) return {made};
    const auto* const key =
        std::ranges::find(kKeys, event["key"].get<std::string>(), &std::pair<std::string_view, int>::first);
    if (key == std::end(kKeys)) return {};
    made.key = key->second;
    made.is_repeat = is_true(event, "repeat");
    InputEvent released = made;
    released.kind = Kind::key_up;
    return {made, released};
}

} // namespace

std::vector<InputEvent> parse_browser_event(const std::string& text) {
    if (text.size() > kMostBytes) return {};
    try {
        return make_browser_event(read_json(text));
    } catch (const std::exception&) {
        return {};
    }
}

} // namespace relief::viewer
