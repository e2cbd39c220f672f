#include "io/picture/jpeg_source.h"

#include <array>
#include <csetjmp>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <iterator>
#include <new>
#include <utility>
#include <vector>

#include <jerror.h>
#include <jpeglib.h>

#include <fmt/format.h>

#include "io/count_things.h"
#include "io/picture/exif_orientation.h"
#include "io/picture/jpeg_end.h"
#include "io/picture/picture_error.h"
#include "io/picture/picture_text.h"
#include "io/picture/row_source.h"
#include "relief/error.h"

namespace relief {

namespace {

/// Holds libjpeg's error manager, the place that it jumps to, and its messages.
struct Errors {
    jpeg_error_mgr manager; ///< first, so that a pointer to it is one to this
    std::jmp_buf place;
    std::array<char, JMSG_LENGTH_MAX> message{}, first_warning{};
    int warning_count = 0;
    bool has_odd_colors =
        false; ///< the marker of Adobe's programs names a transform that libjpeg does not know
};

constexpr int kMostScans = 500; ///< a small file of many scans takes hours (libjpeg-turbo, README)

[[noreturn]] void on_error(j_common_ptr info) {
    auto& errors = *reinterpret_cast<Errors*>(info->err);
    info->err->format_message(info, errors.message.data());
    std::longjmp(errors.place, 1);
}

void on_message(j_common_ptr info, int level) {
    if (level >= 0) return; // a trace
    auto& errors = *reinterpret_cast<Errors*>(info->err);
    errors.has_odd_colors |= info->err->msg_code == JWRN_ADOBE_XFORM;
    if (errors.warning_count++ == 0) info->err->format_message(info, errors.first_warning.data());
}

/// libjpeg calls this several times per scan.
void check_scans(j_common_ptr info) {
    if (reinterpret_cast<j_decompress_ptr>(info)->input_scan_number <= kMostScans) return;
    auto& errors = *reinterpret_cast<Errors*>(info->err);
    std::snprintf(errors.message.data(), errors.message.size(), "it has more than %d scans", kMostScans);
    info->err->msg_code = 0;
    std::longjmp(errors.place, 1);
}

class JpegSource final : public RowSource {
  public:
    JpegSource(std::vector<uint8_t> bytes, std::string name, PictureRemarks& remarks)
        : name_(std::move(name)), bytes_(std::move(bytes)) {
        info_.err = jpeg_std_error(&errors_.manager);
        errors_.manager.error_exit = on_error;
        errors_.manager.emit_message = on_message;
        try {
            run([&] {
                jpeg_create_decompress(&info_);
                progress_.progress_monitor = check_scans;
                info_.progress = &progress_;
                jpeg_save_markers(&info_, JPEG_APP0 + 1, 0xffff);
                read_header();
            });
            fill_header(remarks);
        } catch (...) {
            jpeg_destroy_decompress(&info_);
            throw;
        }
    }
    ~JpegSource() override { jpeg_destroy_decompress(&info_); }
    JpegSource(const JpegSource&) = delete;
    JpegSource& operator=(const JpegSource&) = delete;

    std::vector<std::string> list_warnings() const override {
        if (errors_.warning_count == 0) return {};
        return {fmt::format("{}: is damaged, and parts of the picture may be wrong: libjpeg reports {}, "
                            "the first is '{}': export or copy it again",
                            name_, count_things(size_t(errors_.warning_count), "fault"),
                            make_printable(errors_.first_warning.data()))};
    }

  private:
    /// `call` uses libjpeg and makes no object with a destructor: a jump would pass it by.
    template <class Call> void run(const Call& call) {
        if (setjmp(errors_.place) == 0) {
            call();
            return;
        }
        if (info_.err->msg_code == JERR_OUT_OF_MEMORY) throw std::bad_alloc();
        fail_damaged(name_, std::string("cannot be read: ") + errors_.message.data());
    }

    void read_header() {
        jpeg_mem_src(&info_, bytes_.data(), static_cast<unsigned long>(bytes_.size()));
        jpeg_read_header(&info_, TRUE);
    }

