// A value of a JSON document that knows its place, so that every complaint can name it.
#pragma once

#include <cfloat>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "relief/error.h"
#include "relief/types.h"

namespace relief {

using Json = nlohmann::ordered_json;

/// JSON with comments. Throws bad_input with file, line and column, also for a key that is there twice.
Json parse_json(std::string_view text, const std::string& file);

/// Refers to a value and a file name, which must outlive it. Getters throw bad_input with file and path.
class JsonNode {
  public:
    JsonNode(const Json& value, std::string path, const std::string& file)
        : value_(&value), path_(std::move(path)), file_(&file) {}

    const std::string& path() const { return path_; }
    /// "FILE: PATH", for messages.
    std::string place() const { return path_.empty() ? *file_ : *file_ + ": " + path_; }
    [[noreturn]] void fail(const std::string& message, const std::string& hint = {}) const;

    /// Refuses anything but an object with some of these keys.
    void check_keys(std::span<const std::string_view> keys) const;
    std::optional<JsonNode> find(std::string_view key) const;
    JsonNode get(std::string_view key) const;
    /// Members of an object in file order.
    std::vector<std::pair<std::string, JsonNode>> members() const;
    std::vector<JsonNode> elements() const;

    /// Finite number in [low, high].
    float as_float(double low = -double(FLT_MAX), double high = FLT_MAX) const;
    int64_t as_integer(int64_t low, int64_t high) const;
    bool as_bool() const;
    std::string as_string() const;
    Vec2f as_vec2(double low = -double(FLT_MAX), double high = FLT_MAX) const;
    Vec3f as_vec3(double low = -double(FLT_MAX), double high = FLT_MAX) const;
    /// Three numbers, or one that stands for all.
    Vec3f as_vec3_or_number() const;
    bool is_array() const { return value_->is_array(); }
    bool is_object() const { return value_->is_object(); }
    bool is_string() const { return value_->is_string(); }

    /// Calls `read`; an Error from it is thrown again with this place in front.
    template <class Read> auto with_place(const Read& read) const {
        try {
            return read();
        } catch (const Error& error) {
            rethrow_with_place(error);
        }
    }

  private:
    std::vector<JsonNode> numbers(size_t count) const;
    [[noreturn]] void rethrow_with_place(const Error& error) const;
    [[noreturn]] void fail_type(const std::string& wanted) const;

    const Json* value_;
    std::string path_;
    const std::string* file_;
};

} // namespace relief
