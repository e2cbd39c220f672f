// What the module is made of: each adds its classes and functions.
#pragma once

#include <nanobind/nanobind.h>

namespace relief::python {

void add_errors(nanobind::module_& module);
void add_pictures(nanobind::module_& module);
void add_scenes(nanobind::module_& module);
void add_renders(nanobind::module_& module);
void add_live_scenes(nanobind::module_& module);
void add_rays(nanobind::module_& module);
void add_tools(nanobind::module_& module);

} // namespace relief::python
