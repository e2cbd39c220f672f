// Scene text must end in a scene or in an Error, never in a crash or a hang.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "io/scene/scene_reader.h"
#include "relief/error.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    try {
        relief::parse_scene({reinterpret_cast<const char*>(data), size}, "/nonexistent");
    } catch (const relief::Error&) {
        // refused with a message: what is wanted
    }
    return 0;
}
