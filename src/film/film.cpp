#include "film/film.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "base/check.h"
#include "base/machine.h"
#include "base/parallel.h"
#include "film/layer_kinds.h"
#include "image/cryptomatte.h"
#include "image/shadow_alpha.h"
#include "math/vec.h"
#include "relief/denoise.h"
#include "relief/error.h"

namespace relief {

namespace {

constexpr size_t kRadianceSums = 4;
/// Radiance whose noise counts half: in the dark no relative error is ever small.
constexpr double kDarkest = 0.01;

void check_layer(const std::string& name) {
    const auto is_named = [&](const LayerKind& kind) {
        return kind.source == LayerSource::light_group ? !find_group_of_layer(name).empty()
                                                       : name == kind.name;
    };
    if (std::ranges::any_of(kLayerKinds, is_named)) return;
    std::string known;
    for (const LayerKind& kind : kLayerKinds) known += std::string(known.empty() ? "" : ", ") + kind.name;
    throw Error(ErrorKind::usage, {"there is no layer \"" + name + "\"", "", "layers are " + known});
}

/// Light of all kinds that comes straight from lights to the first surface, or to the camera.
Vec3f sum_direct(std::span<const Vec3f> lights) {
    Vec3f sum{};
    for (size_t kind = 0; kind < kLightKinds.size(); ++kind)
        if (!std::string_view(kLightKinds[kind]).ends_with("_indirect")) sum += lights[kind];
    return sum;
}

/// Which colour of Film::add_lights a layer is, other than those of groups and sums of kinds.
size_t find_path_color(const LayerKind& kind, const LightLayers& layers) {
    if (kind.source == LayerSource::guide)
        return layers.first_guide() + (kind.name == kDenoiserGuides[1] ? 1 : 0);
    return size_t(std::ranges::find(kLightKinds, std::string_view(kind.name)) - kLightKinds.begin());
}

template <class Real> void add_to(double* sums, const Vec3<Real>& v) {
    sums[0] += v.x;
    sums[1] += v.y;
    sums[2] += v.z;
}

void add_layer_sums(double* sums, LayerSource source, const FilmSums& added) {
    switch (source) {
    case LayerSource::shading_normal:
    case LayerSource::camera_normal:
        return add_to(sums, added.shading_normal);
    case LayerSource::geometric_normal:
        return add_to(sums, added.geometric_normal);
    case LayerSource::albedo:
        return add_to(sums, added.albedo);
    case LayerSource::position:
        return add_to(sums, added.position);
    case LayerSource::uv:
        sums[0] += added.uv.x, sums[1] += added.uv.y;
        return;
    case LayerSource::variance:
        return add_to(sums, added.squares);
    case LayerSource::cost:
        sums[0] += added.cost;
        return;
    case LayerSource::shadow:
        return add_to(sums, added.shadow);
    case LayerSource::depth:
    case LayerSource::id:
    case LayerSource::samples:
    case LayerSource::motion: // Film::set_motions
    case LayerSource::guide:  // Film::add_lights
    case LayerSource::direct:
    case LayerSource::light_kind:
    case LayerSource::light_group:
    case LayerSource::objects:
    case LayerSource::materials:
        return;
    }
}

bool is_direction(LayerSource source) {
    return source == LayerSource::shading_normal || source == LayerSource::camera_normal ||
           source == LayerSource::geometric_normal;
}

/// Writes the sums of a layer, divided by n and made unit vectors where they are directions.
void write_means(const double* sums, size_t count, uint32_t n, LayerSource source, float* target) {
    double divisor = n;
    if (is_direction(source)) divisor = std::sqrt(sums[0] * sums[0] + sums[1] * sums[1] + sums[2] * sums[2]);
    for (size_t k = 0; k < count; ++k) target[k] = divisor > 0 ? float(sums[k] / divisor) : 0.0f;
}

/// Turns what was summed in the world into what the layer is said to hold.
void place_in_space(const PictureSpace& space, LayerSource source, float* target) {
    const bool is_moved = source == LayerSource::position && space.origin != Vec3f{};
    if (!is_moved && source != LayerSource::camera_normal) return;
    Vec3f v{target[0], target[1], target[2]};
    if (is_moved)
        v += space.origin;
    else
        v = {dot(space.right, v), dot(space.up, v), dot(space.back, v)};
    target[0] = v.x, target[1] = v.y, target[2] = v.z;
}

/// Samples' worth of alpha of what shadow catchers showed.
double sum_shadow_alpha(const double* sums) { return find_shadow_alpha(sums[0], sums[1], sums[2]); }

/// Checked beforehand, since the system grants more memory than it has and ends the process later.
void require_memory(double pixels, size_t bytes_per_pixel) {
    const double needed = pixels * double(bytes_per_pixel), available = double(available_memory_bytes());
    if (needed <= available) return;
    throw Error(ErrorKind::out_of_memory,
                {fmt::format("the picture needs {:.0f} bytes ({:.1f} GiB), {:.1f} GiB are available", needed,
                             needed / (1 << 30), available / (1 << 30)),
                 "", "render it in parts with image.crop and merge them, or ask for fewer layers"});
}

} // namespace

bool needs_mattes(const std::vector<std::string>& layers) {
    return std::ranges::any_of(
        layers, [](const std::string& name) { return name == kObjectMattes || name == kMaterialMattes; });
}

Film::Film(int full_width, int full_height, const Window& window, const std::vector<std::string>& layers,
           ErrorEstimate error)
    : full_width_(full_width),
      full_height_(full_height),
      window_(window),
      light_layers_(find_light_layers(layers)),
      stride_(kRadianceSums) {
    for (const std::string& name : layers) check_layer(name);
    if (window_ == Window{}) window_ = {0, 0, full_width, full_height};
    for (size_t k = 0; k < kLayerKinds.size(); ++k) {
        const LayerKind& kind = kLayerKinds[k];
        if (kind.source == LayerSource::light_group) {
            for (size_t group = 0; group < light_layers_.groups.size(); ++group)
                add_layer({k, stride_, false, light_layers_.kind_count() + group});
            continue;
        }
        const bool is_requested = std::find(layers.begin(), layers.end(), kind.name) != layers.end();
        const bool is_needed = error == ErrorEstimate::on && kind.source == LayerSource::variance;
        if (!is_requested && !is_needed) continue;
        if (is_needed) squares_offset_ = stride_;
        if (kind.source == LayerSource::shadow) shadow_offset_ = stride_;
        add_layer({k, stride_, !is_requested, find_path_color(kind, light_layers_)});
    }
    allocate_sums(error);
}

void Film::add_layer(const Layer& layer) {
    layers_.push_back(layer);
    stride_ += kLayerKinds[layer.kind].sum_count;
}

/// Of all layers, which are there.
void Film::allocate_sums(ErrorEstimate error) {
    bool needs_hit_counts = false, needs_nearest = false;
    size_t channels = kRadianceSums, matte_layers = 0;
    for (const Layer& layer : layers_) {
        const LayerKind& kind = kLayerKinds[layer.kind];
        if (!layer.is_hidden) channels += channel_count(kind);
        needs_hit_counts |= is_mean_of_hits(kind.source);
        needs_nearest |= kind.source == LayerSource::depth || kind.source == LayerSource::id;
        matte_layers += is_matte(kind.source) ? 1 : 0;
    }
    const size_t pixels = size_t(window_.x1 - window_.x0) * size_t(window_.y1 - window_.y0);
    // While motions are found: where the ray of a pixel ends (16 bytes), and two places on the picture.
    constexpr size_t kMotionBytes = 16 + 2 * sizeof(Vec2f);
    const bool has_motions = std::ranges::any_of(
        layers_, [](const Layer& layer) { return kLayerKinds[layer.kind].source == LayerSource::motion; });
    // Counts, hit counts, depths and ids are 4 bytes each, as are the channels of the resolved image.
    require_memory(double(pixels), stride_ * sizeof(double) + (4 + channels) * 4 +
                                       matte_layers * MatteCounts::kPixelBytes +
                                       (error == ErrorEstimate::on ? sizeof(SampleBatches::Sums) : 0) +
                                       (has_motions ? kMotionBytes : 0));
    sums_.resize(pixels * stride_);
    counts_.resize(pixels);
    if (needs_hit_counts) hit_counts_.resize(pixels);
    if (error == ErrorEstimate::on) batches_.emplace(pixels);
    if (needs_nearest) depths_.resize(pixels, std::numeric_limits<float>::infinity()), ids_.resize(pixels);
    for (const Layer& layer : layers_) {
        if (kLayerKinds[layer.kind].source == LayerSource::objects) objects_.emplace(pixels);
        if (kLayerKinds[layer.kind].source == LayerSource::materials) materials_.emplace(pixels);
    }
}

size_t Film::pixel_index(int x, int y) const {
    DCHECK(x >= window_.x0 && x < window_.x1 && y >= window_.y0 && y < window_.y1);
    return size_t(y - window_.y0) * size_t(window_.x1 - window_.x0) + size_t(x - window_.x0);
}

/// Without further layers a sample is five additions.
void Film::add_color(int x, int y, const FilmSample& sample) {
    const size_t index = pixel_index(x, y);
    double* sums = sums_.data() + index * stride_;
    add_to(sums, sample.radiance);
    sums[3] += sample.alpha;
    ++counts_[index];
}

void Film::add_sample(int x, int y, const FilmSample& sample) {
    const bool has_color_alone =
        stride_ == kRadianceSums && hit_counts_.empty() && depths_.empty() && !needs_hit_ids();
    if (has_color_alone) return add_color(x, y, sample);
    FilmSums sums;
    const auto square = [](float v) { return double(v) * v; };
    const bool is_hit = sample.id != 0;
    sums.count = 1, sums.hit_count = is_hit ? 1 : 0;
    sums.radiance = sample.radiance, sums.cost = sample.cost;
    sums.squares = {square(sample.radiance.x), square(sample.radiance.y), square(sample.radiance.z)};
    sums.shading_normal = sample.shading_normal, sums.geometric_normal = sample.geometric_normal;
    sums.albedo = sample.albedo, sums.shadow = sample.shadow;
    if (is_hit) sums.position = sample.position, sums.uv = sample.uv;
    sums.depth = sample.depth, sums.id = sample.id;
    if (is_hit) sums.hit_ids = {&sample.id, 1};
    add(x, y, sums, sample.alpha);
}

bool Film::needs_surface_sums() const {
    const auto is_of_light = [](const Layer& layer) {
        const LayerSource source = kLayerKinds[layer.kind].source;
        return is_of_paths(source) || source == LayerSource::samples || source == LayerSource::variance ||
               source == LayerSource::cost || source == LayerSource::motion;
    };
    return !std::ranges::all_of(layers_, is_of_light);
}

void Film::add_sums(int x, int y, const FilmSums& added) {
    add(x, y, added, float(added.hit_count + added.light_count));
}

void Film::add(int x, int y, const FilmSums& added, float alpha) {
    const size_t index = pixel_index(x, y);
    double* sums = sums_.data() + index * stride_;
    add_to(sums, added.radiance);
    sums[3] += alpha;
    counts_[index] += added.count;
    if (!hit_counts_.empty()) hit_counts_[index] += added.hit_count;
    if (added.id != 0) add_nearest(index, added.depth, added.id);
    if (needs_hit_ids()) add_mattes(index, added.hit_ids);
    for (const Layer& layer : layers_)
        add_layer_sums(sums + layer.sum_offset, kLayerKinds[layer.kind].source, added);
    constexpr uint32_t kBatch = SampleBatches::kSizes.front();
    DCHECK(!batches_ || (counts_[index] - 1) / kBatch == (counts_[index] - added.count) / kBatch);
    if (batches_) batches_->add(index, added.radiance, counts_[index]);
}

void Film::add_lights(int x, int y, std::span<const Vec3f> lights) {
    DCHECK(lights.size() == light_layers_.count());
    double* sums = sums_.data() + pixel_index(x, y) * stride_;
    for (const Layer& layer : layers_) {
        const LayerSource source = kLayerKinds[layer.kind].source;
        if (!is_of_paths(source)) continue;
        add_to(sums + layer.sum_offset,
               source == LayerSource::direct ? sum_direct(lights) : lights[layer.light]);
    }
}

void Film::set_motions(std::vector<Vec2f> motions) {
    DCHECK(motions.size() == counts_.size());
    motions_ = std::move(motions);
}

void Film::clear(const Window& window) {
    const size_t width = size_t(window.x1 - window.x0);
    const auto fill = [&](auto& values, size_t first, size_t stride, auto value) {
        if (!values.empty()) std::fill_n(values.begin() + ptrdiff_t(first * stride), width * stride, value);
    };
    for (int y = window.y0; y < window.y1; ++y) {
        const size_t first = pixel_index(window.x0, y);
        fill(sums_, first, stride_, 0.0);
        fill(counts_, first, 1, 0u), fill(hit_counts_, first, 1, 0u), fill(ids_, first, 1, 0u);
        fill(depths_, first, 1, std::numeric_limits<float>::infinity());
        if (objects_) objects_->clear(first, width);
        if (materials_) materials_->clear(first, width);
        if (batches_) batches_->clear(first, width);
    }
    passes = {};
}

/// Among equal depths the lowest id wins, so that the layer does not depend on which sample came first.
void Film::add_nearest(size_t pixel, float depth, uint32_t id) {
    if (depths_.empty()) return;
    const bool is_nearer = depth < depths_[pixel];
    if (!is_nearer && !(depth == depths_[pixel] && id < ids_[pixel])) return;
    depths_[pixel] = depth;
    ids_[pixel] = id;
}

void Film::add_mattes(size_t pixel, std::span<const uint32_t> hit_ids) {
    DCHECK(mattes_);
    for (const uint32_t id : hit_ids) {
        if (objects_) objects_->add(pixel, mattes_->objects[id - 1]);
        if (materials_) materials_->add(pixel, mattes_->materials[id - 1]);
    }
}

std::vector<std::string> Film::name_channels(const Layer& layer) const {
    const LayerKind& kind = kLayerKinds[layer.kind];
    if (is_matte(kind.source)) return name_matte_channels(kind.name);
    std::string name = kind.name;
    if (kind.source == LayerSource::light_group)
        name =
            std::string(kLightGroupPrefix) + light_layers_.groups[layer.light - light_layers_.kind_count()];
    std::vector<std::string> names;
    for (size_t k = 0; k < channel_count(kind); ++k) names.push_back(name + "." + kind.suffixes[k]);
    return names;
}

void Film::write_layer(size_t pixel, const Layer& layer, const PictureSpace& space, float* target) const {
    const LayerKind& kind = kLayerKinds[layer.kind];
    const double* radiance_sums = sums_.data() + pixel * stride_;
    const double* sums = radiance_sums + layer.sum_offset;
    switch (kind.source) {
    case LayerSource::depth:
        *target = depths_[pixel];
        return;
    case LayerSource::id:
        *target = float(ids_[pixel]);
        return;
    case LayerSource::samples:
        *target = float(counts_[pixel]);
        return;
    case LayerSource::motion:
        if (!motions_.empty()) target[0] = motions_[pixel].x, target[1] = motions_[pixel].y;
        return;
    case LayerSource::variance:
        for (size_t c = 0; c < 3; ++c)
            target[c] = float(variance_of_mean(radiance_sums[c], sums[c], counts_[pixel]));
        return;
    case LayerSource::objects:
        return objects_->write_ranks(pixel, counts_[pixel], target);
    case LayerSource::materials:
        return materials_->write_ranks(pixel, counts_[pixel], target);
    case LayerSource::position:
    case LayerSource::uv:
    case LayerSource::shading_normal:
    case LayerSource::camera_normal:
    case LayerSource::geometric_normal:
    case LayerSource::albedo:
    case LayerSource::cost:
    case LayerSource::shadow:
    case LayerSource::guide:
    case LayerSource::direct:
    case LayerSource::light_kind:
    case LayerSource::light_group:
        const uint32_t n = is_mean_of_hits(kind.source) ? hit_counts_[pixel] : counts_[pixel];
        write_means(sums, kind.sum_count, n, kind.source, target);
        if (n > 0) place_in_space(space, kind.source, target);
    }
}

Image Film::resolve(const PictureSpace& space) const {
    Image image;
    image.width = window_.x1 - window_.x0;
    image.height = window_.y1 - window_.y0;
    image.x0 = window_.x0;
    image.y0 = window_.y0;
    image.full_width = full_width_;
    image.full_height = full_height_;
    image.channels = {"R", "G", "B", "A"};
    for (const Layer& layer : layers_) {
        if (layer.is_hidden) continue;
        for (std::string& name : name_channels(layer)) image.channels.push_back(std::move(name));
    }
    if (mattes_) image.metadata = mattes_->entries;
    image.pixels.resize(counts_.size() * image.channels.size());
    const size_t width = image.channels.size();
    parallel_for("resolve", counts_.size(), 1 << 14, [&](size_t begin, size_t end) {
        for (size_t p = begin; p < end; ++p) {
            float* target = image.pixels.data() + p * width;
            const double* sums = sums_.data() + p * stride_;
            write_means(sums, kRadianceSums, counts_[p], LayerSource::albedo, target);
            if (shadow_offset_ && counts_[p] > 0)
                target[3] = float((sums[3] + sum_shadow_alpha(sums + *shadow_offset_)) / counts_[p]);
            target += kRadianceSums;
            for (const Layer& layer : layers_) {
                if (layer.is_hidden) continue;
                write_layer(p, layer, space, target);
                target += channel_count(kLayerKinds[layer.kind]);
            }
        }
    });
    return image;
}

uint32_t Film::least_samples() const { return counts_.empty() ? 0 : *std::ranges::min_element(counts_); }

uint32_t Film::most_samples() const {
    return counts_.empty() ? 0 : *std::max_element(counts_.begin(), counts_.end());
}

/// Mean over the channels of that of the mean of the samples.
double Film::estimate_variance(size_t pixel) const {
    const double* radiance = sums_.data() + pixel * stride_;
    const double* squares = radiance + *squares_offset_;
    const uint32_t n = counts_[pixel];
    if (const std::optional<double> of_batches = batches_->estimate_variance(pixel, radiance, n))
        return *of_batches / 3;
    double variance = 0;
    for (size_t c = 0; c < 3; ++c) variance += variance_of_mean(radiance[c], squares[c], n) / 3;
    return variance;
}

double Film::estimate_error(const Window& window) const {
    DCHECK(squares_offset_ && batches_);
    double sum = 0;
    for (int y = window.y0; y < window.y1; ++y)
        for (int x = window.x0; x < window.x1; ++x) {
            const size_t pixel = pixel_index(x, y);
            const uint32_t n = counts_[pixel];
            if (n < 2) return std::numeric_limits<double>::infinity();
            const double* radiance = sums_.data() + pixel * stride_;
            const double mean = (radiance[0] + radiance[1] + radiance[2]) / n / 3;
            sum += estimate_variance(pixel) / ((mean + kDarkest) * (mean + kDarkest));
        }
    return std::sqrt(sum / (double(window.x1 - window.x0) * double(window.y1 - window.y0)));
}

size_t Film::byte_count() const {
    return sums_.size() * sizeof(double) +
           (batches_ ? batches_->pixels().size() * sizeof(SampleBatches::Sums) : 0) +
           (counts_.size() + hit_counts_.size() + ids_.size()) * sizeof(uint32_t) +
           depths_.size() * sizeof(float) +
           counts_.size() * MatteCounts::kPixelBytes * size_t(objects_.has_value() + materials_.has_value());
}

} // namespace relief
