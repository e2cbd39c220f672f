#include "common/report.h"

#include <algorithm>

#include <fmt/format.h>

#include "relief/error.h"

namespace relief {

namespace {

[[noreturn]] void throw_wrong_use(const std::string& message) {
    throw Error(ErrorKind::failed, {message, "report", ""});
}

} // namespace

Value::Value() = default;
Value::Value(const char* text) : Value(std::string(text)) {}
Value::Value(std::string text) : kind_(Kind::text), text_(std::move(text)) {}
Value::Value(std::string_view text) : Value(std::string(text)) {}
Value::Value(const Value& other) = default;
Value::Value(Value&& other) noexcept = default;
Value& Value::operator=(const Value& other) = default;
Value& Value::operator=(Value&& other) noexcept = default;
Value::~Value() = default;

Value::Value(std::initializer_list<Field> fields) : kind_(Kind::record) {
    for (const Field& field : fields) members_.push_back({field.name, field.value});
}

Value Value::record() { return Value(std::initializer_list<Field>()); }

Value Value::list() { return list({}); }

Value Value::list(std::initializer_list<Value> entries) {
    Value result;
    result.kind_ = Kind::list;
    result.entries_ = entries;
    return result;
}

bool Value::truth() const {
    if (kind_ != Kind::truth) throw_wrong_use("a truth value was expected");
    return integer_ != 0;
}

double Value::number() const {
    if (kind_ != Kind::integer && kind_ != Kind::real) throw_wrong_use("a number was expected");
    return kind_ == Kind::real ? real_ : double(integer_);
}

int64_t Value::integer() const { return kind_ == Kind::integer ? integer_ : int64_t(number()); }

const std::string& Value::text() const {
    if (kind_ != Kind::text) throw_wrong_use("a text was expected");
    return text_;
}

const std::vector<Member>& Value::members() const {
    if (kind_ != Kind::record && kind_ != Kind::nothing) throw_wrong_use("a record was expected");
    return members_;
}

const std::vector<Value>& Value::entries() const {
    if (kind_ != Kind::list && kind_ != Kind::nothing) throw_wrong_use("a list was expected");
    return entries_;
}

bool Value::contains(std::string_view name) const {
    return std::any_of(members().begin(), members().end(), [&](const Member& m) { return m.name == name; });
}

const Value& Value::operator[](std::string_view name) const {
    for (const Member& member : members())
        if (member.name == name) return member.value;
    throw_wrong_use(fmt::format("there is no '{}'", name));
}

Value& Value::operator[](std::string_view name) {
    if (!contains(name)) members_.push_back({std::string(name), {}});
    kind_ = Kind::record;
    return const_cast<Value&>(std::as_const(*this)[name]);
}

std::string Value::text_or_empty(std::string_view name) const {
    return contains(name) ? (*this)[name].text() : std::string();
}

void Value::update(const Value& record) {
    for (const Member& member : record.members()) (*this)[member.name] = member.value;
}

size_t Value::size() const { return kind_ == Kind::list ? entries_.size() : members().size(); }

const Value& Value::operator[](size_t index) const {
    if (index >= entries().size()) throw_wrong_use(fmt::format("there is no entry {}", index));
    return entries_[index];
}

Value& Value::operator[](size_t index) { return const_cast<Value&>(std::as_const(*this)[index]); }

void Value::push_back(Value entry) {
    if (kind_ != Kind::list && kind_ != Kind::nothing) throw_wrong_use("a list was expected");
    kind_ = Kind::list;
    entries_.push_back(std::move(entry));
}

} // namespace relief
