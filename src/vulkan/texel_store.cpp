#include "vulkan/texel_store.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "relief/error.h"
#include "vulkan/layout/device_scene.h"

namespace relief::vulkan {

namespace {

constexpr uint16_t kHalfOne = 0x3c00;

Buffer make_texel_buffer(const Device& device, const char* name, TexelFormat format, uint64_t texels) {
    if (texels > device.max_texel_count())
        throw Error(
            ErrorKind::out_of_memory,
            {fmt::format("the scene's textures have {} texels ({} bytes), a buffer of this device holds {}",
                         texels, texels * texel_bytes(format), device.max_texel_count()),
             device.description().name, "use smaller maps, or device.engine = cpu"});
    return {device, {name, texels * texel_bytes(format), Purpose::displacement, format}};
}

/// Buffers have four values a texel, whatever textures have.
template <class Value>
void upload_texels(const Texture& texture, const std::vector<Value>& values, Value one, uint64_t first,
                   Buffer& buffer) {
    constexpr size_t kPartTexels = size_t(1) << 18;
    if (texture.stride == 4) return buffer.upload(values, first * 4 * sizeof(Value));
    const size_t count = size_t(texture.width) * texture.height;
    std::vector<Value> part;
    for (size_t begin = 0; begin < count; begin += kPartTexels) {
        const size_t end = std::min(count, begin + kPartTexels);
        part.clear();
        for (size_t k = begin; k < end; ++k) {
            const Value* texel = &values[texture.stride * k];
            const bool has_three = texture.stride == 3;
            part.insert(part.end(),
                        {texel[0], has_three ? texel[1] : Value(0), has_three ? texel[2] : Value(0), one});
        }
        buffer.upload(part, (first + begin) * 4 * sizeof(Value));
    }
}

} // namespace

scalar::TextureData TexelStore::add(std::shared_ptr<const Texture> texture) {
    const bool is_half = !texture->halves.empty();
    uint64_t& count = is_half ? half_count_ : float_count_;
    const scalar::TextureData place{uint32_t(count), texture->width, texture->height, texture->channel_count,
                                    is_half ? 1u : 0u};
    count += uint64_t(texture->width) * texture->height;
    textures_.push_back(std::move(texture));
    places_.push_back(place);
    return place;
}

Buffer TexelStore::make_float_buffer(const Device& device) const {
    Buffer buffer = make_texel_buffer(device, "texels of 32 bits", TexelFormat::rgba32_float, float_count_);
    for (size_t k = 0; k < textures_.size(); ++k)
        if (!places_[k].is_half)
            upload_texels(*textures_[k], textures_[k]->floats, 1.0f, places_[k].first_texel, buffer);
    return buffer;
}

Buffer TexelStore::make_half_buffer(const Device& device) const {
    Buffer buffer = make_texel_buffer(device, "texels of 16 bits", TexelFormat::rgba16_float, half_count_);
    for (size_t k = 0; k < textures_.size(); ++k)
        if (places_[k].is_half)
            upload_texels(*textures_[k], textures_[k]->halves, kHalfOne, places_[k].first_texel, buffer);
    return buffer;
}

} // namespace relief::vulkan
