// Bytes of an image must end in texels or in an Error. The first bytes tell the kind, as in a file of that
// name.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "image/texel_layout.h"
#include "io/picture/image_input.h"
#include "relief/error.h"

namespace {

const char* get_name(std::string_view bytes) {
    if (bytes.starts_with("#?")) return "fuzz.hdr";
    if (bytes.starts_with("\x89PNG")) return "fuzz.png";
    if (bytes.starts_with("\xff\xd8")) return "fuzz.jpg";
    if (bytes.starts_with("II") || bytes.starts_with("MM")) return "fuzz.tif";
    return "fuzz.exr";
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    try {
        const relief::Texture texture = relief::parse_texture(bytes, get_name(bytes));
        if (!relief::is_complete(texture)) std::abort();
    } catch (const relief::Error&) {
        // refused with a message: what is wanted
    }
    return 0;
}
