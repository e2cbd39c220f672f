// Settings as keywords: one table with the names that the command's long options have.
#pragma once

#include <string>

#include <nanobind/nanobind.h>

#include "relief/intersect.h"
#include "relief/render.h"

namespace relief::python {

/// Those of `keywords` that are not None over those of the scene file over the defaults. Throws Error{usage}
/// for an unknown name or a value of another kind; ranges are checked by who takes the settings.
RenderSettings read_settings(const nanobind::dict& keywords, const PictureDefaults& picture);
/// The same; what is of pictures alone is refused.
IntersectorSettings read_ray_settings(const nanobind::dict& keywords);

/// Names of settings in a text become keywords: "image.spp" to "spp".
std::string name_keywords(std::string text);

} // namespace relief::python
