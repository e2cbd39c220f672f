#include "edit_stream.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <limits>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "base/suggest.h"
#include "base/text_reading.h"
#include "common/report.h"
#include "relief/error.h"
#include "relief/io.h"

namespace relief::cli {

namespace {

constexpr std::array<std::string_view, 5> kKeys = {"displacement", "tile", "at", "texels", "output"};
constexpr const char* kForm = R"(write {"at": [column, row], "texels": "part.exr", "output": "next.exr"})";

[[noreturn]] void refuse(std::string message, std::string hint) {
    throw Error(ErrorKind::bad_input, {std::move(message), "", std::move(hint)});
}

Value read_object(const std::string& text) {
    Value json;
    try {
        json = read_json(text);
    } catch (const Error& error) {
        refuse(error.hint().empty() ? "this is no JSON" : error.message(), kForm);
    }
    if (json.kind() != Value::Kind::record) refuse("an edit is one JSON object a line", kForm);
    for (const Member& member : json.members())
        if (std::find(kKeys.begin(), kKeys.end(), member.name) == kKeys.end())
            refuse(fmt::format("unknown key '{}'", member.name), suggest_word(member.name, kKeys));
    return json;
}

uint32_t get_whole_number(const Value& value, const char* key) {
    if (value.kind() != Value::Kind::integer || value < 0 || value > std::numeric_limits<int32_t>::max())
        refuse(fmt::format("'{}' must be whole and not negative", key), kForm);
    return value.get<uint32_t>();
}

std::string get_text(const Value& json, const char* key) {
    if (!json.contains(key) || json[key].kind() != Value::Kind::text)
        refuse(fmt::format("'{}' must be a text", key), kForm);
    return json[key].get<std::string>();
}

} // namespace

EditStream::EditStream(std::istream& lines, std::string source, std::string only_displacement)
    : lines_(lines), source_(std::move(source)), only_displacement_(std::move(only_displacement)) {}

std::optional<EditLine> EditStream::next() {
    std::string text;
    do {
        if (!read_line(lines_, text)) return std::nullopt;
        ++line_;
    } while (text.find_first_not_of(" \t\r") == std::string::npos);
    using Clock = std::chrono::steady_clock;
    const Clock::time_point start = Clock::now();
    std::optional<EditLine> line;
    with_place([&] { line = parse(text); });
    line->read_s = std::chrono::duration<double>(Clock::now() - start).count();
    return line;
}

EditLine EditStream::parse(const std::string& text) const {
    const Value json = read_object(text);
    EditLine line;
    line.edit.displacement =
        json.contains("displacement") ? get_text(json, "displacement") : only_displacement_;
    if (line.edit.displacement.empty())
        refuse("'displacement' is missing", "the scene has none or several: name one");
    if (json.contains("tile")) line.edit.udim = int(get_whole_number(json["tile"], "tile"));
    if (!json.contains("at") || json["at"].kind() != Value::Kind::list || json["at"].size() != 2)
        refuse("'at' must be two numbers, column and row", kForm);
    line.edit.x = get_whole_number(json["at"][0], "at"), line.edit.y = get_whole_number(json["at"][1], "at");
    line.edit.texels = read_texture(get_text(json, "texels"));
    if (json.contains("output")) {
        line.output = get_text(json, "output");
        check_writable(line.output);
    }
    return line;
}

std::string EditStream::get_place(const std::string& detail) const {
    return fmt::format("{}, line {}{}{}", source_, line_, detail.empty() ? "" : ": ", detail);
}

} // namespace relief::cli
