// OBJ text must end in a mesh that holds together or in an Error.
#include <string_view>

#include "io/mesh/mesh_obj.h"
#include "mesh_checks.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    try {
        relief::check_mesh(relief::parse_obj({reinterpret_cast<const char*>(data), size}, "fuzz.obj"));
    } catch (const relief::Error&) {
        // refused with a message: what is wanted
    }
    return 0;
}
