#include "textures.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <nanobind/ndarray.h>
#include <nanobind/stl/string.h>

#include "arrays.h"
#include "base/parallel.h"
#include "exit_gate.h"
#include "relief/error.h"
#include "relief/half.h"

namespace nb = nanobind;

namespace relief::python {

namespace {

constexpr size_t kTexelGrain = 1 << 16; ///< texels

/// Channels that the array lacks are 0, a missing fourth is `one`, where the texture has them.
template <class From, class To, class Convert>
void fill(const From* from, const Texture& texture, To one, std::vector<To>& to, const Convert& convert) {
    to.resize(texture.value_count());
    const size_t channels = texture.channel_count, stride = texture.stride;
    const size_t count = size_t(texture.width) * texture.height;
    parallel_for("fill_texels", count, kTexelGrain, [&](size_t begin, size_t end) {
        for (size_t k = begin; k < end; ++k) {
            for (size_t c = 0; c < stride; ++c)
                to[stride * k + c] = c < channels ? convert(from[channels * k + c]) : (c == 3 ? one : To(0));
        }
    });
}

} // namespace

Texture make_texture(nb::handle array, const std::string& name) {
    const auto given = nb::cast<nb::ndarray<nb::ro, nb::ndim<3>, nb::c_contig, nb::device::cpu>>(array);
    Texture texture;
    texture.height = uint32_t(given.shape(0)), texture.width = uint32_t(given.shape(1));
    texture.channel_count = uint32_t(given.shape(2));
    texture.stride = Texture::choose_stride(texture.channel_count);
    texture.file = name;
    constexpr uint16_t kHalfOne = 0x3c00;
    const nb::dlpack::dtype type = given.dtype();
    const void* const data = given.data();
    const GateVisit visit;
    const nb::gil_scoped_release release;
    if (type == nb::dtype<float>()) {
        fill(static_cast<const float*>(data), texture, 1.0f, texture.floats, [](float x) { return x; });
    } else if (type == nb::dtype<uint8_t>()) {
        texture.source_type = SampleType::uint8;
        fill(static_cast<const uint8_t*>(data), texture, 1.0f, texture.floats,
             [](uint8_t x) { return float(x) * (1.0f / 255); });
    } else if (type == nb::dtype<uint16_t>()) {
        texture.source_type = SampleType::uint16;
        fill(static_cast<const uint16_t*>(data), texture, 1.0f, texture.floats,
             [](uint16_t x) { return float(x) * (1.0f / 65535); });
    } else {
        texture.source_type = SampleType::float16;
        fill(static_cast<const uint16_t*>(data), texture, kHalfOne, texture.halves,
             [](uint16_t x) { return x; });
    }
    return texture;
}

nb::object make_texel_array(const Texture& texture) {
    const size_t channels = std::clamp<size_t>(texture.channel_count, 1, 4),
                 texels = size_t(texture.width) * texture.height;
    std::vector<float> values(texels * channels);
    {
        const GateVisit visit;
        const nb::gil_scoped_release release;
        parallel_for("gather_texels", texels, kTexelGrain, [&](size_t begin, size_t end) {
            for (size_t k = begin; k < end; ++k)
                for (size_t c = 0; c < channels; ++c)
                    values[channels * k + c] = texture.floats.empty()
                                                   ? half_to_float(texture.halves[texture.stride * k + c])
                                                   : texture.floats[texture.stride * k + c];
        });
    }
    return make_array<float>(std::move(values), {texture.height, texture.width, channels});
}

} // namespace relief::python
