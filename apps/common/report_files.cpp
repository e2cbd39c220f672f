// The only file of the programs that uses a JSON library.
#include <iterator>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/text_reading.h"
#include "common/report.h"
#include "relief/error.h"

namespace relief {

using Json = nlohmann::ordered_json;

namespace {

using Kind = Value::Kind;

Json make_json(const Value& value) {
    switch (value.kind()) {
    case Kind::nothing:
        return nullptr;
    case Kind::truth:
        return value.get<bool>();
    case Kind::integer:
        return value.get<int64_t>();
    case Kind::real:
        return value.get<double>();
    case Kind::text:
        return value.get<std::string>();
    case Kind::list:
        break;
    case Kind::record:
        Json record = Json::object();
        for (const Member& member : value.members()) record[member.name] = make_json(member.value);
        return record;
    }
    Json list = Json::array();
    for (const Value& entry : value) list.push_back(make_json(entry));
    return list;
}

Value make_value(const Json& json) {
    if (json.is_object()) {
        Value result = Value::record();
        for (const auto& [name, entry] : json.items()) result[name] = make_value(entry);
        return result;
    }
    if (json.is_array()) {
        Value result = Value::list();
        for (const Json& entry : json) result.push_back(make_value(entry));
        return result;
    }
    if (json.is_string()) return json.get<std::string>();
    if (json.is_boolean()) return json.get<bool>();
    if (json.is_number_integer()) return json.get<int64_t>();
    if (json.is_number()) return json.get<double>();
    return {};
}

std::string quote(const std::string& text) {
    if (text.find_first_of(",\"\n") == text.npos) return text;
    std::string quoted = "\"";
    for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
    return quoted + "\"";
}

std::string make_cell(const Value& value) {
    switch (value.kind()) {
    case Kind::nothing:
        return {};
    case Kind::integer:
        return fmt::format("{}", value.get<int64_t>());
    case Kind::real:
        return fmt::format("{}", value.get<double>());
    case Kind::text:
        return quote(value.get<std::string>());
    default:
        throw Error(ErrorKind::failed, {"a cell is a text or a number", "table", ""});
    }
}

} // namespace

std::string write_json(const Value& value, std::optional<int> indent) {
    const Json json = make_json(value);
    return indent ? json.dump(*indent) + "\n" : json.dump();
}

Value read_json(const std::string& text) {
    if (is_wide_text(text)) throw Error(ErrorKind::bad_input, {kWideText, "JSON", kWideTextHint});
    if (find_deep_nesting(text))
        throw Error(ErrorKind::bad_input,
                    {fmt::format("arrays and objects are nested more than {} levels deep", kMostNesting),
                     "JSON", "write them less deep"});
    try {
        return make_value(Json::parse(skip_byte_order_mark(text)));
    } catch (const Json::exception& failure) {
        throw Error(ErrorKind::bad_input, {failure.what(), "JSON", ""});
    }
}

std::string write_csv(const Table& table) {
    std::string text = fmt::format("{}\n", fmt::join(table.columns, ","));
    for (const std::vector<Value>& row : table.rows) {
        std::vector<std::string> cells;
        for (const Value& cell : row) cells.push_back(make_cell(cell));
        text += fmt::format("{}\n", fmt::join(cells, ","));
    }
    return text;
}

} // namespace relief
