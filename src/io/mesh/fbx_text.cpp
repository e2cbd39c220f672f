// FBX files as text: `Name: value, value { records }`, comments behind ';'.
#include <algorithm>
#include <utility>

#include "io/mesh/fbx_document.h"

namespace relief {

class FbxTextParser {
  public:
    FbxTextParser(std::string_view text, FbxDocument& document) : text_(text), document_(document) {}

    bool parse() { return read_records(document_.root_, 0) && at_ == text_.size(); }

  private:
    static bool is_line_end(char c) { return c == '\n' || c == '\r'; }
    static bool is_space(char c) { return c == ' ' || c == '\t' || is_line_end(c); }
    static bool ends_word(char c) {
        return is_space(c) || c == ',' || c == '{' || c == '}' || c == ';' || c == '"';
    }
    static bool begins_value(char c) {
        return std::string_view("-\"0123456789").find(c) != std::string_view::npos;
    }
    bool is_at(char c) const { return at_ < text_.size() && text_[at_] == c; }

    void skip_blanks() {
        while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t')) ++at_;
    }

    /// White space and comments.
    void skip_lines() {
        while (at_ < text_.size() && (is_space(text_[at_]) || text_[at_] == ';')) {
            if (text_[at_] == ';')
                while (at_ < text_.size() && !is_line_end(text_[at_])) ++at_;
            else
                ++at_;
        }
    }

    bool read_records(FbxRecord& parent, int depth) {
        if (depth > kMostFbxNesting) return false;
        for (skip_lines(); at_ < text_.size() && text_[at_] != '}'; skip_lines()) {
            const size_t begin = at_;
            while (at_ < text_.size() && text_[at_] != ':' && !ends_word(text_[at_])) ++at_;
            FbxRecord record;
            record.name = text_.substr(begin, at_ - begin);
            skip_blanks();
            if (!is_at(':') || record.name.empty() || begins_value(record.name[0])) return false;
            ++at_;
            if (record.name == "a" && depth > 0) {
                read_list(record);
            } else if (!read_values(record)) {
                return false;
            }
            if (is_at('{') && !read_scope(record, depth)) return false;
            parent.children.push_back(std::move(record));
        }
        return true;
    }

    bool read_scope(FbxRecord& record, int depth) {
        ++at_;
        record.has_scope = true;
        if (!read_records(record, depth + 1) || !is_at('}')) return false;
        ++at_;
        return true;
    }

    /// The numbers of an array, up to its closing brace.
    void read_list(FbxRecord& record) {
        const size_t end = std::min(text_.find('}', at_), text_.size());
        record.values.push_back(text_.substr(at_, end - at_));
        at_ = end;
    }

    /// A list may go on in the next line behind a comma, and its first value may be empty.
    bool read_values(FbxRecord& record) {
        skip_blanks();
        if (at_ < text_.size() && is_line_end(text_[at_])) skip_to_first_value();
        bool wants_value = false; // behind a comma
        while (at_ < text_.size() && !is_line_end(text_[at_]) && text_[at_] != '{' && text_[at_] != '}' &&
               text_[at_] != ';') {
            if (text_[at_] == ',') {
                record.values.emplace_back();
            } else if (!read_value(record)) {
                return false;
            }
            wants_value = find_comma();
            if (!wants_value) break;
            ++at_;
            skip_lines();
        }
        if (wants_value) record.values.emplace_back();
        skip_blanks();
        return true;
    }

    /// Old versions begin a list in the next line. No name begins like a value.
    void skip_to_first_value() {
        const size_t end = at_;
        while (at_ < text_.size() && is_space(text_[at_])) ++at_;
        if (at_ == text_.size() || !begins_value(text_[at_])) at_ = end;
    }

    /// Old versions begin lines with the comma.
    bool find_comma() {
        skip_blanks();
        const size_t end = at_;
        while (at_ < text_.size() && is_space(text_[at_])) ++at_;
        if (is_at(',')) return true;
        at_ = end;
        return false;
    }

    bool read_value(FbxRecord& record) {
        const size_t begin = at_;
        if (is_at('"')) {
            const size_t end = text_.find('"', at_ + 1);
            if (end == std::string_view::npos) return false;
            at_ = end + 1;
        } else {
            while (at_ < text_.size() && !ends_word(text_[at_])) ++at_;
        }
        record.values.push_back(text_.substr(begin, at_ - begin));
        return true;
    }

    std::string_view text_;
    FbxDocument& document_;
    size_t at_ = 0;
};

bool parse_fbx_text(std::string_view bytes, FbxDocument& document) {
    return FbxTextParser(bytes, document).parse();
}

namespace {

void append_records(std::string& text, const FbxRecord& parent, size_t depth) {
    for (const FbxRecord& record : parent.children) {
        text.append(depth, '\t');
        text += record.name;
        text += ": ";
        for (size_t k = 0; k < record.values.size(); ++k) {
            if (k > 0) text += ',';
            text += record.values[k];
        }
        if (record.has_scope) {
            text += " {\n";
            append_records(text, record, depth + 1);
            text.append(depth, '\t');
            text += '}';
        }
        text += '\n';
    }
}

} // namespace

std::string write_fbx_text(const FbxRecord& root) {
    std::string text = "; FBX project file\n";
    append_records(text, root, 0);
    return text;
}

} // namespace relief
