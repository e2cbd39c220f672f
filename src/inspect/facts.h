// Facts and findings as inspections make them.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "relief/inspect.h"

namespace relief {

inline Fact make_count(const char* name, uint64_t count) {
    return {name, fmt::format("{}", count), {{"", double(count), "count"}}};
}

template <class... Args>
void add_error(std::vector<Finding>& findings, const char* code, fmt::format_string<Args...> text,
               Args&&... args) {
    findings.push_back({Severity::error, code, fmt::format(text, std::forward<Args>(args)...)});
}
template <class... Args>
void add_warning(std::vector<Finding>& findings, const char* code, fmt::format_string<Args...> text,
                 Args&&... args) {
    findings.push_back({Severity::warning, code, fmt::format(text, std::forward<Args>(args)...)});
}
template <class... Args>
void add_note(std::vector<Finding>& findings, const char* code, fmt::format_string<Args...> text,
              Args&&... args) {
    findings.push_back({Severity::note, code, fmt::format(text, std::forward<Args>(args)...)});
}

} // namespace relief