    void fill_header(PictureRemarks& remarks) {
        const bool is_grey = info_.jpeg_color_space == JCS_GRAYSCALE;
        const bool is_cmyk = info_.jpeg_color_space == JCS_CMYK || info_.jpeg_color_space == JCS_YCCK;
        if (!is_grey && !is_cmyk && info_.jpeg_color_space != JCS_YCbCr && info_.jpeg_color_space != JCS_RGB)
            throw Error(ErrorKind::bad_input,
                        {fmt::format("has {} components of no known colours", info_.num_components), name_,
                         "save it as grey, RGB or CMYK"});
        space_ = is_grey ? JCS_GRAYSCALE : is_cmyk ? JCS_CMYK : JCS_RGB;
        header_.width = header_.full_width = int(info_.image_width);
        header_.height = header_.full_height = int(info_.image_height);
        header_.type = SampleType::uint8;
        header_.channels = is_grey ? std::vector<std::string>{"Y"} : std::vector<std::string>{"R", "G", "B"};
        header_.pixel_bytes = header_.channels.size();
        if (is_cmyk) remarks.warnings.push_back(describe_inks(name_));
        if (errors_.has_odd_colors)
            remarks.warnings.push_back(fmt::format(
                "{}: its marker of Adobe's programs names an unknown colour transform ({}), so that "
                "colours may be wrong: save it again as RGB",
                name_, int(info_.Adobe_transform)));
        int orientation = kUpright;
        for (const jpeg_marker_struct* marker = info_.marker_list; marker; marker = marker->next)
            if (const int found = find_exif_orientation({marker->data, marker->data_length}))
                orientation = found;
        turn(orientation, name_, remarks);
    }

    void decode(const VisitRow& visit) override {
        if (is_read_) run([&] { jpeg_abort_decompress(&info_), read_header(); });
        is_read_ = true;
        // Warnings of the header change no pixel, except has_odd_colors, which is reported with the header.
        errors_.warning_count = 0;
        run([&] {
            info_.out_color_space = space_;
            jpeg_start_decompress(&info_);
        });
        const size_t count = size_t(info_.output_width) * header_.channels.size();
        std::vector<uint8_t> row(size_t(info_.output_width) * size_t(info_.output_components));
        std::vector<float> values(count);
        while (info_.output_scanline < info_.output_height) {
            const int y = int(info_.output_scanline);
            uint8_t* rows[] = {row.data()};
            run([&] { jpeg_read_scanlines(&info_, rows, 1); });
            if (space_ == JCS_CMYK) remove_inks(row);
            for (size_t k = 0; k < count; ++k) values[k] = float(row[k]) * (1.0f / 255);
            visit(y, values.data());
        }
        run([&] { jpeg_finish_decompress(&info_); });
    }

    /// Converts four inks per pixel to RGB in place, without a profile. Adobe's programs store the light that
    /// each ink leaves; other programs store the light that it absorbs.
    void remove_inks(std::vector<uint8_t>& row) const {
        const auto find_light = [&](uint8_t ink) { return info_.saw_Adobe_marker ? ink : 255 - ink; };
        for (size_t pixel = 0; pixel < row.size() / 4; ++pixel) {
            const int black = find_light(row[4 * pixel + 3]);
            for (size_t c = 0; c < 3; ++c)
                row[3 * pixel + c] = uint8_t((find_light(row[4 * pixel + c]) * black + 127) / 255);
        }
    }

    std::string name_;
    std::vector<uint8_t> bytes_;
    Errors errors_{};
    jpeg_decompress_struct info_{};
    jpeg_progress_mgr progress_{};
    J_COLOR_SPACE space_ = JCS_RGB;
    bool is_read_ = false;
};

} // namespace

std::unique_ptr<PixelSource> open_jpeg(std::unique_ptr<std::istream> stream, const std::string& name,
                                       PictureRemarks& remarks) {
    std::array<char, 2> start{};
    stream->read(start.data(), 2);
    if (!*stream || start[0] != '\xff' || start[1] != '\xd8') return nullptr;
    stream->seekg(0);
    if (!has_jpeg_end(*stream)) fail_damaged(name, "ends in the middle of its picture");
    stream->clear();
    stream->seekg(0);
    std::vector<uint8_t> bytes((std::istreambuf_iterator<char>(*stream)), std::istreambuf_iterator<char>());
    return std::make_unique<JpegSource>(std::move(bytes), name, remarks);
}

} // namespace relief
