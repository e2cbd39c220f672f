// Colour transforms of OpenColorIO.
#pragma once

#include <memory>

#include "io/picture/picture_library.h"

namespace relief {

/// PictureLibrary::make_aces_display. Throws Error{failed} where the library does not know the transform.
std::unique_ptr<ColorTransform> make_ocio_aces_display();

/// PictureLibrary::make_color_space.
std::unique_ptr<ColorTransform> make_ocio_color_space(const std::string& name, ColorWay way);

} // namespace relief
