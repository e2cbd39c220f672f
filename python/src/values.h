// Arguments of calls, read with messages that name them.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nanobind/nanobind.h>

#include "relief/types.h"

namespace relief::python {

/// A value under the name of its keyword. Getters throw Error{usage}.
class Argument {
  public:
    Argument(std::string name, nanobind::handle value)
        : name_(std::move(name)), value_(nanobind::borrow(value)) {}

    [[noreturn]] void refuse(const std::string& wanted) const;

    int64_t integer(int64_t low, int64_t high) const;
    /// Finite, in [low, high].
    double number(double low, double high) const;
    /// What Python holds to be true or false.
    bool truth() const;
    bool is_text() const { return PyUnicode_Check(value_.ptr()); }
    std::string text() const;
    /// A string or an os.PathLike.
    std::string path() const;
    /// Index of the word that it is.
    size_t word(std::span<const std::string_view> words) const;
    /// A sequence of so many values; `wanted` says which.
    std::vector<Argument> elements(size_t count, const std::string& wanted) const;
    /// A sequence of strings, or one with commas.
    std::vector<std::string> texts() const;
    Vec3f vector(const std::string& wanted) const;

  private:
    std::string name_;
    nanobind::object value_;
};

} // namespace relief::python
