#include "io/mesh/obj_tags.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <system_error>

#include <fmt/format.h>

#include "relief/error.h"

namespace relief {

namespace {

constexpr std::string_view kSpaces = " \t\r";

/// One line of a tag: "t NAME WHOLE/REAL/TEXTS", then that many whole numbers, real numbers and texts.
class TagLine {
  public:
    TagLine(std::string_view line, std::string place) : rest_(line), place_(std::move(place)) {}

    [[noreturn]] void fail(const std::string& message) const {
        throw Error(ErrorKind::bad_input,
                    {message, place_, "a tag reads 't crease 2/1/0 FIRST SECOND SHARPNESS'"});
    }

    std::string_view next_word() {
        rest_.remove_prefix(std::min(rest_.find_first_not_of(kSpaces), rest_.size()));
        const std::string_view word = rest_.substr(0, rest_.find_first_of(kSpaces));
        rest_.remove_prefix(word.size());
        return word;
    }

    template <class T> T next_number() {
        const std::string_view word = next_word();
        T value{};
        const auto [stop, code] = std::from_chars(word.data(), word.data() + word.size(), value);
        if (word.empty() || stop != word.data() + word.size() || code != std::errc())
            fail(fmt::format("'{}' stands where a number must be", word));
        return value;
    }

    /// The counts of whole and of real numbers.
    std::pair<size_t, size_t> next_counts() {
        std::string_view word = next_word();
        size_t counts[2] = {0, 0};
        for (size_t& count : counts) {
            const auto [stop, code] = std::from_chars(word.data(), word.data() + word.size(), count);
            const auto used = size_t(stop - word.data());
            // Each number takes a space and a digit.
            if (code != std::errc() || used == word.size() || word[used] != '/' || count > rest_.size() / 2)
                fail("the counts of a tag are no numbers or more than its line holds");
            word.remove_prefix(used + 1);
        }
        return {counts[0], counts[1]};
    }

  private:
    std::string_view rest_;
    std::string place_;
};

class TagReader {
  public:
    TagReader(size_t position_count, const std::string& name)
        : position_count_(position_count), name_(name) {}

    void read(std::string_view line, size_t number) {
        TagLine tag(line, fmt::format("{}, line {}", name_, number));
        if (tag.next_word() != "t") return;
        const std::string_view kind = tag.next_word();
        if (kind == "crease")
            add(tag, 2);
        else if (kind == "corner")
            add(tag, 1);
    }
    std::vector<Crease>& creases() { return creases_; }

  private:
    void add(TagLine& tag, size_t ends) {
        const auto [index_count, real_count] = tag.next_counts();
        const size_t crease_count = index_count / ends;
        if (index_count % ends != 0 || (real_count != 1 && real_count != crease_count))
            tag.fail(fmt::format("{} positions with {} sharpnesses", index_count, real_count));
        const size_t begin = creases_.size();
        for (size_t k = 0; k < crease_count; ++k) {
            Crease crease;
            crease.first = crease.second = read_index(tag);
            if (ends == 2) crease.second = read_index(tag);
            if (ends == 2 && crease.first == crease.second) tag.fail("a crease needs two positions");
            creases_.push_back(crease);
        }
        for (size_t k = 0; k < real_count; ++k) {
            const float sharpness = tag.next_number<float>();
            if (!std::isfinite(sharpness)) tag.fail("a sharpness must be finite");
            const size_t last = real_count == 1 ? crease_count : k + 1;
            for (size_t j = k; j < last; ++j) creases_[begin + j].sharpness = std::max(sharpness, 0.0f);
        }
    }

    uint32_t read_index(TagLine& tag) const {
        const auto index = tag.next_number<uint64_t>();
        if (index >= position_count_)
            tag.fail(fmt::format("position {} is out of range: there are {}, counted from 0", index,
                                 position_count_));
        return uint32_t(index);
    }

    size_t position_count_;
    const std::string& name_;
    std::vector<Crease> creases_;
};

} // namespace

std::vector<Crease> parse_obj_creases(std::string_view text, size_t position_count, const std::string& name) {
    TagReader reader(position_count, name);
    for (size_t number = 1; !text.empty(); ++number) {
        const std::string_view line = text.substr(0, text.find('\n'));
        const size_t begin = line.find_first_not_of(kSpaces);
        if (begin != std::string_view::npos && line[begin] == 't') reader.read(line, number);
        text.remove_prefix(std::min(line.size() + 1, text.size()));
    }
    return std::move(reader.creases());
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
