// The extension relief._relief: what the Python files of the package are a surface of.
#include <nanobind/nanobind.h>

#include "exit_gate.h"
#include "parts.h"
#include "relief/version.h"

NB_MODULE(_relief, module) {
    using namespace relief::python;
    nanobind::set_leak_warnings(false); // of objects that daemon threads hold when Python ends
    module.attr("version") = RELIEF_VERSION_STRING;
    add_errors(module);
    add_pictures(module);
    add_scenes(module);
    add_renders(module);
    add_live_scenes(module);
    add_rays(module);
    add_tools(module);
    module.def("_close", &close_gate);
    nanobind::module_::import_("atexit").attr("register")(module.attr("_close"));
}
