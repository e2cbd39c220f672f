#include "io/mesh/fbx_document.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <system_error>
#include <type_traits>
#include <utility>

#include <assimp/fast_atof.h>
#include <fmt/format.h>

#include "base/text_reading.h"

namespace relief {

namespace {

template <class Record> Record* find_child(Record& record, std::string_view name) {
    const auto found = std::ranges::find(record.children, name, &FbxRecord::name);
    return found == record.children.end() ? nullptr : &*found;
}

template <class T> T load(std::string_view bytes, size_t place) {
    T value{};
    if (bytes.size() >= place + sizeof(T)) std::memcpy(&value, bytes.data() + place, sizeof(T));
    return value;
}

template <class T> std::optional<T> parse_number(std::string_view text) {
    if (text.starts_with('+')) text.remove_prefix(1);
    T value{};
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (code != std::errc() || end != text.data() + text.size()) return {};
    return value;
}

/// Calls `visit` for all words between commas and white space.
template <class Visit> void visit_words(std::string_view list, const Visit& visit) {
    constexpr std::string_view kBetween = ", \t\r\n";
    for (size_t at = list.find_first_not_of(kBetween); at < list.size();) {
        const size_t end = std::min(list.find_first_of(kBetween, at), list.size());
        visit(list.substr(at, end - at));
        at = list.find_first_not_of(kBetween, end);
    }
}

/// Assimp's number parser takes the exception to throw as a parameter. Its usual one is not exported.
struct NoNumber {
    template <class... Words> explicit NoNumber(const Words&...) {}
};

/// Rounds a number as the importer does: the numbers of both must be equal.
float narrow(std::string_view word) {
    constexpr size_t kMostDigits = 31;
    const std::string digits(word.substr(0, kMostDigits));
    float value = 0;
    try {
        Assimp::fast_atoreal_move<float, NoNumber>(digits.c_str(), value);
    } catch (const NoNumber&) {
        value = NAN;
    }
    return value;
}

template <class From, class To> void convert(std::string_view bytes, std::vector<To>& values) {
    values.reserve(bytes.size() / sizeof(From));
    for (size_t at = 0; at + sizeof(From) <= bytes.size(); at += sizeof(From))
        values.push_back(To(load<From>(bytes, at)));
}

template <class To> std::vector<To> read_binary_array(std::string_view value) {
    std::vector<To> values;
    const std::optional<std::string> bytes = inflate_fbx_array(value);
    if (!bytes) return values;
    if constexpr (std::is_floating_point_v<To>) {
        if (value[0] == 'd') convert<double>(*bytes, values);
        if (value[0] == 'f') convert<float>(*bytes, values);
    }
    if (value[0] == 'i') convert<int32_t>(*bytes, values);
    if (value[0] == 'l') convert<int64_t>(*bytes, values);
    return values;
}

} // namespace

const FbxRecord* FbxRecord::find(std::string_view child) const { return find_child(*this, child); }
FbxRecord* FbxRecord::find(std::string_view child) { return find_child(*this, child); }

std::optional<FbxDocument> FbxDocument::parse(std::string_view bytes) {
    std::optional<FbxDocument> document(std::in_place);
    const bool is_whole = bytes.starts_with(kFbxMagic)
                              ? parse_fbx_binary(bytes, *document)
                              : parse_fbx_text(skip_byte_order_mark(bytes), *document);
    if (!is_whole) document.reset();
    return document;
}

uint32_t FbxDocument::get_version() const {
    if (const FbxRecord* head = root_.find("FBXHeaderExtension"))
        if (const FbxRecord* version = head->find("FBXVersion"); version && !version->values.empty())
            if (const auto number = read_number(version->values[0]); number && *number >= 0 && *number < 1e6)
                return uint32_t(*number);
    return head_version_;
}

std::string_view FbxDocument::read_text(std::string_view value) const {
    if (is_binary_) return value.starts_with('S') && value.size() >= 5 ? value.substr(5) : "";
    return value.size() >= 2 && value.starts_with('"') ? value.substr(1, value.size() - 2) : value;
}

std::string_view FbxDocument::read_name(std::string_view value) const {
    const std::string_view text = read_text(value);
    if (is_binary_) return text.substr(0, text.find('\0'));
    const size_t colons = text.find("::");
    return colons == std::string_view::npos ? text : text.substr(colons + 2);
}

std::optional<double> FbxDocument::read_number(std::string_view value) const {
    if (!is_binary_) return parse_number<double>(value);
    switch (value.empty() ? '\0' : value[0]) {
    case 'D':
        return load<double>(value, 1);
    case 'F':
        return double(load<float>(value, 1));
    case 'I':
        return double(load<int32_t>(value, 1));
    case 'L':
        return double(load<int64_t>(value, 1));
    case 'Y':
        return double(load<int16_t>(value, 1));
    case 'B':
    case 'C':
        return double(load<int8_t>(value, 1));
    default:
        return {};
    }
}

std::optional<int64_t> FbxDocument::read_id(std::string_view value) const {
    if (!is_binary_) return parse_number<int64_t>(value);
    if (value.starts_with('L')) return load<int64_t>(value, 1);
    if (value.starts_with('I')) return load<int32_t>(value, 1);
    return {};
}

std::vector<float> FbxDocument::read_floats(const FbxRecord& array) const {
    if (is_binary_)
        return array.values.empty() ? std::vector<float>() : read_binary_array<float>(array.values[0]);
    std::vector<float> values;
    if (const FbxRecord* list = array.find("a"); list && !list->values.empty())
        visit_words(list->values[0], [&](std::string_view word) { values.push_back(narrow(word)); });
    return values;
}

std::vector<int64_t> FbxDocument::read_integers(const FbxRecord& array) const {
    if (is_binary_)
        return array.values.empty() ? std::vector<int64_t>() : read_binary_array<int64_t>(array.values[0]);
    std::vector<int64_t> values;
    if (const FbxRecord* list = array.find("a"); list && !list->values.empty())
        visit_words(list->values[0], [&](std::string_view word) {
            values.push_back(parse_number<int64_t>(word).value_or(INT64_MIN));
        });
    return values;
}

void FbxDocument::clear_number(std::string_view& value) {
    if (!is_binary_)
        value = "0";
    else if (!value.empty())
        value = keep(value[0] + std::string(value.size() - 1, '\0'));
}

void FbxDocument::set_floats(FbxRecord& parent, std::string_view array, std::span<const float> values) {
    FbxRecord* record = parent.find(array);
    if (!record) record = &parent.children.emplace_back();
    *record = {array, {}, {}, false};
    if (is_binary_) {
        record->values.push_back(keep(pack_fbx_floats(values)));
        return;
    }
    std::string list;
    for (const float value : values) list += fmt::format("{}{}", list.empty() ? "" : ",", value);
    record->values.push_back(keep(fmt::format("*{}", values.size())));
    record->has_scope = true;
    record->children.push_back({"a", {keep(std::move(list))}, {}, false});
}

void FbxDocument::rename(std::string_view& value, const std::string& name) {
    const std::string_view text = read_text(value);
    if (!is_binary_) {
        const size_t colons = text.find("::");
        const std::string_view prefix = colons == std::string_view::npos ? "" : text.substr(0, colons + 2);
        value = keep('"' + std::string(prefix) + name + '"');
        return;
    }
    const std::string renamed = name + std::string(text.substr(std::min(text.find('\0'), text.size())));
    std::string bytes = "S";
    for (size_t k = 0; k < 4; ++k) bytes += char(renamed.size() >> (8 * k));
    value = keep(bytes + renamed);
}

std::string FbxDocument::write() const {
    return is_binary_ ? write_fbx_binary(root_) : write_fbx_text(root_);
}

} // namespace relief
