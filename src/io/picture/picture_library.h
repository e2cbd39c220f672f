// Loads relief_pictures: OpenImageIO and OpenColorIO, with some 250 shared libraries, on first use of what
// only they read or know.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "io/picture/color_space.h"
#include "io/picture/pixel_source.h"
#include "relief/types.h"

namespace relief {

/// Changes colours one by one. For any thread.
class ColorTransform {
  public:
    virtual ~ColorTransform() = default;
    virtual Vec3f apply(const Vec3f& color) const = 0;
};

/// What the module offers. For any thread; may throw std::bad_alloc.
class PictureLibrary {
  public:
    virtual ~PictureLibrary() = default;
    /// Throws Error{bad_input}.
    virtual std::unique_ptr<PixelSource> open_file(const std::string& file) const = 0;
    /// The same for the bytes of a file, which must outlive the source; `name` has its extension.
    virtual std::unique_ptr<PixelSource> open_bytes(std::string_view bytes,
                                                    const std::string& name) const = 0;
    /// From linear Rec.709 to sRGB values in [0, 1]: the output transform of ACES 1.0 for SDR video.
    virtual std::unique_ptr<ColorTransform> make_aces_display() const = 0;
    /// Between linear Rec.709 and a space other than `linear` and `srgb`. Nothing where neither the library
    /// nor the configuration that the environment variable OCIO names knows it; Error{bad_input} where that
    /// is faulty.
    virtual std::unique_ptr<ColorTransform> make_color_space(const std::string& name, ColorWay way) const = 0;
};

/// The module's function that returns its library. Raise the number with every layout change of
/// PictureLibrary, ColorTransform, PixelSource and PixelHeader: other builds are then refused.
#define RELIEF_PICTURE_LIBRARY_ENTRY relief_picture_library_3

/// Loads a module, for good. Throws Error{failed} with `name` where it is missing or of another layout.
const PictureLibrary& load_picture_library(const std::string& module, const std::string& name);

/// Loads relief_pictures at first, from beside the program or the build. Throws as load_picture_library.
const PictureLibrary& get_picture_library(const std::string& name);

} // namespace relief
