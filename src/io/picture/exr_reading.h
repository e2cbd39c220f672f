// Code that all readers of EXR files share: windows of headers, and pixels of an open file or part.
#pragma once

#include <cstddef>
#include <exception>
#include <new>
#include <string>

#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <fmt/format.h>

#include "io/picture/exr_pixels.h"
#include "io/picture/picture_error.h"
#include "io/picture/pixel_source.h"

namespace relief {

/// Copies the data and the display window; `Windows` is PixelHeader or PicturePart.
template <class Windows> void set_exr_windows(const Imf::Header& exr, Windows& windows) {
    const Imath::Box2i &data = exr.dataWindow(), &display = exr.displayWindow();
    windows.x = data.min.x, windows.y = data.min.y;
    windows.width = count_exr_pixels(data.min.x, data.max.x);
    windows.height = count_exr_pixels(data.min.y, data.max.y);
    windows.full_x = display.min.x, windows.full_y = display.min.y;
    windows.full_width = count_exr_pixels(display.min.x, display.max.x);
    windows.full_height = count_exr_pixels(display.min.y, display.max.y);
}

/// Calls `work`. Throws bad_input, which calls the file damaged, for what OpenEXR throws except bad_alloc.
template <class Work> void read_exr(const std::string& name, const Work& work) {
    try {
        work();
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        fail_damaged(name, fmt::format("cannot be read: {}", error.what()));
    }
}

/// Pixels of an open Imf::InputFile or Imf::InputPart.
template <class File> class ExrPixelSource : public PixelSource {
  public:
    const PixelHeader& header() const final { return header_; }
    void read_floats(int channel_count, size_t stride, float* values) final {
        read(Imf::FLOAT, channel_count, stride * sizeof(float), sizeof(float), values);
    }
    void read_halves(int channel_count, size_t stride, uint16_t* values) final {
        read(Imf::HALF, channel_count, stride * sizeof(uint16_t), sizeof(uint16_t), values);
    }

  protected:
    virtual File& file() = 0;
    virtual const std::string& name() const = 0;
    PixelHeader header_;

  private:
    void read(Imf::PixelType type, int channel_count, size_t stride_bytes, size_t value_bytes, void* values) {
        read_exr(name(), [&] {
            Imf::FrameBuffer buffer;
            const Imath::Box2i& window = file().header().dataWindow();
            for (int c = 0; c < channel_count; ++c)
                buffer.insert(header_.channels[size_t(c)],
                              Imf::Slice::Make(type, static_cast<char*>(values) + size_t(c) * value_bytes,
                                               window, stride_bytes, stride_bytes * size_t(header_.width)));
            file().setFrameBuffer(buffer);
            file().readPixels(window.min.y, window.max.y);
        });
    }
};

} // namespace relief
