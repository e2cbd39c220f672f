// Whether a text is a well-formed XML document, as far as the documents of these tests go.
#pragma once

#include <algorithm>
#include <cctype>
#include <string>
#include <vector>

namespace relief::test {

/// Empty where every element is closed in turn, attributes are quoted, and no markup stands in text or
/// values; else what is wrong. Knows no comments, entities of its own, or processing instructions.
inline std::string find_xml_fault(const std::string& text) {
    std::vector<std::string> open;
    bool has_root = false;
    for (size_t at = 0; at < text.size();) {
        if (text[at] != '<') {
            const size_t end = std::min(text.find('<', at), text.size());
            const std::string between = text.substr(at, end - at);
            if (between.find('>') != std::string::npos) return "a stray > near " + between;
            if (open.empty() && between.find_first_not_of(" \n") != std::string::npos) return "text outside";
            for (size_t mark = between.find('&'); mark != std::string::npos;
                 mark = between.find('&', mark + 1))
                if (between.find(';', mark) > mark + 5) return "a stray & near " + between;
            at = end;
            continue;
        }
        size_t end = at;
        for (char quote = 0; end < text.size() && (quote || text[end] != '>'); ++end) {
            if (quote && text[end] == '<') return "a < in an attribute";
            if (text[end] == '"') quote = quote ? char(0) : '"';
        }
        if (end >= text.size()) return "a tag without an end";
        const std::string tag = text.substr(at + 1, end - at - 1);
        const std::string name = tag.substr(0, tag.find_first_of(" /", 1));
        at = end + 1;
        if (tag[0] == '/') {
            if (open.empty() || "/" + open.back() != tag) return "</" + tag + "> closes nothing";
            open.pop_back();
            continue;
        }
        if (open.empty() && has_root) return "a second root";
        if (name.empty() || !std::isalpha(static_cast<unsigned char>(name[0])))
            return "no name in <" + tag + ">";
        has_root = true;
        if (tag.back() != '/') open.push_back(name);
    }
    if (!open.empty()) return "<" + open.back() + "> is not closed";
    return has_root ? "" : "no element";
}

} // namespace relief::test
