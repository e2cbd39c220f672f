// Names in a message: the first ones, and how many more there are.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace relief {

inline std::string list_names(const std::vector<std::string>& names) {
    constexpr size_t kMostNamed = 4;
    std::string list;
    for (size_t k = 0; k < std::min(names.size(), kMostNamed); ++k)
        list += fmt::format("{}'{}'", k == 0 ? "" : ", ", names[k]);
    if (names.size() > kMostNamed) list += fmt::format(" and {} more", names.size() - kMostNamed);
    return list;
}

} // namespace relief
