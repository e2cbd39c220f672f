// Pictures as Python has them: the pixels stay where the library made them.
#pragma once

#include <map>
#include <mutex>
#include <string>
#include <utility>

#include <nanobind/nanobind.h>

#include "relief/image.h"

namespace relief::python {

struct Picture {
    Image image;                                       ///< its metadata: only by who holds the mutex
    const std::map<std::string, std::string> metadata; ///< its own; with other entries while it is written
    std::mutex mutex;

    explicit Picture(Image&& made) : image(std::move(made)), metadata(image.metadata) {}
};

nanobind::object make_picture(Image&& image);

} // namespace relief::python
