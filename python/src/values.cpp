#include "values.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nanobind/stl/string.h>

#include "base/suggest.h"
#include "relief/error.h"

namespace nb = nanobind;

namespace relief::python {

void Argument::refuse(const std::string& wanted) const {
    const std::string shown = nb::cast<std::string>(nb::repr(value_));
    constexpr size_t kLongest = 60;
    throw Error(ErrorKind::usage,
                {fmt::format("{} is not {}",
                             shown.size() > kLongest ? shown.substr(0, kLongest) + "..." : shown, wanted),
                 name_, ""});
}

int64_t Argument::integer(int64_t low, int64_t high) const {
    const std::string wanted = fmt::format("a whole number from {} to {}", low, high);
    if (PyBool_Check(value_.ptr())) refuse(wanted);
    const nb::object number = nb::steal(PyNumber_Index(value_.ptr()));
    if (!number.is_valid()) {
        PyErr_Clear();
        refuse(wanted);
    }
    int overflow = 0;
    const long long integer = PyLong_AsLongLongAndOverflow(number.ptr(), &overflow);
    if (overflow != 0 || integer < low || integer > high) refuse(wanted);
    return integer;
}

double Argument::number(double low, double high) const {
    const std::string wanted = fmt::format("a number from {} to {}", low, high);
    if (PyBool_Check(value_.ptr()) || is_text()) refuse(wanted);
    const double number = PyFloat_AsDouble(value_.ptr());
    if (PyErr_Occurred()) {
        PyErr_Clear();
        refuse(wanted);
    }
    if (!(number >= low && number <= high)) refuse(wanted);
    return number;
}

bool Argument::truth() const {
    const int truth = PyObject_IsTrue(value_.ptr());
    if (truth >= 0) return truth == 1;
    PyErr_Clear();
    refuse("True or False");
}

std::string Argument::text() const {
    if (!is_text()) refuse("a string");
    return nb::cast<std::string>(value_);
}

std::string Argument::path() const {
    const nb::object path = nb::steal(PyOS_FSPath(value_.ptr()));
    if (!path.is_valid() || !PyUnicode_Check(path.ptr())) {
        PyErr_Clear();
        refuse("a path");
    }
    return nb::cast<std::string>(path);
}

size_t Argument::word(std::span<const std::string_view> words) const {
    if (!is_text()) refuse(fmt::format("one of {}", fmt::join(words, ", ")));
    const std::string given = text();
    const auto found = std::find(words.begin(), words.end(), given);
    if (found == words.end())
        throw Error(ErrorKind::usage, {fmt::format("'{}' is not one of {}", given, fmt::join(words, ", ")),
                                       name_, suggest_word(given, words)});
    return size_t(found - words.begin());
}

std::vector<Argument> Argument::elements(size_t count, const std::string& wanted) const {
    if (is_text() || !PySequence_Check(value_.ptr()) || nb::len(value_) != count) refuse(wanted);
    std::vector<Argument> elements;
    for (size_t k = 0; k < count; ++k) elements.emplace_back(name_, value_[k]);
    return elements;
}

std::vector<std::string> Argument::texts() const {
    if (is_text()) {
        std::vector<std::string> parts(1);
        for (const char c : text())
            if (c == ',')
                parts.emplace_back();
            else
                parts.back() += c;
        return parts;
    }
    if (!PySequence_Check(value_.ptr())) refuse("a list of strings");
    std::vector<std::string> texts;
    for (size_t k = 0; k < nb::len(value_); ++k) texts.push_back(Argument(name_, value_[k]).text());
    return texts;
}

Vec3f Argument::vector(const std::string& wanted) const {
    const std::vector<Argument> parts = elements(3, wanted);
    constexpr double kLargest = 3e38;
    const auto get = [&](size_t k) { return float(parts[k].number(-kLargest, kLargest)); };
    return {get(0), get(1), get(2)};
}

} // namespace relief::python
