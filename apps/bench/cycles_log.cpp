#include "bench/cycles_log.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "relief/error.h"

namespace relief::bench {

namespace {

constexpr std::string_view kVersion = "relief: blender ", kStart = "relief: render starts",
                           kEnd = "relief: render ends", kResident = "relief: peak resident ";
constexpr size_t kQuotedLines = 5;

bool has(const LogLine& line, std::string_view words) { return line.text.find(words) != std::string::npos; }

bool starts_with(const LogLine& line, std::string_view words) { return line.text.rfind(words, 0) == 0; }

/// The number after the last `words` of a line.
template <class T> std::optional<T> read_number(std::string_view text, std::string_view words) {
    const size_t place = text.rfind(words);
    if (place == std::string_view::npos) return {};
    T value{};
    const char* begin = text.data() + place + words.size();
    const auto [end, code] = std::from_chars(begin, text.data() + text.size(), value);
    return code == std::errc() && end != begin ? std::optional<T>(value) : std::nullopt;
}

/// Every status line ends the activity named in the previous one.
class Reader {
  public:
    explicit Reader(std::span<const LogLine> lines) : lines_(lines) {}

    CyclesTimes read() {
        for (const LogLine& line : lines_) read_line(line);
        if (!start_ || !sampling_ || !sample_ || !end_ || times_.resident_peak_bytes == 0)
            throw Error(ErrorKind::failed, {"the log of Blender tells no finished render", quote_end(),
                                            "Blender 3.4 is what the script was made for"});
        times_.synchronisation_s = *sampling_ - *start_;
        times_.first_sample_s = *sample_ - *start_;
        times_.render_s = *end_ - *start_;
        return times_;
    }

  private:
    void read_line(const LogLine& line) {
        if (starts_with(line, kVersion)) times_.version = line.text.substr(kVersion.size());
        if (starts_with(line, kStart)) start_ = line.seconds;
        if (starts_with(line, kEnd)) end_ = line.seconds;
        if (const auto bytes = read_number<uint64_t>(line.text, kResident))
            times_.resident_peak_bytes = *bytes;
        if (start_ && !end_ && starts_with(line, "Fra:")) read_state(line);
    }

    void read_state(const LogLine& line) {
        if (image_) times_.images_s += line.seconds - *image_;
        image_ = has(line, "Updating Images | Loading") ? std::optional(line.seconds) : std::nullopt;
        if (const auto sample = read_number<int>(line.text, "| Sample ")) {
            if (!sampling_) sampling_ = line.seconds;
            if (*sample > 0 && !sample_) sample_ = line.seconds;
        }
        if (const auto mebibytes = read_number<double>(line.text, ", Peak:"))
            times_.cycles_peak_bytes =
                std::max(times_.cycles_peak_bytes, uint64_t(*mebibytes * double(1 << 20)));
    }

    std::string quote_end() const {
        std::string text;
        for (const LogLine& line : lines_.last(std::min(lines_.size(), kQuotedLines)))
            text += (text.empty() ? "" : "\n") + line.text;
        return text;
    }

    std::span<const LogLine> lines_;
    CyclesTimes times_;
    std::optional<double> start_, sampling_, sample_, end_;
    std::optional<double> image_; ///< start of reading the current image
};

} // namespace

CyclesTimes read_cycles_log(std::span<const LogLine> lines) { return Reader(lines).read(); }

} // namespace relief::bench
