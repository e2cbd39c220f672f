// Bytes of a PLY file must end in a mesh that holds together or in an Error.
#include <string_view>

#include "io/mesh/mesh_ply.h"
#include "mesh_checks.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    try {
        relief::check_mesh(relief::parse_ply({reinterpret_cast<const char*>(data), size}, "fuzz.ply"));
    } catch (const relief::Error&) {
        // refused with a message: what is wanted
    }
    return 0;
}
