#include "pictures.h"

#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include <nanobind/stl/map.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>

#include "arrays.h"
#include "exit_gate.h"
#include "parts.h"
#include "relief/io.h"
#include "textures.h"

namespace nb = nanobind;

namespace relief::python {

namespace {

nb::object view_pixels(nb::handle self) {
    Image& image = nb::cast<Picture&>(self).image;
    return view_memory<float>(image.pixels.data(),
                              {size_t(image.height), size_t(image.width), image.channels.size()}, self);
}

/// With more entries of the header than the picture has.
void save_picture(Picture& picture, const std::string& file,
                  const std::map<std::string, std::string>& entries) {
    const GateVisit visit;
    const nb::gil_scoped_release release;
    const std::lock_guard lock(picture.mutex);
    picture.image.metadata = picture.metadata;
    for (const auto& [key, value] : entries) picture.image.metadata[key] = value;
    write_image(picture.image, file);
}

nb::object read_picture(const std::string& file) {
    Image image;
    {
        const GateVisit visit;
        const nb::gil_scoped_release release;
        image = read_image(file);
    }
    return make_picture(std::move(image));
}

nb::object read_texels(const std::string& file) {
    Texture texture;
    {
        const GateVisit visit;
        const nb::gil_scoped_release release;
        texture = read_texture(file);
    }
    return make_texel_array(texture);
}

} // namespace

nb::object make_picture(Image&& image) { return nb::cast(std::make_unique<Picture>(std::move(image))); }

void add_pictures(nb::module_& module) {
    nb::class_<Picture>(module, "Image", "Pixels of a picture with named channels.")
        .def("array", [](nb::handle self) { return view_pixels(self); })
        .def("save", &save_picture, nb::arg("file"), nb::arg("entries"))
        .def_prop_ro("channels", [](const Picture& p) { return p.image.channels; })
        .def_prop_ro("window",
                     [](const Picture& p) {
                         return nb::make_tuple(p.image.x0, p.image.y0, p.image.x0 + p.image.width,
                                               p.image.y0 + p.image.height);
                     })
        .def_prop_ro("full_size",
                     [](const Picture& p) { return nb::make_tuple(p.image.full_width, p.image.full_height); })
        .def_prop_ro("metadata", [](const Picture& p) { return p.metadata; });
    module.def("read_image", &read_picture, nb::arg("file"));
    module.def("read_texture", &read_texels, nb::arg("file"));
}

} // namespace relief::python
