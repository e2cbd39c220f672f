// Pictures as Python has them: the pixels stay where the library made them.
#pragma once

#include <mutex>
#include <utility>

#include <nanobind/nanobind.h>

#include "relief/image.h"

namespace relief::python {

struct Picture {
    Image image;
    std::mutex mutex; ///< of its metadata while it is written

    explicit Picture(Image&& made) : image(std::move(made)) {}
};

nanobind::object make_picture(Image&& image);

} // namespace relief::python
