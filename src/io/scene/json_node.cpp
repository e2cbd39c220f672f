#include "io/scene/json_node.h"

#include <algorithm>
#include <cmath>
#include <unordered_set>

#include <fmt/format.h>

#include "base/suggest.h"
#include "base/text_reading.h"

namespace relief {

namespace {

std::string describe_place(std::string_view text, const std::string& file, size_t byte) {
    const TextPlace place = find_place(text, byte);
    return fmt::format("{}, line {}, column {}", file, place.line, place.column);
}

void refuse_deep_nesting(std::string_view text, const std::string& file) {
    if (const std::optional<size_t> byte = find_deep_nesting(text))
        throw Error(ErrorKind::bad_input,
                    {fmt::format("arrays and objects are nested more than {} levels deep", kMostNesting),
                     describe_place(text, file, *byte), "write them less deep: the file is damaged"});
}

/// The part of the parser's message that says what is wrong, without its own error number and position.
std::string strip_parser_prefix(std::string message) {
    for (const std::string_view mark : {"] ", ": "}) {
        const size_t at = message.find(mark);
        if (at != std::string::npos) message.erase(0, at + mark.size());
    }
    return message;
}

/// Builds a document in linear time, unlike the parser's own builder; remembers the first double key.
class DocumentBuilder {
  public:
    explicit DocumentBuilder(Json& document) : document_(document) {}

    bool null() { return add(nullptr); }
    bool boolean(bool value) { return add(value); }
    bool number_integer(Json::number_integer_t value) { return add(value); }
    bool number_unsigned(Json::number_unsigned_t value) { return add(value); }
    bool number_float(Json::number_float_t value, const std::string&) { return add(value); }
    bool string(std::string& value) { return add(std::move(value)); }
    bool binary(Json::binary_t& value) { return add(std::move(value)); }
    bool start_array(size_t) { return open(Json::array()); }
    bool end_array() { return close(); }
    bool start_object(size_t) {
        keys_.emplace_back();
        return open(Json::object());
    }
    bool end_object() {
        keys_.pop_back();
        return close();
    }
    bool key(std::string& name) {
        if (!keys_.back().insert(name).second && duplicate_.empty()) duplicate_ = name;
        auto& members = open_.back()->get_ref<Json::object_t&>();
        static_cast<Json::object_t::Container&>(members).emplace_back(std::move(name), nullptr);
        return true;
    }
    template <class Failure> [[noreturn]] bool parse_error(size_t, const std::string&, const Failure& error) {
        throw error;
    }
    const std::string& duplicate() const { return duplicate_; }

  private:
    /// The value goes to the last key of the open object, to the end of the open array, or is the document.
    template <class Value> Json& place(Value&& value) {
        if (open_.empty()) return document_ = std::forward<Value>(value);
        if (open_.back()->is_object())
            return open_.back()->get_ref<Json::object_t&>().back().second = std::forward<Value>(value);
        return open_.back()->get_ref<Json::array_t&>().emplace_back(std::forward<Value>(value));
    }
    template <class Value> bool add(Value&& value) {
        place(std::forward<Value>(value));
        return true;
    }
    bool open(Json value) {
        open_.push_back(&place(std::move(value)));
        return true;
    }
    bool close() {
        open_.pop_back();
        return true;
    }

