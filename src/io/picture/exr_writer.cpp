#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticitiesAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStringAttribute.h>

#include "io/picture/color_space.h"
#include "io/picture/exr_names.h"
#include "io/picture/exr_threads.h"
#include "io/picture/image_coders.h"

namespace relief {

namespace {

/// Keeps faults of the disk, so that what OpenEXR writes in its destructors is checked as well.
class ExrOutputStream final : public Imf::OStream {
  public:
    explicit ExrOutputStream(CheckedFile& file) : OStream("picture"), file_(file) {}
    void write(const char bytes[], int count) override { file_.write(bytes, size_t(count)); }
    uint64_t tellp() override { return file_.tell(); }
    void seekp(uint64_t position) override { file_.seek(position); }

  private:
    CheckedFile& file_;
};

void add_chromaticities(const std::string& space, Imf::Header& header) {
    const Chromaticities c = find_chromaticities(space);
    const auto make = [](const Vec2f& xy) { return Imath::V2f(xy.x, xy.y); };
    header.insert("chromaticities", Imf::ChromaticitiesAttribute(Imf::Chromaticities(
                                        make(c.red), make(c.green), make(c.blue), make(c.white))));
}

Imf::Header make_header(const Image& image) {
    const Imath::V2i first(image.x0, image.y0);
    const int full_width = image.full_width > 0 ? image.full_width : image.x0 + image.width;
    const int full_height = image.full_height > 0 ? image.full_height : image.y0 + image.height;
    Imf::Header header(Imath::Box2i(Imath::V2i(0), Imath::V2i(full_width - 1, full_height - 1)),
                       Imath::Box2i(first, first + Imath::V2i(image.width - 1, image.height - 1)));
    if (const auto space = image.metadata.find(kColorSpaceTag); space != image.metadata.end())
        add_chromaticities(space->second, header);
    for (const auto& [name, value] : image.metadata) {
        // The pixels' own attributes win; OpenEXR refuses empty names and texts for values of other types.
        const std::string attribute = get_attribute_name(name);
        const bool is_free = attribute.c_str()[0] != '\0' && header.find(attribute) == header.end();
        if (is_free) header.insert(attribute, Imf::StringAttribute(value));
    }
    return header;
}

/// Interleaved samples, `stride` of them from pixel to pixel.
struct Samples {
    Imf::PixelType type;
    const void* values;
    size_t stride;
};

void write_samples(Imf::Header header, const std::vector<std::string>& channels, const Samples& samples,
                   CheckedFile& file) {
    header.compression() = Imf::ZIP_COMPRESSION;
    const size_t value_bytes = samples.type == Imf::HALF ? 2 : 4, stride_bytes = samples.stride * value_bytes;
    const Imath::Box2i window = header.dataWindow();
    const size_t width = size_t(window.max.x - window.min.x + 1);
    Imf::FrameBuffer buffer;
    for (size_t c = 0; c < channels.size(); ++c) {
        header.channels().insert(channels[c], Imf::Channel(samples.type));
        buffer.insert(channels[c],
                      Imf::Slice::Make(samples.type,
                                       static_cast<const char*>(samples.values) + c * value_bytes, window,
                                       stride_bytes, stride_bytes * width));
    }
    ExrOutputStream stream(file);
    Imf::OutputFile output(stream, header, prepare_exr_threads());
    output.setFrameBuffer(buffer);
    output.writePixels(window.max.y - window.min.y + 1);
}

} // namespace

void encode_exr(const Image& image, CheckedFile& file) {
    write_samples(make_header(image), image.channels,
                  {Imf::FLOAT, image.pixels.data(), image.channels.size()}, file);
}

void encode_exr(const Texture& texture, CheckedFile& file) {
    std::vector<std::string> channels = {"R", "G", "B", "A"};
    channels.resize(texture.channel_count);
    if (channels.size() == 1) channels = {"Y"};
    const bool is_half = !texture.halves.empty();
    const void* values = is_half ? static_cast<const void*>(texture.halves.data()) : texture.floats.data();
    write_samples(Imf::Header(int(texture.width), int(texture.height)), channels,
                  {is_half ? Imf::HALF : Imf::FLOAT, values, texture.stride}, file);
}

} // namespace relief
