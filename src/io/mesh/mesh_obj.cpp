#include "io/mesh/mesh_obj.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <limits>
#include <system_error>

#include <fmt/format.h>

#include "relief/error.h"

namespace relief {

namespace {

constexpr std::string_view kSpaces = " \t\v\f";
constexpr const char* kTagHint = "a tag reads 't crease 2/1/0 FIRST SECOND SHARPNESS'";
constexpr const char* kIndexHint = "indices count from 1, or back from -1";

/// Statements one after the other: a line, or several that end with a backslash.
class ObjText {
  public:
    explicit ObjText(std::string_view text) : text_(text) {}

    bool next_statement() {
        if (text_.empty()) return false;
        line_ = ++last_line_;
        rest_ = take_line();
        if (!continues(rest_)) return true;
        joined_.clear();
        while (continues(rest_) && !text_.empty()) {
            joined_.append(rest_.substr(0, rest_.size() - 1)) += ' ';
            rest_ = take_line();
            ++last_line_;
        }
        joined_.append(rest_.substr(0, rest_.size() - (continues(rest_) ? 1 : 0)));
        rest_ = joined_;
        return true;
    }
    /// Takes the next word; empty at the end of the statement and before a comment.
    std::string_view next_word() {
        rest_.remove_prefix(std::min(rest_.find_first_not_of(kSpaces), rest_.size()));
        if (rest_.starts_with('#')) rest_ = {};
        const std::string_view word = rest_.substr(0, rest_.find_first_of(kSpaces));
        rest_.remove_prefix(word.size());
        return word;
    }
    size_t size_left() const { return rest_.size(); }
    /// Number of the line with which the statement begins, from 1.
    size_t line() const { return line_; }

  private:
    /// A path in a comment may end with a backslash.
    static bool continues(std::string_view line) {
        return line.ends_with('\\') && line.find('#') == std::string_view::npos;
    }
    std::string_view take_line() {
        const std::string_view line = text_.substr(0, text_.find_first_of("\r\n"));
        text_.remove_prefix(line.size());
        text_.remove_prefix(text_.starts_with("\r\n") ? 2 : std::min<size_t>(text_.size(), 1));
        return line;
    }

    std::string_view text_, rest_;
    std::string joined_;
    size_t line_ = 0, last_line_ = 0;
};

/// All of `word` as a number.
template <class T> std::errc read_number(std::string_view word, T& value) {
    const auto [stop, code] = std::from_chars(word.data(), word.data() + word.size(), value);
    return stop == word.data() + word.size() ? code : std::errc::invalid_argument;
}

class ObjReader {
  public:
    ObjReader(std::string_view text, const std::string& name) : text_(text), name_(name) {}

    Mesh read() {
        while (text_.next_statement()) {
            const std::string_view keyword = text_.next_word();
            if (keyword == "v")
                mesh_.positions.push_back(read_vector("v"));
            else if (keyword == "vn")
                mesh_.normals.push_back(read_vector("vn"));
            else if (keyword == "vt")
                read_uv();
            else if (keyword == "f")
                read_face();
            else if (keyword == "t")
                read_tag();
        }
        check_range(mesh_.position_indices, mesh_.positions.size(), "position");
        check_range(mesh_.uv_indices, mesh_.uvs.size(), "uv");
        check_range(mesh_.normal_indices, mesh_.normals.size(), "normal");
        check_creases();
        if (!has_uvs_) mesh_.uvs.clear(), mesh_.uv_indices.clear();
        if (mesh_.normal_indices.size() != mesh_.position_indices.size())
            mesh_.normal_indices.clear(), mesh_.normals.clear();
        return std::move(mesh_);
    }

  private:
    struct Corner {
        int64_t indices[3] = {0, 0, 0}; // of position, uv and normal; 0: it has none
    };

    [[noreturn]] void fail(std::string message, const char* hint) const {
        throw Error(ErrorKind::bad_input,
                    {std::move(message), fmt::format("{}, line {}", name_, text_.line()), hint});
    }
    [[noreturn]] void fail_face(std::string message, const char* hint) const {
        throw Error(
            ErrorKind::bad_input,
            {std::move(message), fmt::format("{}, line {}, face {}", name_, text_.line(), face_), hint});
    }