    Json& document_;
    std::vector<Json*> open_; ///< stay where they are: only the innermost one grows
    std::vector<std::unordered_set<std::string>> keys_;
    std::string duplicate_;
};

/// By what the parser has met in place of what.
std::string hint_at_syntax(std::string_view error) {
    const auto has = [&](std::string_view part) { return error.find(part) != std::string_view::npos; };
    if (has("unexpected end of input")) return "it ends too early: is a bracket not closed?";
    if (has("expected ':'")) return "a colon is missing before it";
    if (has("unexpected ']'") || has("unexpected '}'"))
        return "a comma too many before it, or another bracket";
    if (has("; expected string literal")) return "a comma too many before it, or a key without quotes";
    const bool is_value = has("literal; expected") || has("unexpected '{'") || has("unexpected '['");
    if (is_value && (has("expected ']'") || has("expected '}'"))) return "a comma may be missing before it";
    return "";
}

std::string describe_type(const Json& value) {
    return (value.is_array() || value.is_object() ? "an "
            : value.is_null()                     ? ""
                                                  : "a ") +
           std::string(value.type_name());
}

} // namespace

Json parse_json(std::string_view text, const std::string& file) {
    if (is_wide_text(text)) throw Error(ErrorKind::bad_input, {kWideText, file, kWideTextHint});
    text = skip_byte_order_mark(text);
    refuse_deep_nesting(text, file);
    Json document;
    DocumentBuilder builder(document);
    try {
        Json::sax_parse(text.begin(), text.end(), &builder, Json::input_format_t::json, true, true);
    } catch (const Json::parse_error& error) {
        // The parser counts the byte that it could not accept, starting from 1.
        throw Error(ErrorKind::bad_input, {"broken JSON: " + strip_parser_prefix(error.what()),
                                           describe_place(text, file, error.byte > 0 ? error.byte - 1 : 0),
                                           hint_at_syntax(error.what())});
    } catch (const Json::exception& error) {
        throw Error(ErrorKind::bad_input, {"broken JSON: " + strip_parser_prefix(error.what()), file, ""});
    }
    if (!builder.duplicate().empty()) {
        throw Error(ErrorKind::bad_input,
                    {fmt::format("key '{}' stands twice in one object", builder.duplicate()), file,
                     "give every material, mesh and map a name of its own"});
    }
    return document;
}

void JsonNode::fail(const std::string& message, const std::string& hint) const {
    throw Error(ErrorKind::bad_input, {message, place(), hint});
}

void JsonNode::fail_type(const std::string& wanted) const {
    fail(fmt::format("must be {}, not {}", wanted, describe_type(*value_)));
}

void JsonNode::rethrow_with_place(const Error& error) const {
    const std::string message =
        error.where().empty() ? error.message() : error.where() + ": " + error.message();
    throw Error(error.kind(), {message, place(), error.hint()});
}

void JsonNode::check_keys(std::span<const std::string_view> keys) const {
    if (!value_->is_object()) fail_type("an object");
    for (const auto& item : value_->items()) {
        if (std::find(keys.begin(), keys.end(), item.key()) != keys.end()) continue;
        const std::string inside = path_.empty() ? std::string() : " in " + path_;
        throw Error(ErrorKind::bad_input, {fmt::format("unknown key '{}'{}", item.key(), inside), *file_,
                                           suggest_word(item.key(), keys)});
    }
}

std::optional<JsonNode> JsonNode::find(std::string_view key) const {
    if (!value_->is_object()) fail_type("an object");
    const auto found = value_->find(std::string(key));
    if (found == value_->end()) return std::nullopt;
    return JsonNode(*found, path_.empty() ? std::string(key) : path_ + "." + std::string(key), *file_);
}

JsonNode JsonNode::get(std::string_view key) const {
    const std::optional<JsonNode> node = find(key);
    if (!node) fail(fmt::format("key '{}' is missing", key));
    return *node;
}

std::vector<std::pair<std::string, JsonNode>> JsonNode::members() const {
    if (!value_->is_object()) fail_type("an object");
    std::vector<std::pair<std::string, JsonNode>> result;
    for (const auto& item : value_->items())
        result.emplace_back(item.key(), JsonNode(item.value(), path_ + "." + item.key(), *file_));
    return result;
}

std::vector<JsonNode> JsonNode::elements() const {
    if (!value_->is_array()) fail_type("an array");
    std::vector<JsonNode> result;
    for (size_t i = 0; i < value_->size(); ++i)
        result.emplace_back((*value_)[i], fmt::format("{}[{}]", path_, i), *file_);
    return result;
}

float JsonNode::as_float(double low, double high) const {
    if (!value_->is_number()) fail_type("a number");
    const double number = value_->get<double>();
    if (!(number >= low && number <= high)) {
        if (low <= -double(FLT_MAX)) fail(fmt::format("{} is too large", number));
        const std::string range =
            high >= double(FLT_MAX) ? fmt::format("at least {}", low) : fmt::format("in [{}, {}]", low, high);
        fail(fmt::format("must be {}, not {}", range, number));
    }
    return float(number);
}

int64_t JsonNode::as_integer(int64_t low, int64_t high) const {
    if (!value_->is_number()) fail_type("an integer");
    const double number = value_->get<double>();
    if (number != std::floor(number)) fail(fmt::format("must be an integer, not {}", number));
    if (!(number >= double(low) && number <= double(high)))
        fail(fmt::format("must be in [{}, {}], not {}", low, high, number));
    return int64_t(number);
}

bool JsonNode::as_bool() const {
    if (!value_->is_boolean()) fail_type("true or false");
    return value_->get<bool>();
}

std::string JsonNode::as_string() const {
    if (!value_->is_string()) fail_type("a text");
    return value_->get<std::string>();
}

/// Of so many numbers, each an element.
std::vector<JsonNode> JsonNode::numbers(size_t count) const {
    if (!value_->is_array()) fail_type(fmt::format("an array of {} numbers", count));
    if (value_->size() != count) fail(fmt::format("must be {} numbers, not {}", count, value_->size()));
    return elements();
}

Vec2f JsonNode::as_vec2(double low, double high) const {
    const std::vector<JsonNode> parts = numbers(2);
    return {parts[0].as_float(low, high), parts[1].as_float(low, high)};
}

Vec3f JsonNode::as_vec3(double low, double high) const {
    const std::vector<JsonNode> parts = numbers(3);
    return {parts[0].as_float(low, high), parts[1].as_float(low, high), parts[2].as_float(low, high)};
}

Vec3f JsonNode::as_vec3_or_number() const {
    if (is_array()) return as_vec3();
    if (!value_->is_number()) fail_type("a number or an array of 3 numbers");
    const float number = as_float();
    return {number, number, number};
}

} // namespace relief
