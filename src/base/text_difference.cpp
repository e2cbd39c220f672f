#include "base/text_difference.h"

#include <vector>

#include <fmt/format.h>

namespace relief {

std::string describe_difference(std::string mine, std::string theirs) {
    const auto take_part = [](std::string& text) {
        const size_t end = text.find(", ");
        std::string part = text.substr(0, end);
        text.erase(0, end == std::string::npos ? end : end + 2);
        return part;
    };
    std::vector<std::string> differences;
    while (!mine.empty() || !theirs.empty()) {
        const std::string here = take_part(mine), there = take_part(theirs);
        if (here != there) differences.push_back(fmt::format("{} (there: {})", here, there));
    }
    return fmt::format("{}", fmt::join(differences, ", "));
}

} // namespace relief
