// Bytes of an EXR file must end in the floats of all of its channels or in an Error.
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "io/picture/image_input.h"
#include "relief/error.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    try {
        const auto source = relief::open_image_bytes({reinterpret_cast<const char*>(data), size}, "fuzz.exr");
        const relief::PixelHeader& header = source->header();
        const size_t channel_count = header.channels.size();
        std::vector<float> values(size_t(header.width) * size_t(header.height) * channel_count);
        source->read_floats(int(channel_count), channel_count, values.data());
    } catch (const relief::Error&) {
        // refused with a message: what is wanted
    }
    return 0;
}
