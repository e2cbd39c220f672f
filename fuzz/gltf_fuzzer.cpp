// Bytes of a glTF or GLB file must end in a mesh that holds together or in an Error, and whatever it names
// must lie in its folder or below. Both uv sets are asked for.
#include <filesystem>
#include <string_view>

#include "io/mesh/mesh_gltf.h"
#include "mesh_checks.h"

namespace {

std::string read_beside(const std::string& path) {
    const std::filesystem::path plain = std::filesystem::path(path).lexically_normal();
    relief::require(plain.is_relative() && plain.begin() != plain.end() && *plain.begin() != "..");
    return std::string(64, 'a');
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    for (const int uv_set : {0, 1}) {
        try {
            relief::check_mesh(relief::parse_gltf({reinterpret_cast<const char*>(data), size}, "fuzz.glb",
                                                  read_beside,
                                                  {.uv_set = uv_set, .further_uv_sets = {0, 1}}));
        } catch (const relief::Error&) {
            // refused with a message: what is wanted
        }
    }
    return 0;
}
