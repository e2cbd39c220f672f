#include "vulkan/film_reader.h"

#include <cstddef>
#include <vector>

#include "base/check.h"
#include "base/parallel.h"

namespace relief::vulkan {

namespace {

static_assert(sizeof(scalar::FilmSumsData) == scalar::kFilmSumsWords * sizeof(uint32_t));
static_assert(sizeof(scalar::FilmColorsData) == scalar::kFilmColorsWords * sizeof(uint32_t));
static_assert(offsetof(scalar::FilmSumsData, shading_normal) == sizeof(scalar::FilmColorsData));
static_assert(offsetof(scalar::FilmSumsData, light_count) == offsetof(scalar::FilmColorsData, light_count));

constexpr size_t kPixelsAtOnce = 4096;

/// `hit_ids` outlives the sums.
FilmSums make_sums(const scalar::FilmSumsData& data, int sample_count, std::span<const uint32_t> hit_ids) {
    FilmSums sums;
    sums.count = uint32_t(sample_count);
    sums.hit_count = uint32_t(data.hit_count), sums.light_count = uint32_t(data.light_count);
    sums.radiance = data.radiance;
    sums.squares = {data.squares.x, data.squares.y, data.squares.z};
    sums.cost = data.cost;
    sums.shading_normal = data.shading_normal, sums.geometric_normal = data.geometric_normal;
    sums.position = data.position, sums.albedo = data.albedo;
    sums.uv = data.uv, sums.shadow = data.shadow;
    sums.depth = data.depth, sums.id = data.id;
    sums.hit_ids = hit_ids;
    return sums;
}

FilmSums make_sums(const scalar::FilmColorsData& data, int sample_count, std::span<const uint32_t> hit_ids) {
    scalar::FilmSumsData sums{};
    sums.radiance = data.radiance, sums.squares = data.squares;
    sums.cost = data.cost;
    sums.hit_count = data.hit_count, sums.light_count = data.light_count;
    return make_sums(sums, sample_count, hit_ids);
}

/// Adds the sums of pixel `k` of a batch.
template <class Sums> void add_pixel(Film& film, const FilmBatch& batch, size_t k, const Sums& sums) {
    const size_t count = batch.pixels.size(), light_count = film.light_layers().count();
    std::vector<uint32_t> hit_ids;
    for (size_t n = k; n < batch.first_hits.size(); n += count)
        if (batch.first_hits[n] != 0) hit_ids.push_back(batch.first_hits[n]);
    const int x = int(batch.pixels[k] & 0xffff), y = int(batch.pixels[k] >> 16);
    film.add_sums(x, y, make_sums(sums, batch.sample_count, hit_ids));
    if (light_count > 0) film.add_lights(x, y, batch.lights.subspan(k * light_count, light_count));
}

template <class Sums> void add_pixels(Film& film, const Buffer& buffer, const FilmBatch& batch) {
    const size_t count = batch.pixels.size();
    DCHECK(batch.lights.size() == count * film.light_layers().count());
    size_t first = 0;
    buffer.visit(0, count * sizeof(Sums), sizeof(Sums), [&](std::span<const std::byte> bytes) {
        const Sums* sums = reinterpret_cast<const Sums*>(bytes.data());
        const size_t pixels = bytes.size() / sizeof(Sums);
        parallel_for("add_to_film", pixels, kPixelsAtOnce, [&](size_t begin, size_t end) {
            for (size_t k = begin; k < end; ++k) add_pixel(film, batch, first + k, sums[k]);
        });
        first += pixels;
    });
}

} // namespace

FilmReader::FilmReader(const Device& device) : film_colors_(make_kernel(device, "film_colors")) {}

BatchSums FilmReader::pack(Commands& commands, const Film& film, const Buffer& sums, const Buffer& scratch,
                           uint32_t count) const {
    if (film.needs_surface_sums()) return {&sums};
    commands.begin_stage(Stage::film);
    const uint32_t words = count * scalar::kFilmColorsWords;
    commands.dispatch(film_colors_, words, scalar::FilmColorsPush{words});
    return {&scratch, true};
}

void FilmReader::add(Film& film, const BatchSums& sums, const FilmBatch& batch) {
    if (sums.has_colors_alone)
        add_pixels<scalar::FilmColorsData>(film, *sums.buffer, batch);
    else
        add_pixels<scalar::FilmSumsData>(film, *sums.buffer, batch);
}

} // namespace relief::vulkan
