// Headers of EXR and PNG files are looked through before any library sees them: whatever follows the right
// first bytes, no read may leave the file and no claim of its length may be believed.
#include <cstddef>
#include <cstdint>
#include <sstream>
#include <string>

#include "io/picture/exr_header.h"
#include "io/picture/png_header.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    const std::string rest(reinterpret_cast<const char*>(data), size);
    const std::string exr = std::string("\x76\x2f\x31\x01\x02\0\0\0", 8) + rest;
    std::istringstream exr_stream(exr);
    relief::find_missized_exr_attribute(exr_stream, exr.size());
    const std::string png = "\x89PNG\r\n\x1a\n" + rest;
    std::istringstream png_stream(png);
    relief::has_oversized_png_chunk(png_stream, png.size());
    return 0;
}
