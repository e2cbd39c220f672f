#include "io/picture/exr_pixels.h"
#include "io/picture/exr_reading.h"

#include <algorithm>
#include <cstdint>
#include <exception>
#include <limits>
#include <new>
#include <utility>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfRgbaFile.h>
#include <fmt/format.h>

#include "image/texel_layout.h"
#include "io/picture/exr_threads.h"
#include "io/picture/picture_error.h"
#include "io/picture/picture_text.h"

namespace relief {

namespace {

PixelHeader make_header(const Imf::Header& exr, std::vector<std::string> channels, bool is_half) {
    PixelHeader header;
    set_exr_windows(exr, header);
    header.type = is_half ? SampleType::float16 : SampleType::float32;
    header.pixel_bytes = channels.size() * (is_half ? 2 : 4);
    header.channels = std::move(channels);
    return header;
}

} // namespace

class ExrLayerSource final : public ExrPixelSource<Imf::InputPart> {
  public:
    ExrLayerSource(std::unique_ptr<ExrParts> parts, int part, std::vector<std::string> channels)
        : parts_(std::move(parts)), part_(parts_->file_, part) {
        bool is_half = true;
        for (const std::string& name : channels) {
            const Imf::Channel& channel = part_.header().channels()[name];
            if (channel.xSampling != 1 || channel.ySampling != 1)
                throw Error(
                    ErrorKind::bad_input,
                    {fmt::format("has fewer samples of channel '{}' than pixels", make_printable(name)),
                     parts_->name_, "save it with all channels at full resolution"});
            is_half &= channel.type == Imf::HALF;
        }
        header_ = make_header(part_.header(), std::move(channels), is_half);
    }

  private:
    Imf::InputPart& file() override { return part_; }
    const std::string& name() const override { return parts_->name_; }

    std::unique_ptr<ExrParts> parts_;
    Imf::InputPart part_;
};

namespace {

class ExrChromaSource final : public PixelSource {
  public:
    ExrChromaSource(std::unique_ptr<std::istream> stream, const std::string& name, const std::string& layer)
        : name_(name), stream_(std::move(stream), name), file_(stream_, layer, prepare_exr_threads()) {
        std::vector<std::string> channels = {"R", "G", "B"};
        if ((file_.channels() & Imf::WRITE_A) != 0) channels.emplace_back("A");
        header_ = make_header(file_.header(), std::move(channels), true);
    }

    const PixelHeader& header() const override { return header_; }
    void read_floats(int channel_count, size_t stride, float* values) override {
        read(channel_count,
             [&](size_t pixel, size_t c, Imath::half value) { values[stride * pixel + c] = value; });
    }
    void read_halves(int channel_count, size_t stride, uint16_t* values) override {
        read(channel_count,
             [&](size_t pixel, size_t c, Imath::half value) { values[stride * pixel + c] = value.bits(); });
    }

  private:
    template <class Store> void read(int channel_count, const Store& store) {
        read_exr(name_, [&] {
            const Imath::Box2i& window = file_.dataWindow();
            const auto width = size_t(header_.width);
            std::vector<Imf::Rgba> row(width);
            for (int y = window.min.y; y <= window.max.y; ++y) {
                // No stride from row to row: each one has the same place.
                file_.setFrameBuffer(row.data() - ptrdiff_t(window.min.x), 1, 0);
                file_.readPixels(y);
                for (size_t x = 0; x < width; ++x) {
                    const Imath::half values[] = {row[x].r, row[x].g, row[x].b, row[x].a};
                    const size_t pixel = size_t(y - window.min.y) * width + x;
                    for (size_t c = 0; c < size_t(channel_count); ++c) store(pixel, c, values[c]);
                }
            }
        });
    }

    std::string name_;
    ExrInputStream stream_;
    Imf::RgbaInputFile file_;
    PixelHeader header_;
};

} // namespace

int count_exr_pixels(int least, int greatest) {
    return int(std::clamp<int64_t>(int64_t(greatest) - least + 1, 0, std::numeric_limits<int>::max()));
}

ExrParts::ExrParts(std::unique_ptr<std::istream> stream, const std::string& name)
    : name_(name), stream_(std::move(stream), name), file_(stream_, prepare_exr_threads()) {}

std::unique_ptr<PixelSource> ExrParts::open(std::unique_ptr<ExrParts> parts, int part,
                                            std::vector<std::string> channels) {
    return std::make_unique<ExrLayerSource>(std::move(parts), part, std::move(channels));
}

std::unique_ptr<PixelSource> open_exr_chroma(std::unique_ptr<std::istream> stream, const std::string& name,
                                             const std::string& layer) {
    return std::make_unique<ExrChromaSource>(std::move(stream), name, layer);
}

} // namespace relief
