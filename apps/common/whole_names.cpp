#include "common/whole_names.h"

#include <array>

namespace relief::cli {

namespace {

constexpr std::array<std::string_view, 15> kKeys = {
    "displacement.axes",     "displacement.space",    "displacement.scale",
    "displacement.midlevel", "displacement.type",     "displacement.wrap",
    "displacement.encoding", "displacement.frame",    "displacement.filter",
    "displacement.flip_v",   "displacement.lengths",  "displacement.dequantize",
    "displacement.dilate",   "displacement.autobump", "mesh.weld"};

bool is_part_of_name(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '/' || c == '.' || c == '-';
}

} // namespace

size_t find_whole_name(std::string_view text, std::string_view name, size_t at) {
    for (; (at = text.find(name, at)) != std::string_view::npos; at += name.size()) {
        const size_t end = at + name.size();
        const bool is_whole = (at == 0 || !is_part_of_name(text[at - 1])) &&
                              (end == text.size() || !is_part_of_name(text[end]));
        if (is_whole) break;
    }
    return at;
}

std::string name_map_keys(std::string text) {
    for (const std::string_view name : kKeys) {
        const size_t start = name.find('.') + 1;
        for (size_t at = 0; (at = find_whole_name(text, name, at)) != std::string::npos;
             at += name.size() - start)
            text.erase(at, start);
    }
    return text;
}

} // namespace relief::cli
