// OBJ text must end in a mesh whose indices are in range or in an Error.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "io/mesh_obj.h"
#include "relief/error.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    try {
        const relief::Mesh mesh = relief::parse_obj({reinterpret_cast<const char*>(data), size}, "fuzz.obj");
        for (const uint32_t index : mesh.position_indices)
            if (index >= mesh.positions.size()) std::abort();
        for (const uint32_t index : mesh.uv_indices)
            if (index >= mesh.uvs.size()) std::abort();
    } catch (const relief::Error&) {
        // refused with a message: what is wanted
    }
    return 0;
}
