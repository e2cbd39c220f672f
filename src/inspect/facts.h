// Facts as inspections make them.
#pragma once

#include <cstdint>

#include <fmt/format.h>

#include "relief/inspect.h"

namespace relief {

inline Fact make_count(const char* name, uint64_t count) {
    return {name, fmt::format("{}", count), {{"", double(count), "count"}}};
}

} // namespace relief
