#include "base/text_reading.h"

#include <algorithm>
#include <cstdint>
#include <streambuf>

namespace relief {

namespace {

constexpr std::string_view kMark = "\xef\xbb\xbf";

/// The first byte behind a quoted text, whose quote is at `start`.
size_t find_end_of_quote(std::string_view json, size_t start) {
    size_t at = start + 1;
    while (at < json.size() && json[at] != '"') at += json[at] == '\\' ? 2 : 1;
    return at + 1;
}

/// The first byte behind a comment; the next one where there is none.
size_t find_end_of_comment(std::string_view json, size_t start) {
    const std::string_view rest = json.substr(start);
    if (rest.starts_with("//")) return start + std::min(rest.find_first_of("\r\n"), rest.size());
    if (rest.starts_with("/*")) return start + std::min(rest.find("*/", 2), rest.size() - 2) + 2;
    return start + 1;
}

} // namespace

std::string_view skip_byte_order_mark(std::string_view text) {
    if (text.starts_with(kMark)) text.remove_prefix(kMark.size());
    return text;
}

bool is_wide_text(std::string_view text) {
    constexpr std::string_view kBigEndian32("\0\0\xfe\xff", 4);
    return text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff") || text.starts_with(kBigEndian32);
}

std::string_view take_line(std::string_view& text) {
    const std::string_view line = text.substr(0, text.find_first_of("\r\n"));
    text.remove_prefix(line.size());
    text.remove_prefix(text.starts_with("\r\n") ? 2 : std::min<size_t>(text.size(), 1));
    return line;
}

bool read_line(std::istream& stream, std::string& line) {
    line.clear();
    std::streambuf* buffer = stream.rdbuf();
    for (int c = stream.get(); stream; c = stream.get()) {
        if (c == '\n' || c == '\r') {
            // A pipe may have no more yet: the LF is then an empty line.
            if (c == '\r' && buffer->in_avail() > 0 && buffer->sgetc() == '\n') stream.get();
            break;
        }
        line += char(c);
    }
    if (!stream && line.empty()) return false;
    if (!stream.bad()) stream.clear(stream.rdstate() & std::ios::eofbit);
    line.erase(0, line.size() - skip_byte_order_mark(line).size());
    return true;
}

TextPlace find_place(std::string_view text, size_t byte) {
    TextPlace place;
    for (size_t i = 0; i < std::min(byte, text.size()); ++i) {
        const bool is_pair = text[i] == '\r' && i + 1 < text.size() && text[i + 1] == '\n';
        if (text[i] == '\n' || (text[i] == '\r' && !is_pair))
            ++place.line, place.column = 1;
        else
            ++place.column;
    }
    return place;
}

std::optional<size_t> find_deep_nesting(std::string_view json) {
    size_t depth = 0;
    for (size_t at = 0; at < json.size();) {
        const char c = json[at];
        if (c == '"') {
            at = find_end_of_quote(json, at);
            continue;
        }
        if (c == '/') {
            at = find_end_of_comment(json, at);
            continue;
        }
        if (c == '[' || c == '{') {
            if (++depth > kMostNesting) return at;
        } else if ((c == ']' || c == '}') && depth > 0) {
            --depth;
        }
        ++at;
    }
    return std::nullopt;
}

} // namespace relief
