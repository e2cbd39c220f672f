#include "vulkan/film_reader.h"

#include <cstddef>

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

} // namespace

FilmReader::FilmReader(const Device& device, uint32_t capacity)
    : device_(device), capacity_(capacity), film_colors_(make_kernel(device, "film_colors")) {}

void FilmReader::fetch(Commands& commands, const Film& film, const Buffer& sums, const Buffer& scratch,
                       uint32_t count) {
    DCHECK(count <= capacity_);
    if (device_.is_cpu()) return;
    const bool is_whole = film.needs_first_hits();
    const uint64_t pixel_bytes = is_whole ? sizeof(scalar::FilmSumsData) : sizeof(scalar::FilmColorsData);
    if (on_host_.byte_count() < count * pixel_bytes)
        on_host_ = Buffer(device_, {.name = "film sums on the host",
                                    .bytes = capacity_ * pixel_bytes,
                                    .purpose = Purpose::staging,
                                    .is_host_visible = true});
    commands.begin_stage(Stage::film);
    if (!is_whole) {
        const uint32_t words = count * scalar::kFilmColorsWords;
        commands.dispatch(film_colors_, words, scalar::FilmColorsPush{words});
    }
    commands.copy(is_whole ? sums : scratch, 0, on_host_, 0, count * pixel_bytes);
    whole_ = {}, colors_ = {};
    if (is_whole)
        whole_ = {static_cast<const scalar::FilmSumsData*>(on_host_.mapped()), count};
    else
        colors_ = {static_cast<const scalar::FilmColorsData*>(on_host_.mapped()), count};
}

scalar::FilmSumsData FilmReader::read_sums(size_t pixel) const {
    if (!whole_.empty()) return whole_[pixel];
    const scalar::FilmColorsData& colors = colors_[pixel];
    scalar::FilmSumsData sums{};
    sums.radiance = colors.radiance, sums.squares = colors.squares;
    sums.cost = colors.cost;
    sums.hit_count = colors.hit_count, sums.light_count = colors.light_count;
    return sums;
}

void FilmReader::add(Film& film, const Buffer& sums, const FilmBatch& batch) {
    const size_t count = batch.pixels.size(), light_count = film.light_layers().count();
    DCHECK(batch.lights.size() == count * light_count);
    if (device_.is_cpu()) {
        downloaded_ = sums.download<scalar::FilmSumsData>(count);
        whole_ = downloaded_;
    }
    parallel_for("add_to_film", count, kPixelsAtOnce, [&](size_t begin, size_t end) {
        std::vector<uint32_t> hit_ids;
        for (size_t k = begin; k < end; ++k) {
            hit_ids.clear();
            for (size_t n = k; n < batch.first_hits.size(); n += count)
                if (batch.first_hits[n] != 0) hit_ids.push_back(batch.first_hits[n]);
            const int x = int(batch.pixels[k] & 0xffff), y = int(batch.pixels[k] >> 16);
            film.add_sums(x, y, make_sums(read_sums(k), batch.sample_count, hit_ids));
            if (light_count > 0) film.add_lights(x, y, batch.lights.subspan(k * light_count, light_count));
        }
    });
}

} // namespace relief::vulkan
