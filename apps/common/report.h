// Report values: a tree of named values and lists, or a table, written as JSON or CSV.
#pragma once

#include <array>
#include <compare>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace relief {

struct Field;
struct Member;

/// Null, boolean, number, string, list, or record: named values in insertion order. Misuse (a missing key, a
/// string taken as a number) throws Error{failed}.
class Value {
  public:
    enum class Kind { nothing, truth, integer, real, text, list, record };

    Value();
    Value(const char* text);
    Value(std::string text);
    Value(std::string_view text);
    template <class T>
    requires std::is_arithmetic_v<T> Value(T number)
        : kind_(std::same_as<T, bool>    ? Kind::truth
                : std::floating_point<T> ? Kind::real
                                         : Kind::integer),
          integer_(std::floating_point<T> ? 0 : int64_t(number)),
          real_(double(number)) {}
    template <class T> Value(const std::vector<T>& entries) : Value(list()) {
        for (const T& entry : entries) push_back(entry);
    }
    template <class T, size_t N> Value(const std::array<T, N>& entries) : Value(list()) {
        for (const T& entry : entries) push_back(entry);
    }
    /// A record.
    Value(std::initializer_list<Field> fields);
    static Value record();
    /// An empty list, and a list of these entries.
    static Value list();
    static Value list(std::initializer_list<Value> entries);

    Value(const Value& other);
    Value(Value&& other) noexcept;
    Value& operator=(const Value& other);
    Value& operator=(Value&& other) noexcept;
    ~Value();

    Kind kind() const { return kind_; }
    /// T: bool, a number type, std::string. Numbers are converted as by a cast.
    template <class T> T get() const {
        if constexpr (std::same_as<T, bool>)
            return truth();
        else if constexpr (std::floating_point<T>)
            return T(number());
        else if constexpr (std::integral<T>)
            return T(integer());
        else
            return T(text());
    }

    /// The value of that name; added if missing and the record is not const.
    Value& operator[](std::string_view name);
    const Value& operator[](std::string_view name) const;
    bool contains(std::string_view name) const;
    /// The string of that name, empty if missing.
    std::string text_or_empty(std::string_view name) const;
    /// All entries of a record.
    const std::vector<Member>& members() const;
    /// Adds all entries of another record.
    void update(const Value& record);

    /// Entries of a list.
    Value& operator[](size_t index);
    const Value& operator[](size_t index) const;
    void push_back(Value entry);
    const std::vector<Value>& entries() const;
    auto begin() const { return entries().begin(); }
    auto end() const { return entries().end(); }
    /// Number of entries of a list or record; 0 for null.
    size_t size() const;
    bool empty() const { return size() == 0; }

    bool operator==(std::string_view other) const { return kind_ == Kind::text && text_ == other; }
    template <class T>
    requires std::is_arithmetic_v<T>
    bool operator==(T other) const { return get<T>() == other; }
    template <class T>
    requires std::is_arithmetic_v<T> std::partial_ordering operator<=>(T other) const {
        return number() <=> double(other);
    }

  private:
    bool truth() const;
    double number() const;
    int64_t integer() const;
    const std::string& text() const;

    Kind kind_ = Kind::nothing;
    int64_t integer_ = 0;
    double real_ = 0;
    std::string text_;
    std::vector<Value> entries_;
    std::vector<Member> members_;
};

/// From an initializer list.
struct Field {
    const char* name;
    Value value;
};

struct Member {
    std::string name;
    Value value;
};

/// Rows of cells with a header; null cells stay empty.
struct Table {
    std::vector<std::string> columns;
    std::vector<std::vector<Value>> rows;
};

/// Name and contents of a result file.
struct ReportFile {
    std::string name, text;
};

/// As JSON: indented by that many spaces per level, with a final newline; without a value, in one line
/// without newline.
std::string write_json(const Value& value, std::optional<int> indent = {});

/// Parses JSON. Throws Error{bad_input} if the text is not JSON.
Value read_json(const std::string& text);

/// As CSV; strings are quoted where necessary.
std::string write_csv(const Table& table);

} // namespace relief
