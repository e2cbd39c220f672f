// relief::Error as the Python exception relief.Error.
#include <exception>
#include <string>

#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>

#include "parts.h"
#include "relief/error.h"
#include "settings.h"

namespace nb = nanobind;

namespace relief::python {

namespace {

const char* name_kind(ErrorKind kind) {
    switch (kind) {
    case ErrorKind::usage:
        return "usage";
    case ErrorKind::bad_input:
        return "bad_input";
    case ErrorKind::device_missing:
        return "device_missing";
    case ErrorKind::out_of_memory:
        return "out_of_memory";
    case ErrorKind::failed:
        break;
    }
    return "failed";
}

nb::object make_parts(const Error::Parts& parts) {
    return nb::make_tuple(name_keywords(parts.message), name_keywords(parts.where),
                          name_keywords(parts.hint));
}

void translate(const std::exception_ptr& pointer, void*) {
    try {
        std::rethrow_exception(pointer);
    } catch (const Error& error) {
        nb::list further;
        for (const Error::Parts& parts : error.further()) further.append(make_parts(parts));
        const nb::object type = nb::module_::import_("relief._errors").attr("Error");
        const nb::object made =
            type(name_keywords(error.message()), nb::arg("kind") = name_kind(error.kind()),
                 nb::arg("where") = name_keywords(error.where()),
                 nb::arg("hint") = name_keywords(error.hint()), nb::arg("further") = further);
        PyErr_SetObject(type.ptr(), made.ptr());
    }
}

} // namespace

void add_errors(nb::module_&) { nb::register_exception_translator(translate); }

} // namespace relief::python