    /// Reads all numbers of a statement, of which it needs some, and keeps the first three.
    Vec3f read_numbers(std::string_view keyword, size_t needed) {
        constexpr const char* kHint = "numbers are written as 1.5 or 1e-3: export it again";
        float values[3] = {0, 0, 0};
        size_t count = 0;
        for (std::string_view word = text_.next_word(); !word.empty(); word = text_.next_word(), ++count) {
            double value = 0;
            const std::errc code = read_number(word.substr(word.starts_with('+') ? 1 : 0), value);
            if (code == std::errc::invalid_argument || !std::isfinite(value))
                fail(fmt::format("'{}' is not a number", word.substr(0, 40)), kHint);
            // Too small is 0. Too large stays so, and is refused with all that is too large for a scene.
            if (code == std::errc::result_out_of_range && word.find("e-") == word.npos &&
                word.find("E-") == word.npos)
                value = std::numeric_limits<double>::infinity();
            if (count < 3) values[count] = float(value);
        }
        if (count < needed) fail(fmt::format("'{}' has {} of {} numbers", keyword, count, needed), kHint);
        return {values[0], values[1], values[2]};
    }
    Vec3f read_vector(std::string_view keyword) { return read_numbers(keyword, 3); }
    void read_uv() {
        const Vec3f uv = read_numbers("vt", 1);
        mesh_.uvs.push_back({uv.x, uv.y});
    }

    /// "1", "1/2", "1//3" or "1/2/3".
    Corner read_corner(std::string_view word) const {
        Corner corner;
        std::string_view rest = word;
        for (int64_t& index : corner.indices) {
            const std::string_view part = rest.substr(0, rest.find('/'));
            if (!part.empty() && (read_number(part, index) != std::errc() || index == 0))
                fail_face(fmt::format("index '{}' is out of range", part.substr(0, 40)), kIndexHint);
            if (part.size() == rest.size()) return corner;
            rest.remove_prefix(part.size() + 1);
        }
        fail_face(fmt::format("corner '{}' has more than three indices", word.substr(0, 40)), kIndexHint);
    }

    void read_face() {
        ++face_;
        corners_.clear();
        for (std::string_view word = text_.next_word(); !word.empty(); word = text_.next_word())
            corners_.push_back(read_corner(word));
        if (corners_.size() < 3) return;
        // One corner without a uv leaves the whole face without.
        const bool has_uvs = std::all_of(corners_.begin(), corners_.end(),
                                         [](const Corner& corner) { return corner.indices[1] != 0; });
        has_uvs_ = has_uvs_ || has_uvs;
        for (const Corner& corner : corners_) {
            const auto [position, uv, normal] = corner.indices;
            mesh_.position_indices.push_back(resolve(position, mesh_.positions.size(), "position"));
            mesh_.uv_indices.push_back(has_uvs ? resolve(uv, mesh_.uvs.size(), "uv") : kNoIndex);
            if (normal != 0) mesh_.normal_indices.push_back(resolve(normal, mesh_.normals.size(), "normal"));
        }
        mesh_.face_sizes.push_back(uint32_t(corners_.size()));
    }

    uint32_t resolve(int64_t index, size_t count, const char* what) const {
        const int64_t most = std::numeric_limits<uint32_t>::max();
        if (index == 0 || index > most || index < -int64_t(count))
            fail_face(fmt::format("{} index {} is out of range", what, index), kIndexHint);
        return uint32_t(index > 0 ? index - 1 : int64_t(count) + index);
    }

    /// Positive indices may refer to lines further down, so the upper end is checked when all is read.
    void check_range(const std::vector<uint32_t>& indices, size_t count, const char* what) const {
        size_t face = 0, corner = 0;
        for (const uint32_t index : indices) {
            if (index >= count && index != kNoIndex) {
                throw Error(ErrorKind::bad_input, {fmt::format("{} index {} is out of range: there are {}",
                                                               what, uint64_t(index) + 1, count),
                                                   fmt::format("{}, face {}", name_, face + 1),
                                                   "the file is damaged: export it again"});
            }
            if (face < mesh_.face_sizes.size() && ++corner == mesh_.face_sizes[face]) ++face, corner = 0;
        }
    }

