// The module relief_pictures: pixels as stored, without any colour or alpha conversion.
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include "io/picture/module/color_transform_ocio.h"
#include "io/picture/picture_error.h"
#include "io/picture/picture_library.h"

namespace relief {

namespace {

OIIO::ImageSpec make_raw_config() {
    OIIO::ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha", 1);
    config.attribute("oiio:RawColor", 1);
    return config;
}

SampleType get_sample_type(const OIIO::TypeDesc& type) {
    switch (type.basetype) {
    case OIIO::TypeDesc::UINT8:
    case OIIO::TypeDesc::INT8:
        return SampleType::uint8;
    case OIIO::TypeDesc::UINT16:
    case OIIO::TypeDesc::INT16:
        return SampleType::uint16;
    case OIIO::TypeDesc::UINT32:
    case OIIO::TypeDesc::INT32:
        return SampleType::uint32;
    case OIIO::TypeDesc::HALF:
        return SampleType::float16;
    default:
        return SampleType::float32;
    }
}

/// Header entries of other programs' making (compression, library hints) are not the picture's.
bool is_own_metadata(const std::string& name) {
    return name != "compression" && !name.starts_with("oiio:") && !name.starts_with("openexr:");
}

PixelHeader make_header(const OIIO::ImageSpec& spec) {
    PixelHeader header;
    header.x = spec.x, header.y = spec.y, header.width = spec.width, header.height = spec.height;
    header.full_x = spec.full_x, header.full_y = spec.full_y;
    header.full_width = spec.full_width, header.full_height = spec.full_height;
    header.depth = spec.depth;
    header.is_deep = spec.deep;
    header.type = get_sample_type(spec.format);
    header.pixel_bytes = spec.pixel_bytes();
    header.channels = spec.channelnames;
    for (const OIIO::ParamValue& entry : spec.extra_attribs) {
        const std::string name = entry.name().string();
        if (entry.type() == OIIO::TypeString && is_own_metadata(name))
            header.metadata[name] = entry.get_string();
    }
    return header;
}

/// OpenImageIO 2.4 takes a negative offset, as in damaged tables of chunks, for a place in memory.
class MemoryReader final : public OIIO::Filesystem::IOMemReader {
  public:
    using IOMemReader::IOMemReader;

    bool seek(int64_t offset) override { return holds(offset) && IOMemReader::seek(offset); }
    size_t pread(void* bytes, size_t count, int64_t offset) override {
        return holds(offset) ? IOMemReader::pread(bytes, count, offset) : 0;
    }
    size_t read(void* bytes, size_t count) override {
        const size_t done = pread(bytes, count, m_pos);
        m_pos += int64_t(done);
        return done;
    }

  private:
    bool holds(int64_t offset) const { return offset >= 0 && uint64_t(offset) <= size(); }
};

std::string get_first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

class OiioSource final : public PixelSource {
  public:
    explicit OiioSource(std::string name) : name_(std::move(name)) { open(); }
    OiioSource(std::string name, std::string_view bytes)
        : name_(std::move(name)), proxy_(std::make_unique<MemoryReader>(bytes.data(), bytes.size())) {
        open();
    }

    const PixelHeader& header() const override { return header_; }
    void read_floats(int channel_count, size_t stride, float* values) override {
        read(OIIO::TypeDesc::FLOAT, channel_count, stride * sizeof(float), values);
    }
    void read_halves(int channel_count, size_t stride, uint16_t* values) override {
        read(OIIO::TypeDesc::HALF, channel_count, stride * sizeof(uint16_t), values);
    }

  private:
    void open() {
        const OIIO::ImageSpec config = make_raw_config();
        input_ = OIIO::ImageInput::create(name_, false, &config, proxy_.get());
        if (!input_) fail_damaged(name_, "cannot be opened: " + OIIO::geterror());
        if (proxy_) input_->set_ioproxy(proxy_.get());
        OIIO::ImageSpec spec;
        if (!input_->open(name_, spec, config))
            fail_damaged(name_, "cannot be opened: " + input_->geterror());
        header_ = make_header(spec);
    }

    void read(const OIIO::TypeDesc& type, int channel_count, size_t stride_bytes, void* values) {
        if (!input_->read_image(0, 0, 0, channel_count, type, values, OIIO::stride_t(stride_bytes)))
            fail_damaged(name_, "cannot be read: " + get_first_line(input_->geterror()));
    }

    std::string name_;
    std::unique_ptr<MemoryReader> proxy_; ///< of pictures in memory; outlives the input
    std::unique_ptr<OIIO::ImageInput> input_;
    PixelHeader header_;
};

class OiioLibrary final : public PictureLibrary {
  public:
    std::unique_ptr<PixelSource> open_file(const std::string& file) const override {
        return std::make_unique<OiioSource>(file);
    }
    std::unique_ptr<PixelSource> open_bytes(std::string_view bytes, const std::string& name) const override {
        return std::make_unique<OiioSource>(name, bytes);
    }
    std::unique_ptr<ColorTransform> make_aces_display() const override { return make_ocio_aces_display(); }
    std::unique_ptr<ColorTransform> make_color_space(const std::string& name, ColorWay way) const override {
        return make_ocio_color_space(name, way);
    }
};

} // namespace

} // namespace relief

extern "C" const relief::PictureLibrary* RELIEF_PICTURE_LIBRARY_ENTRY() {
    static const relief::OiioLibrary library;
    return &library;
}
