// Pictures that are decoded row by row, and turned as the orientation that their file names says.
#pragma once

#include <functional>
#include <string>

#include "io/picture/picture_remarks.h"
#include "io/picture/pixel_source.h"

namespace relief {

/// How the rows of a file lie in the picture (TIFF 6.0, tag Orientation): 1 as they are, 8 the last one.
inline constexpr int kUpright = 1, kLastOrientation = 8;

class RowSource : public PixelSource {
  public:
    const PixelHeader& header() const final { return header_; }
    void read_floats(int channel_count, size_t stride, float* values) final;
    void read_halves(int channel_count, size_t stride, uint16_t* values) final;

  protected:
    /// Gets each row of the file, from the first one on, with all channels of each pixel.
    using VisitRow = std::function<void(int row, const float* values)>;
    virtual void decode(const VisitRow& visit) = 0;

    /// For constructors, once the header has the size of the file: turns it, and notes that in `remarks`.
    /// Any other number counts as upright.
    void turn(int orientation, const std::string& name, PictureRemarks& remarks);

    PixelHeader header_;

  private:
    template <class Value, class Convert>
    void read(int channel_count, size_t stride, Value* values, const Convert& convert);

    int orientation_ = kUpright;
};

} // namespace relief