    template <class T> T read_tag_number() {
        const std::string_view word = text_.next_word();
        T value{};
        if (read_number(word, value) != std::errc())
            fail(fmt::format("'{}' stands where a number must be", word.substr(0, 40)), kTagHint);
        return value;
    }
    /// WHOLE/REAL/TEXTS: the counts of whole and of real numbers.
    std::pair<size_t, size_t> read_tag_counts() {
        std::string_view word = text_.next_word();
        size_t counts[2] = {0, 0};
        for (size_t& count : counts) {
            const size_t used = std::min(word.find('/'), word.size());
            // Each number takes a space and a digit.
            if (used == word.size() || read_number(word.substr(0, used), count) != std::errc() ||
                count > text_.size_left() / 2)
                fail("the counts of a tag are not numbers, or more than its line holds", kTagHint);
            word.remove_prefix(used + 1);
        }
        return {counts[0], counts[1]};
    }
    /// "t NAME WHOLE/REAL/TEXTS", then that many integers, real numbers and texts.
    void read_tag() {
        const std::string_view kind = text_.next_word();
        const size_t ends = kind == "crease" ? 2 : kind == "corner" ? 1 : 0;
        if (ends == 0) return;
        const auto [index_count, real_count] = read_tag_counts();
        const size_t crease_count = index_count / ends;
        if (index_count % ends != 0 || (real_count != 1 && real_count != crease_count))
            fail(fmt::format("{} positions with {} sharpnesses", index_count, real_count), kTagHint);
        const size_t begin = mesh_.creases.size();
        for (size_t k = 0; k < crease_count; ++k) {
            Crease crease;
            crease.first = crease.second = read_crease_index();
            if (ends == 2) crease.second = read_crease_index();
            if (ends == 2 && crease.first == crease.second) fail("a crease needs two positions", kTagHint);
            mesh_.creases.push_back(crease);
            crease_lines_.push_back(text_.line());
        }
        for (size_t k = 0; k < real_count; ++k) {
            const float sharpness = read_tag_number<float>();
            if (!std::isfinite(sharpness)) fail("a sharpness must be finite", kTagHint);
            const size_t last = real_count == 1 ? crease_count : k + 1;
            for (size_t j = k; j < last; ++j) mesh_.creases[begin + j].sharpness = std::max(sharpness, 0.0f);
        }
    }
    uint32_t read_crease_index() {
        // More than 32 bits is above any count.
        return uint32_t(
            std::min<uint64_t>(read_tag_number<uint64_t>(), std::numeric_limits<uint32_t>::max()));
    }
    /// Tags may stand above the positions.
    void check_creases() const {
        for (size_t k = 0; k < mesh_.creases.size(); ++k) {
            const uint32_t index = std::max(mesh_.creases[k].first, mesh_.creases[k].second);
            if (index < mesh_.positions.size()) continue;
            throw Error(ErrorKind::bad_input,
                        {fmt::format("position {} is out of range: there are {}, counted from 0", index,
                                     mesh_.positions.size()),
                         fmt::format("{}, line {}", name_, crease_lines_[k]), kTagHint});
        }
    }

    ObjText text_;
    const std::string& name_;
    Mesh mesh_;
    std::vector<Corner> corners_;
    std::vector<size_t> crease_lines_;
    size_t face_ = 0;
    bool has_uvs_ = false; ///< of a face at least
};

} // namespace

Mesh parse_obj(std::string_view text, const std::string& name) { return ObjReader(text, name).read(); }

std::string format_obj_creases(const std::vector<Crease>& creases) {
    std::string text;
    const auto out = std::back_inserter(text);
    for (const Crease& crease : creases) {
        if (crease.first == crease.second)
            fmt::format_to(out, "t corner 1/1/0 {} {:.9g}\n", crease.first, crease.sharpness);
        else
            fmt::format_to(out, "t crease 2/1/0 {} {} {:.9g}\n", crease.first, crease.second,
                           crease.sharpness);
    }
    return text;
}

} // namespace relief
