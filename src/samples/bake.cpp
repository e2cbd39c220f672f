#include "samples/bake.h"

#include "base/check.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "image/texel_layout.h"
#include "math/vec.h"

namespace relief::samples {

namespace {

std::shared_ptr<Texture> make_texture(const std::string& file, uint32_t size, Texels texels) {
    auto texture = std::make_shared<Texture>();
    texture->width = texture->height = size;
    texture->channel_count = texture->stride = 3;
    texture->file = file;
    texture->source_type = texels == Texels::halves ? SampleType::float16 : SampleType::float32;
    if (texels == Texels::halves)
        texture->halves.resize(texture->value_count());
    else
        texture->floats.resize(texture->value_count());
    return texture;
}

void store(Texture& texture, uint32_t x, uint32_t y, const Vec3f& value) {
    const size_t place = texture.find_texel(x, y);
    for (int c = 0; c < 3; ++c) store_value(texture, place + size_t(c), get_component(value, c));
}

} // namespace

Maps bake_maps(const std::string& name, uint32_t size, Texels texels,
               const std::function<MapSample(Vec2f uv)>& sample, const ProgressFunction& on_progress) {
    DCHECK(size % 2 == 0);
    const auto displacement = make_texture(name + "_displacement", size, texels);
    const auto color = make_texture(name + "_color", size / 2, Texels::halves);
    const auto bake_row_pair = [&](uint32_t pair) {
        for (uint32_t x = 0; x < size / 2; ++x) {
            Vec3f mean;
            for (uint32_t k = 0; k < 4; ++k) {
                const uint32_t column = 2 * x + k % 2, row = 2 * pair + k / 2;
                const Vec2f uv{(float(column) + 0.5f) / float(size), 1 - (float(row) + 0.5f) / float(size)};
                const MapSample value = sample(uv);
                store(*displacement, column, row, value.displacement);
                mean += value.color * 0.25f;
            }
            store(*color, x, pair, min(max(mean, Vec3f{}), Vec3f{1, 1, 1}));
        }
    };
    ProgressCounter counter(on_progress, size / 2);
    parallel_for("bake maps", size / 2, 16, [&](size_t begin, size_t end) {
        for (size_t pair = begin; pair < end; ++pair) bake_row_pair(uint32_t(pair));
        counter.add(end - begin);
    });
    return {displacement, color};
}

} // namespace relief::samples
