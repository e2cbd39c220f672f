// Pixels of one layer of an EXR file, by OpenEXR.
#pragma once

#include <istream>
#include <memory>
#include <string>
#include <vector>

#include <OpenEXR/ImfMultiPartInputFile.h>

#include "io/picture/exr_stream.h"
#include "io/picture/pixel_source.h"

namespace relief {

/// Pixels from `least` to `greatest`, inclusive, of a window.
int count_exr_pixels(int least, int greatest);

/// An EXR file with any number of parts. All functions throw what OpenEXR throws.
class ExrParts {
  public:
    ExrParts(std::unique_ptr<std::istream> stream, const std::string& name);
    const Imf::MultiPartInputFile& file() const { return file_; }
    /// Channels of a part with flat pixels, by their whole names. Throws Error{bad_input} for channels with
    /// fewer samples than pixels. The source keeps `parts`, which is this.
    static std::unique_ptr<PixelSource> open(std::unique_ptr<ExrParts> parts, int part,
                                             std::vector<std::string> channels);

  private:
    friend class ExrLayerSource;
    std::string name_;
    ExrInputStream stream_;
    Imf::MultiPartInputFile file_;
};

/// R, G, B and perhaps A of a layer of luminance and chroma (Y, RY, BY) in a file of one part.
std::unique_ptr<PixelSource> open_exr_chroma(std::unique_ptr<std::istream> stream, const std::string& name,
                                             const std::string& layer);

} // namespace relief
