#include "io/mesh/ply_header.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "base/text_reading.h"
#include "relief/error.h"

namespace relief {

namespace {

struct TypeNames {
    std::string_view first, by_size; ///< both are in use
    size_t bytes;
};

/// In the order of PlyType.
constexpr std::array<TypeNames, 8> kTypes = {{{"char", "int8", 1},
                                              {"uchar", "uint8", 1},
                                              {"short", "int16", 2},
                                              {"ushort", "uint16", 2},
                                              {"int", "int32", 4},
                                              {"uint", "uint32", 4},
                                              {"float", "float32", 4},
                                              {"double", "float64", 8}}};

std::vector<std::string_view> split_words(std::string_view line) {
    constexpr std::string_view kBlanks = " \t";
    std::vector<std::string_view> words;
    for (size_t at = line.find_first_not_of(kBlanks); at < line.size();) {
        const size_t end = std::min(line.find_first_of(kBlanks, at), line.size());
        words.push_back(line.substr(at, end - at));
        at = line.find_first_not_of(kBlanks, end);
    }
    return words;
}

constexpr const char* kDamagedHeaderHint = "the file is damaged: export it again";

class HeaderParser {
  public:
    HeaderParser(std::string_view bytes, const std::string& name)
        : bytes_(bytes), name_(name), at_(bytes.size() - skip_byte_order_mark(bytes).size()) {
        // A body that follows CR alone may begin with the byte of LF.
        const size_t end = std::min(bytes.find_first_of("\r\n", at_), bytes.size());
        ends_with_cr_ = bytes.substr(end).starts_with('\r') && !bytes.substr(end).starts_with("\r\n");
    }

    PlyHeader parse() {
        if (split_words(next_line()) != std::vector<std::string_view>{"ply"})
            fail("does not begin with the word 'ply'", "this is no PLY file");
        while (true) {
            const std::vector<std::string_view> words = split_words(next_line());
            if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
            if (words[0] == "end_header") break;
            if (words[0] == "format")
                add_format(words);
            else if (words[0] == "element")
                add_element(words);
            else if (words[0] == "property")
                add_property(words);
            else
                add_unknown(words[0]);
        }
        if (!has_format_) fail("the header names no format", kDamagedHeaderHint);
        header_.byte_count = at_;
        return std::move(header_);
    }

  private:
    [[noreturn]] void fail(const std::string& message, const std::string& hint) const {
        refuse_unknown_words(header_, name_); // they came first
        throw Error(ErrorKind::bad_input, {message, fmt::format("{}, line {}", name_, line_), hint});
    }

    std::string_view next_line() {
        ++line_;
        const size_t end = bytes_.find(ends_with_cr_ ? '\r' : '\n', at_);
        if (end == std::string_view::npos) fail("the header has no end", kDamagedHeaderHint);
        std::string_view line = bytes_.substr(at_, end - at_);
        at_ = end + 1;
        if (line.ends_with('\r')) line.remove_suffix(1);
        return line;
    }

    void add_unknown(std::string_view word) {
        if (header_.unknown.count++ > 0) return;
        header_.unknown.first_line = line_;
        header_.unknown.first_word = word;
    }

    void add_format(const std::vector<std::string_view>& words) {
        constexpr std::array<std::pair<std::string_view, PlyFormat>, 3> kFormats = {{
            {"ascii", PlyFormat::ascii},
            {"binary_little_endian", PlyFormat::little_endian},
            {"binary_big_endian", PlyFormat::big_endian},
        }};
        for (const auto& [word, format] : kFormats)
            if (words.size() == 3 && words[1] == word && words[2] == "1.0")
                header_.format = format, has_format_ = true;
        if (!has_format_)
            fail("unknown format", "it is 'ascii', 'binary_little_endian' or 'binary_big_endian', and 1.0");
    }

    void add_element(const std::vector<std::string_view>& words) {
        PlyElement element;
        bool is_understood = words.size() == 3;
        if (is_understood) {
            const char* end = words[2].data() + words[2].size();
            const auto [stop, code] = std::from_chars(words[2].data(), end, element.count);
            is_understood = stop == end && code == std::errc();
        }
        if (!is_understood) fail("an element needs a name and a count", kDamagedHeaderHint);
        element.name = words[1];
        for (const PlyElement& other : header_.elements)
            if (other.name == element.name)
                fail(fmt::format("element '{}' stands twice", element.name), kDamagedHeaderHint);
        header_.elements.push_back(std::move(element));
    }

    void add_property(const std::vector<std::string_view>& words) {
        if (header_.elements.empty()) fail("a property stands before the first element", kDamagedHeaderHint);
        const bool is_list = words.size() == 5 && words[1] == "list";
        if (!is_list && words.size() != 3) fail("a property needs a type and a name", kDamagedHeaderHint);
        PlyProperty property;
        property.name = words.back();
        property.type = find_type(words[words.size() - 2]);
        if (is_list) property.count_type = find_type(words[2]);
        header_.elements.back().properties.push_back(std::move(property));
    }

    PlyType find_type(std::string_view word) const {
        for (size_t k = 0; k < kTypes.size(); ++k)
            if (word == kTypes[k].first || word == kTypes[k].by_size) return PlyType(k);
        fail(fmt::format("unknown type '{}'", word), "the types are char to double and int8 to float64");
    }

    std::string_view bytes_;
    const std::string& name_;
    PlyHeader header_;
    bool has_format_ = false, ends_with_cr_ = false;
    size_t at_ = 0, line_ = 0;
};

} // namespace

PlyHeader parse_ply_header(std::string_view bytes, const std::string& name) {
    if (is_wide_text(bytes)) throw Error(ErrorKind::bad_input, {kWideText, name, kWideTextHint});
    return HeaderParser(bytes, name).parse();
}

void refuse_unknown_words(const PlyHeader& header, const std::string& name) {
    if (header.unknown.count == 0) return;
    throw Error(ErrorKind::bad_input,
                {fmt::format("unknown word '{}' in the header", header.unknown.first_word),
                 fmt::format("{}, line {}", name, header.unknown.first_line), kDamagedHeaderHint});
}

size_t get_byte_size(PlyType type) { return kTypes[size_t(type)].bytes; }

} // namespace relief
