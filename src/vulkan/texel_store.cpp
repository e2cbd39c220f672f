#include "vulkan/texel_store.h"

#include <utility>

#include <fmt/format.h>

#include "relief/error.h"
#include "vulkan/layout/device_scene.h"

namespace relief::vulkan {

namespace {

Buffer make_texel_buffer(const Device& device, const char* name, TexelFormat format, uint64_t texels) {
    if (texels > device.max_texel_count())
        throw Error(
            ErrorKind::out_of_memory,
            {fmt::format("the scene's textures have {} texels ({} bytes), a buffer of this device holds {}",
                         texels, texels * texel_bytes(format), device.max_texel_count()),
             device.description().name, "use smaller maps, or device.engine = cpu"});
    return {device, {name, texels * texel_bytes(format), Purpose::displacement, format}};
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
        if (!places_[k].is_half) buffer.upload(textures_[k]->floats, uint64_t(places_[k].first_texel) * 16);
    return buffer;
}

Buffer TexelStore::make_half_buffer(const Device& device) const {
    Buffer buffer = make_texel_buffer(device, "texels of 16 bits", TexelFormat::rgba16_float, half_count_);
    for (size_t k = 0; k < textures_.size(); ++k)
        if (places_[k].is_half) buffer.upload(textures_[k]->halves, uint64_t(places_[k].first_texel) * 8);
    return buffer;
}

} // namespace relief::vulkan
