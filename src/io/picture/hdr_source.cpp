#include "io/picture/hdr_source.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "io/picture/picture_error.h"
#include "io/picture/picture_text.h"
#include "io/picture/row_source.h"

namespace relief {

namespace {

using Rgbe = std::array<uint8_t, 4>;

/// A line of the header, without its end; nothing where it is too long or the file ends.
std::optional<std::string> read_line(std::istream& stream) {
    constexpr size_t kLongest = 4096;
    std::string line;
    for (int c = stream.get(); c != '\n'; c = stream.get()) {
        if (c == std::istream::traits_type::eof() || line.size() == kLongest) return std::nullopt;
        line.push_back(char(c));
    }
    if (!line.empty() && line.back() == '\r') line.pop_back();
    return line;
}

/// Size and run of scan lines, as "-Y 512 +X 1024" gives them.
struct Resolution {
    int width = 0, height = 0, orientation = kUpright;
};

std::optional<Resolution> parse_resolution(const std::string& line) {
    char first = 0, second = 0, first_sign = 0, second_sign = 0;
    int lines = 0, columns = 0;
    if (std::sscanf(line.c_str(), "%c%c %d %c%c %d", &first_sign, &first, &lines, &second_sign, &second,
                    &columns) != 6)
        return std::nullopt;
    const auto is_sign = [](char c) { return c == '+' || c == '-'; };
    if (!is_sign(first_sign) || !is_sign(second_sign) || lines <= 0 || columns <= 0) return std::nullopt;
    Resolution result{columns, lines, kUpright};
    if (first == 'Y' && second == 'X')
        result.orientation = first_sign == '-' ? (second_sign == '+' ? 1 : 2) : (second_sign == '+' ? 4 : 3);
    else if (first == 'X' && second == 'Y')
        result.orientation = first_sign == '+' ? (second_sign == '-' ? 5 : 8) : (second_sign == '-' ? 6 : 7);
    else
        return std::nullopt;
    return result;
}

class HdrSource final : public RowSource {
  public:
    HdrSource(std::unique_ptr<std::istream> stream, std::string name, const Resolution& resolution,
              PictureRemarks& remarks)
        : name_(std::move(name)),
          stream_(std::move(stream)),
          first_row_(stream_->tellg()),
          width_(size_t(resolution.width)),
          height_(resolution.height) {
        header_.width = header_.full_width = resolution.width;
        header_.height = header_.full_height = resolution.height;
        header_.type = SampleType::float32;
        header_.pixel_bytes = 4;
        header_.channels = {"R", "G", "B"};
        turn(resolution.orientation, name_, remarks);
    }

  private:
    void decode(const VisitRow& visit) override {
        stream_->clear();
        stream_->seekg(first_row_);
        std::vector<Rgbe> row(width_);
        std::vector<float> values(3 * width_);
        for (int y = 0; y < height_; ++y) {
            read_row(row);
            for (size_t x = 0; x < width_; ++x) {
                const float unit = row[x][3] == 0 ? 0.0f : std::ldexp(1.0f, int(row[x][3]) - (128 + 8));
                for (size_t c = 0; c < 3; ++c) values[3 * x + c] = float(row[x][c]) * unit;
            }
            visit(y, values.data());
        }
    }

    [[noreturn]] void fail() const {
        fail_damaged(name_, "cannot be read: a row is damaged, or ends too early");
    }

    uint8_t read_byte() {
        const int byte = stream_->rdbuf()->sbumpc();
        if (byte == std::istream::traits_type::eof()) fail();
        return uint8_t(byte);
    }

    Rgbe read_pixel() { return {read_byte(), read_byte(), read_byte(), read_byte()}; }

    void read_row(std::vector<Rgbe>& row) {
        constexpr size_t kLeastRuns = 8, kMostRuns = 0x7fff;
        const Rgbe first = read_pixel();
        const bool has_runs = width_ >= kLeastRuns && width_ <= kMostRuns && first[0] == 2 && first[1] == 2 &&
                              (size_t(first[2]) << 8 | first[3]) == width_;
        if (!has_runs) return read_plain_row(first, row);
        for (size_t c = 0; c < 4; ++c) {
            for (size_t x = 0; x < width_;) {
                size_t count = read_byte();
                const bool is_run = count > 128;
                if (is_run) count -= 128;
                if (count == 0 || count > width_ - x) fail();
                const uint8_t value = is_run ? read_byte() : 0;
                for (size_t end = x + count; x < end; ++x) row[x][c] = is_run ? value : read_byte();
            }
        }
    }

    /// Pixels one by one; (1, 1, 1, n) repeats the last one n times, more such in a row by higher digits.
    void read_plain_row(const Rgbe& first, std::vector<Rgbe>& row) {
        unsigned shift = 0;
        Rgbe pixel = first;
        for (size_t x = 0; x < width_;) {
            if (pixel[0] == 1 && pixel[1] == 1 && pixel[2] == 1) {
                const uint64_t count = shift > 24 ? width_ + 1 : uint64_t(pixel[3]) << shift;
                if (x == 0 || count > width_ - x) fail();
                for (size_t end = x + size_t(count); x < end; ++x) row[x] = row[x - 1];
                shift += 8;
            } else {
                row[x++] = pixel;
                shift = 0;
            }
            if (x < width_) pixel = read_pixel();
        }
    }

    std::string name_;
    std::unique_ptr<std::istream> stream_;
    std::streamoff first_row_;
    size_t width_;
    int height_;
};

} // namespace

std::unique_ptr<PixelSource> open_hdr(std::unique_ptr<std::istream> stream, const std::string& name,
                                      PictureRemarks& remarks) {
    std::array<char, 2> start{};
    stream->read(start.data(), 2);
    if (!*stream || start[0] != '#' || start[1] != '?') return nullptr;
    constexpr int kMostLines = 1000;
    for (int k = 0; k < kMostLines; ++k) {
        const std::optional<std::string> line = read_line(*stream);
        if (!line) break;
        if (line->starts_with("FORMAT=") && *line != "FORMAT=32-bit_rle_rgbe")
            throw Error(ErrorKind::bad_input,
                        {fmt::format("has other values than RGBE ({})", make_printable(*line)), name,
                         "save it as Radiance RGBE or as EXR"});
        if (k == 0 || !line->empty()) continue;
        const std::optional<std::string> size = read_line(*stream);
        const std::optional<Resolution> resolution = size ? parse_resolution(*size) : std::nullopt;
        if (!resolution) fail_damaged(name, "cannot be opened: its header names no size");
        return std::make_unique<HdrSource>(std::move(stream), name, *resolution, remarks);
    }
    fail_damaged(name, "cannot be opened: its header does not end");
}

} // namespace relief
