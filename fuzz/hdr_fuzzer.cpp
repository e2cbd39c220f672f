// Bytes of a Radiance HDR file must end in texels or in an Error.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "image/texel_layout.h"
#include "io/picture/image_input.h"
#include "relief/error.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    try {
        const relief::Texture texture =
            relief::parse_texture({reinterpret_cast<const char*>(data), size}, "fuzz.hdr");
        if (texture.floats.empty() || !relief::is_complete(texture)) std::abort();
    } catch (const relief::Error&) {
        // refused with a message: what is wanted
    }
    return 0;
}
