#include "io/mesh/mesh_obj.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <string>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "base/text_reading.h"
#include "relief/error.h"

namespace relief {

namespace {

constexpr std::string_view kSpaces = " \t\v\f";
constexpr const char* kTagHint = "a tag reads 't crease 2/1/0 FIRST SECOND SHARPNESS'";
constexpr int64_t kWrittenZero =
    std::numeric_limits<int64_t>::min(); ///< apart from an index that is left out
constexpr const char* kNumberHint = "numbers are written as 1.5 or 1e-3: export it again";
constexpr const char* kIndexHint = "indices count from 1, or back from -1";

/// Statements one after the other: a line, or several that end with a backslash.
class ObjText {
  public:
    explicit ObjText(std::string_view text) : text_(skip_byte_order_mark(text)) {}

    bool next_statement() {
        if (text_.empty()) return false;
        line_ = ++last_line_;
        rest_ = take_line(text_);
        if (!continues(rest_)) return true;
        joined_.clear();
        while (continues(rest_) && !text_.empty()) {
            joined_.append(rest_.substr(0, rest_.size() - 1)) += ' ';
            rest_ = take_line(text_);
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

    std::string_view text_, rest_;
    std::string joined_;
    size_t line_ = 0, last_line_ = 0;
};

/// All of `word` as a number.
template <class T> std::errc read_number(std::string_view word, T& value) {
    const auto [stop, code] = std::from_chars(word.data(), word.data() + word.size(), value);
    return stop == word.data() + word.size() ? code : std::errc::invalid_argument;
}

/// Words at the start of a statement that do not change the polygons: groups, materials, lines, points, and
/// what belongs to free-form curves.
constexpr std::array<std::string_view, 38> kPassedOver = {
    "g",        "o",      "s",      "mg",     "l",     "p",          "vp",        "usemtl",
    "mtllib",   "usemap", "maplib", "bevel",  "lod",   "shadow_obj", "trace_obj", "c_interp",
    "d_interp", "deg",    "bmat",   "step",   "parm",  "trim",       "hole",      "scrv",
    "sp",       "end",    "con",    "cstype", "ctech", "stech",      "curv",      "curv2",
    "csh",      "bzp",    "bsp",    "cdc",    "cdp",   "res"};

/// Statements that were not read, by what they are.
class LeftOut {
  public:
    void add(size_t line, std::string_view word) {
        if (count_++ == 0) line_ = line, word_ = word.substr(0, 40);
    }
    size_t count() const { return count_; }
    size_t line() const { return line_; } ///< of the first one
    const std::string& word() const { return word_; }

  private:
    size_t count_ = 0, line_ = 0;
    std::string word_;
};

class ObjReader {
  public:
    ObjReader(std::string_view text, const std::string& name) : text_(text), name_(name) {}

    Mesh read() {
        while (text_.next_statement()) read_statement(text_.next_word());
        check_positions();
        drop_out_of_range();
        check_creases();
        if (!has_uvs_) mesh_.uvs.clear(), mesh_.uv_indices.clear();
        const bool has_normals =
            std::ranges::find(mesh_.normal_indices, kNoIndex) == mesh_.normal_indices.end();
        if (!has_normals) mesh_.normal_indices.clear(), mesh_.normals.clear();
        return std::move(mesh_);
    }

    void add_warnings(std::vector<std::string>& warnings) const {
        const auto warn = [&](const LeftOut& left_out, std::string_view what) {
            if (left_out.count() > 0)
                warnings.push_back(fmt::format("{}: {}; the first is '{}' in line {}", name_,
                                               fmt::format(fmt::runtime(what), left_out.count()),
                                               left_out.word(), left_out.line()));
        };
        warn(unknown_, "{} lines begin with words that OBJ does not have, and are left out");
        warn(surfaces_, "{} curved surfaces and calls of other files are not read: export polygons");
        warn(bad_uvs_,
             "{} corners have uv indices that are out of range: their faces have no uvs, export the mesh "
             "again");
        warn(bad_normals_, "{} corners have normal indices that are out of range: the normals are left out");
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

    void read_statement(std::string_view keyword) {
        if (keyword == "v")
            read_position();
        else if (keyword == "vn")
            mesh_.normals.push_back(read_vector("vn"));
        else if (keyword == "vt")
            read_uv();
        else if (keyword == "f" || keyword == "fo") // the latter by an older version of the format
            read_face();
        else if (keyword == "t")
            read_tag();
        else if (keyword == "surf" || keyword == "call")
            surfaces_.add(text_.line(), keyword);
        else if (!keyword.empty() && std::ranges::find(kPassedOver, keyword) == kPassedOver.end())
            unknown_.add(text_.line(), keyword);
    }

    /// Reads all numbers of a statement, of which it needs some, and keeps the first three.
    Vec3f read_numbers(std::string_view keyword, size_t needed) {
        float values[3] = {0, 0, 0};
        size_t count = 0;
        for (std::string_view word = text_.next_word(); !word.empty(); word = text_.next_word(), ++count) {
            double value = 0;
            const std::errc code = read_number(word.substr(word.starts_with('+') ? 1 : 0), value);
            // NaN and infinity are refused where a face needs them. Colours of points stand behind.
            if (count < 3 && code == std::errc() && !std::isfinite(value)) not_finite_ = word.substr(0, 40);
            if (code == std::errc::invalid_argument)
                fail(fmt::format("'{}' is not a number", word.substr(0, 40)), kNumberHint);
            // Too small is 0. Too large stays so, and is refused with all that is too large for a scene.
            if (code == std::errc::result_out_of_range && word.find("e-") == word.npos &&
                word.find("E-") == word.npos)
                value = std::numeric_limits<double>::infinity();
            if (count < 3) values[count] = float(value);
        }
        if (count < needed)
            fail(fmt::format("'{}' has {} of {} numbers", keyword, count, needed), kNumberHint);
        return {values[0], values[1], values[2]};
    }
    Vec3f read_vector(std::string_view keyword) { return read_numbers(keyword, 3); }
    void read_position() {
        not_finite_.clear();
        mesh_.positions.push_back(read_vector("v"));
        if (!not_finite_.empty())
            bad_positions_[uint32_t(mesh_.positions.size() - 1)] = {text_.line(), not_finite_};
    }
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
            const std::errc code = part.empty() ? std::errc() : read_number(part, index);
            if (code == std::errc::result_out_of_range) index = std::numeric_limits<int64_t>::max();
            if (!part.empty() && index == 0 && &index != &corner.indices[0]) index = kWrittenZero;
            if (code == std::errc::invalid_argument)
                fail_face(fmt::format("index '{}' is no whole number", part.substr(0, 40)), kIndexHint);
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
        for (const Corner& corner : corners_) {
            const auto [position, uv, normal] = corner.indices;
            mesh_.position_indices.push_back(resolve_position(position));
            mesh_.uv_indices.push_back(has_uvs ? resolve(uv, mesh_.uvs.size(), bad_uvs_) : kNoIndex);
            mesh_.normal_indices.push_back(normal == 0 ? kNoIndex
                                                       : resolve(normal, mesh_.normals.size(), bad_normals_));
            lines_.push_back(uint32_t(text_.line()));
        }
        mesh_.face_sizes.push_back(uint32_t(corners_.size()));
    }

    static bool is_in_reach(int64_t index, size_t count) {
        return index != 0 && index < int64_t(kNoIndex) && index >= -int64_t(count);
    }
    static uint32_t count_from_zero(int64_t index, size_t count) {
        return uint32_t(index > 0 ? index - 1 : int64_t(count) + index);
    }
    uint32_t resolve_position(int64_t index) const {
        if (!is_in_reach(index, mesh_.positions.size()))
            fail_face(fmt::format("position index {} is out of range", index), kIndexHint);
        return count_from_zero(index, mesh_.positions.size());
    }
    /// kNoIndex where a uv or normal is none.
    uint32_t resolve(int64_t index, size_t count, LeftOut& bad) const {
        if (is_in_reach(index, count)) return count_from_zero(index, count);
        bad.add(text_.line(), fmt::format("{}", index == kWrittenZero ? 0 : index));
        return kNoIndex;
    }

    /// Positive indices may refer to lines further down, so the upper end is checked when all is read.
    void check_positions() const {
        const size_t count = mesh_.positions.size();
        size_t face = 0, corner = 0;
        for (const uint32_t index : mesh_.position_indices) {
            if (index >= count)
                throw Error(ErrorKind::bad_input,
                            {fmt::format("position index {} is out of range: there are {}",
                                         uint64_t(index) + 1, count),
                             fmt::format("{}, face {}", name_, face + 1),
                             "the file is damaged: export it again"});
            if (++corner == mesh_.face_sizes[face]) ++face, corner = 0;
            const auto bad = bad_positions_.find(index);
            if (bad != bad_positions_.end())
                throw Error(ErrorKind::bad_input,
                            {fmt::format("'{}' is not a number", bad->second.second),
                             fmt::format("{}, line {}", name_, bad->second.first), kNumberHint});
        }
    }

    /// Uvs and normals that are not there; a face that lacks a uv at one corner has none.
    void drop_out_of_range() {
        const auto drop = [&](std::vector<uint32_t>& indices, size_t count, LeftOut& bad) {
            for (size_t corner = 0; corner < indices.size(); ++corner) {
                if (indices[corner] == kNoIndex || indices[corner] < count) continue;
                bad.add(lines_[corner], fmt::format("{}", uint64_t(indices[corner]) + 1));
                indices[corner] = kNoIndex;
            }
        };
        drop(mesh_.uv_indices, mesh_.uvs.size(), bad_uvs_);
        drop(mesh_.normal_indices, mesh_.normals.size(), bad_normals_);
        has_uvs_ = false;
        auto begin = mesh_.uv_indices.begin();
        for (const uint32_t size : mesh_.face_sizes) {
            const auto end = begin + ptrdiff_t(size);
            if (std::find(begin, end, kNoIndex) != end)
                std::fill(begin, end, kNoIndex);
            else
                has_uvs_ = true;
            begin = end;
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
    std::vector<uint32_t> lines_; ///< of the corners
    std::string not_finite_;      ///< the last word that was NaN or infinity
    std::map<uint32_t, std::pair<size_t, std::string>> bad_positions_; ///< their lines and words
    LeftOut unknown_, surfaces_, bad_uvs_, bad_normals_;
    size_t face_ = 0;
    bool has_uvs_ = false; ///< of a face at least
};

} // namespace

Mesh parse_obj(std::string_view text, const std::string& name, std::vector<std::string>* warnings) {
    if (is_wide_text(text)) throw Error(ErrorKind::bad_input, {kWideText, name, kWideTextHint});
    ObjReader reader(text, name);
    Mesh mesh = reader.read();
    if (warnings) reader.add_warnings(*warnings);
    return mesh;
}

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
