#include "prepare/material_layers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/parallel.h"
#include "formulas/layer_block.h"
#include "formulas/layered_bsdf.h"
#include "formulas/sobol.h"
#include "scene/material_inputs.h"

namespace relief {

namespace {

constexpr uint32_t kColumns = scalar::kLayerColumnCount;
constexpr uint32_t kRows = 16;         ///< where a texture changes the roughness; else one
constexpr uint32_t kSamples = 512;     ///< of each lobe
constexpr uint32_t kGridSamples = 128; ///< the same where there are hundreds of rows
constexpr uint32_t kFuzzRows = 33;     ///< where a texture changes the roughness of the fuzz; else one
constexpr uint32_t kAzimuths = 9;      ///< of materials that are not alike in all directions
/// Nodes of a grid of so many axes, in each of them.
constexpr std::array<uint32_t, scalar::kMaxLayerAxes + 1> kNodes{1, 17, 9, 7, 5};
constexpr float kLeastCosine = 1e-4f;
constexpr Vec3f kWhite{1, 1, 1};

/// Of a block with one row an azimuth.
constexpr uint32_t count_entries(uint32_t azimuths) { return (azimuths + 1) * kColumns + 1; }

/// -log2 of the square root of a colour: straight down and up again makes the colour itself.
Vec3f find_depth(const Vec3f& color) {
    const auto depth = [](float c) { return -0.5f * std::log2(std::max(c, 1e-12f)); };
    return {depth(color.x), depth(color.y), depth(color.z)};
}

/// All but fuzz_scale, row_scale and first_entry.
scalar::LayerParameters make_record(const Material& material) {
    scalar::LayerParameters l{};
    l.specular_color = material.specular_color, l.specular_weight = material.specular_weight;
    l.metallic = material.metallic;
    // Under a coat the light comes from its medium (OpenPBR 1.1, "Coat": refraction).
    const float medium = 1 + material.coat_weight * (material.coat_ior - 1);
    l.dielectric_f0 = material.specular_weight * scalar::find_normal_reflection(material.ior / medium);
    l.dielectric_f90 = scalar::find_grazing_reflection(l.dielectric_f0);
    l.diffuse_roughness = material.base_diffuse_roughness;
    l.coat_weight = material.coat_weight, l.coat_roughness = material.coat_roughness;
    l.coat_f0 = scalar::find_normal_reflection(material.coat_ior),
    l.coat_f90 = scalar::find_grazing_reflection(l.coat_f0);
    l.coat_inverse_ior2 = 1 / (material.coat_ior * material.coat_ior);
    l.coat_depth = find_depth(material.coat_color);
    l.coat_darkening = material.coat_darkening;
    // What leaves a medium diffusely is what enters it, less by the solid angle (OpenPBR 1.1, "Coat":
    // darkening).
    l.coat_inside = 1 - (1 - scalar::average_fresnel(l.coat_f0, l.coat_f90)) * l.coat_inverse_ior2;
    l.fuzz_color = material.fuzz_color, l.fuzz_weight = material.fuzz_weight;
    l.fuzz_exponent = 1 / std::max(material.fuzz_roughness, 0.07f);
    l.fuzz_scale = 1;
    l.specular_anisotropy = material.specular_roughness_anisotropy;
    if (material.coat_weight > 0) l.coat_anisotropy = material.coat_roughness_anisotropy;
    l.azimuth_scale = is_anisotropic(material) ? float(kAzimuths - 1) : 0.0f;
    return l;
}

float column_cosine(uint32_t column) {
    const float x = float(column) / float(kColumns - 1);
    return std::max(x * x, kLeastCosine);
}

/// In the plane of the normal and the tangent.
Vec3f make_direction(float cosine) { return {std::sqrt(std::max(0.0f, 1 - cosine * cosine)), 0, cosine}; }

/// The direction of column 'cosine' in row 'azimuth' of those of a material (find_azimuth_row).
Vec3f turn_direction(float cosine, uint32_t azimuth, uint32_t count) {
    const Vec3f level = make_direction(cosine);
    if (count == 1) return level;
    const float row = float(azimuth) / float(count - 1), along = row * row;
    return {level.x * along, level.x * std::sqrt(std::max(0.0f, 1 - along * along)), cosine};
}

/// Parts of all azimuths for which the rows count that are interpolated between.
std::vector<double> weigh_azimuths(uint32_t count) {
    std::vector<double> weights(count);
    if (count == 1) return {1};
    constexpr int kAngles = 4096;
    for (int k = 0; k < kAngles; ++k) {
        const double angle = (k + 0.5) / kAngles * 0.5 * std::numbers::pi;
        const double y = std::sqrt(std::cos(angle)) * (count - 1);
        const uint32_t row = std::min(uint32_t(y), count - 2);
        weights[row] += (1 - (y - row)) / kAngles, weights[row + 1] += (y - row) / kAngles;
    }
    return weights;
}

/// Directional albedo of the fuzz, midpoint rule over cosine and angle.
float integrate_fuzz(const scalar::LayerParameters& l, float cosine) {
    constexpr int kCosines = 128, kAngles = 64;
    const Vec3f wo = make_direction(cosine);
    double sum = 0;
    for (int i = 0; i < kCosines; ++i) {
        const float z = (float(i) + 0.5f) / kCosines, sine = std::sqrt(1 - z * z);
        for (int j = 0; j < kAngles; ++j) {
            const scalar::SinCos phi = scalar::find_sin_cos(scalar::kPi * (float(j) + 0.5f) / kAngles);
            const Vec3f h = normalize(wo + Vec3f{sine * phi.cosine, sine * phi.sine, z});
            sum += double(scalar::evaluate_fuzz(l, h.z, cosine, z) * z);
        }
    }
    return float(sum * 2 * double(scalar::kPi) / (kCosines * kAngles));
}

void fill_fuzz(scalar::LayerParameters& l, Vec2f* entries) {
    float most = 1;
    for (uint32_t k = 0; k < kColumns; ++k) {
        entries[k].x = integrate_fuzz(l, column_cosine(k));
        most = std::max(most, entries[k].x);
    }
    l.fuzz_scale = 1 / most;
    for (uint32_t k = 0; k < kColumns; ++k) entries[k].x /= most, entries[k].y = l.fuzz_scale;
}

/// Mean weight of directions of the lobe that `u_lobe` selects.
double average_lobe(const scalar::LayeredBsdf& bsdf, scalar::LayerTable table, const Vec3f& wo, float u_lobe,
                    uint32_t samples) {
    double sum = 0;
    for (uint32_t k = 0; k < samples; ++k)
        sum += double(
            scalar::sample_layered_bsdf(bsdf, table, wo, u_lobe, scalar::sobol_pair(1, k, 0)).weight.x);
    return sum / samples;
}

/// What all lobes of a white stack scatter once. The table holds no rests yet. Each lobe is drawn from by
/// itself, and counts by its share: which of them is drawn next adds no noise.
float measure_albedo(const scalar::LayeredSurface& white, scalar::LayerTable table, const Vec3f& wo,
                     uint32_t samples) {
    const scalar::LayeredBsdf bsdf = scalar::make_layered_bsdf(white, table, wo);
    const scalar::LobeShares& shares = bsdf.shares;
    double sum = 0;
    float first = 0;
    for (const float end :
         {shares.base, shares.base + shares.coat, shares.base + shares.coat + shares.fuzz, 1.0f}) {
        if (end > first)
            sum += double(end - first) * average_lobe(bsdf, table, wo, 0.5f * (first + end), samples);
        first = end;
    }
    return float(sum);
}

/// The surface that absorbs nothing in place of one; `metallic`: 0 or 1.
scalar::LayeredSurface whiten(const scalar::LayerParameters& layers, float roughness, float metallic) {
    scalar::LayeredSurface white{kWhite, roughness, layers};
    white.layers.specular_color = white.layers.fuzz_color = kWhite;
    white.layers.specular_weight = 1, white.layers.metallic = metallic;
    white.layers.coat_depth = {};
    return white;
}

/// 2 integral(f(x) x dx) over the cosine x of a row that is linear in the square root of x between entries.
Vec2f average_row(const Vec2f* row) {
    Vec2<double> sum{};
    const auto power = [](double x, int n) { return n == 4 ? x * x * x * x : x * x * x * x * x; };
    for (uint32_t k = 0; k + 1 < kColumns; ++k) {
        const double a = double(k) / (kColumns - 1), b = double(k + 1) / (kColumns - 1);
        const double whole = power(b, 4) - power(a, 4); // of 4 x^3
        const double rising =
            (0.8 * (power(b, 5) - power(a, 5)) - a * whole) / (b - a); // of 4 x^3 (x - a) / (b - a)
        sum.x += double(row[k].x) * (whole - rising) + double(row[k + 1].x) * rising;
        sum.y += double(row[k].y) * (whole - rising) + double(row[k + 1].y) * rising;
    }
    return {float(sum.x), float(sum.y)};
}

/// How a row is measured.
struct RowSource {
    float roughness;
    uint32_t azimuth, azimuths, samples;
};

/// A row of rests; `block` has those of the fuzz.
void fill_row(const scalar::LayerParameters& layers, const RowSource& source, const Vec2f* block,
              Vec2f* row) {
    scalar::LayerParameters alone = layers;
    alone.first_entry = 0;
    for (uint32_t k = 0; k < kColumns; ++k) {
        const Vec3f wo = turn_direction(column_cosine(k), source.azimuth, source.azimuths);
        const auto rest = [&](float metallic) {
            const scalar::LayeredSurface white = whiten(alone, source.roughness, metallic);
            return std::max(0.0f, 1 - measure_albedo(white, {block}, wo, source.samples));
        };
        row[k] = {rest(0), rest(1)};
    }
}

/// A block of the table.
struct Block {
    uint32_t record;
    const Material* material;
    const TexturedMaterial* textured; ///< null: no grid, as vertices have no numbers of their own
    FactorRange roughness{};          ///< of one without a grid
    scalar::InputNumbers least{};     ///< those of the first row of a grid
    uint32_t fuzz_rows = 1;
};

/// A row of a block.
struct Row {
    uint32_t block, row, azimuth;
};

/// The range of a number with textures; of one point: without.
FactorRange find_range(const Material& material, const MaterialInputKind& kind) {
    FactorRange range;
    if (const InputTexture* texture = find_input_texture(material, kind.input))
        range = find_factors(*texture);
    const float number = material.*kind.number;
    return {std::clamp(number * range.lower, 0.0f, 1.0f), std::clamp(number * range.upper, 0.0f, 1.0f)};
}

/// Sets block.least too.
scalar::LayerGrid make_grid(Block& block) {
    scalar::LayerGrid grid{};
    block.least = block.textured->numbers;
    std::array<FactorRange, scalar::kMaxLayerAxes> ranges;
    for (const MaterialInputKind& kind : list_material_inputs()) {
        if (!kind.is_layered) continue;
        const FactorRange range = find_range(*block.material, kind);
        const uint32_t place = find_input_place(kind.input).first;
        block.least.word[place] = range.lower;
        if (range.upper > range.lower) grid.place[grid.axis_count] = place, ranges[grid.axis_count++] = range;
        if (kind.input != MaterialInput::fuzz_roughness) continue;
        grid.fuzz_lower = range.lower;
        if (!(range.upper > range.lower)) continue;
        grid.fuzz_last = kFuzzRows - 1, grid.fuzz_scale = grid.fuzz_last / (range.upper - range.lower);
        block.fuzz_rows = kFuzzRows;
    }
    const uint32_t nodes = kNodes[grid.axis_count];
    grid.row_count = 1;
    for (uint32_t k = 0; k < grid.axis_count; ++k) {
        grid.lower[k] = ranges[k].lower, grid.last[k] = float(nodes - 1);
        grid.scale[k] = grid.last[k] / (ranges[k].upper - ranges[k].lower);
        grid.stride[k] = grid.row_count;
        grid.row_count *= nodes;
    }
    return grid;
}

scalar::InputNumbers find_node(const Block& block, const scalar::LayerGrid& grid, uint32_t row) {
    scalar::InputNumbers numbers = block.least;
    for (uint32_t k = 0; k < grid.axis_count; ++k) {
        const auto node = float(row / grid.stride[k] % uint32_t(grid.last[k] + 1));
        numbers.word[grid.place[k]] = grid.lower[k] + node / grid.scale[k];
    }
    return scalar::limit_inputs(numbers);
}

/// Less of them where there are many rows.
uint32_t count_samples(const Block& block, const scalar::LayerGrid& grid) {
    if (grid.azimuth_count > 1) return grid.row_count > 1 ? kGridSamples : kSamples;
    return block.textured && grid.axis_count > 1 ? kGridSamples : kSamples;
}

void fill_grid_row(const Block& block, const MaterialLayers& result, const Row& row, const Vec2f* fuzz,
                   Vec2f* target) {
    const scalar::LayerGrid& grid = result.grids[block.record];
    const scalar::LayerParameters& record = result.records[block.record];
    const scalar::InputNumbers numbers = find_node(block, grid, row.row);
    scalar::LayerParameters l = scalar::set_layer_inputs(record, numbers, block.textured->constants);
    std::array<Vec2f, count_entries(kAzimuths)> alone;
    fill_vertex_block({fuzz}, grid, numbers, l, alone.data());
    fill_row(
        l,
        {numbers.word[scalar::kInputRoughness], row.azimuth, grid.azimuth_count, count_samples(block, grid)},
        alone.data(), target);
}

/// Entries of a block before its averages.
uint32_t count_rests(const scalar::LayerGrid& grid) { return grid.azimuth_count * grid.row_count * kColumns; }

/// With its record and grid, and its place in the table.
void add_block(Block block, std::vector<Block>& blocks, MaterialLayers& result) {
    block.record = uint32_t(result.records.size());
    scalar::LayerParameters l = make_record(*block.material);
    scalar::LayerGrid grid{};
    if (block.textured) {
        grid = make_grid(block);
    } else {
        block.roughness = find_range(*block.material, get_input_kind(MaterialInput::roughness));
        grid.row_count = block.roughness.upper > block.roughness.lower ? kRows : 1;
        l.row_scale = float(grid.row_count - 1);
    }
    grid.azimuth_count = uint32_t(l.azimuth_scale) + 1;
    if (block.textured)
        result.vertex_entries = std::max(result.vertex_entries, count_entries(grid.azimuth_count));
    l.first_entry = uint32_t(result.entries.size());
    result.entries.resize(result.entries.size() + count_rests(grid) + grid.row_count +
                          block.fuzz_rows * kColumns);
    result.records.push_back(l), result.grids.push_back(grid), blocks.push_back(block);
}

/// Of the table and of `fuzz`, a copy of it that will have no rests.
void fill_fuzz_row(const Block& block, uint32_t row, MaterialLayers& result, std::vector<Vec2f>& fuzz) {
    scalar::LayerParameters& l = result.records[block.record];
    if (!(l.fuzz_weight > 0)) return;
    const scalar::LayerGrid& grid = result.grids[block.record];
    const uint32_t first = l.first_entry + count_rests(grid) + grid.row_count + row * kColumns;
    if (block.textured) {
        scalar::LayerParameters of_row = l;
        const float roughness = grid.fuzz_lower + (row > 0 ? float(row) / grid.fuzz_scale : 0.0f);
        of_row.fuzz_exponent = 1 / std::max(roughness, 0.07f);
        fill_fuzz(of_row, &fuzz[first]);
    } else {
        fill_fuzz(l, &fuzz[first]);
    }
    std::copy_n(&fuzz[first], kColumns, &result.entries[first]);
}

void fill_rests(const Block& block, const Row& row, const std::vector<Vec2f>& fuzz, MaterialLayers& result) {
    const scalar::LayerParameters& l = result.records[block.record];
    const scalar::LayerGrid& grid = result.grids[block.record];
    const uint32_t count = grid.row_count;
    Vec2f* const target = &result.entries[l.first_entry + (row.azimuth * count + row.row) * kColumns];
    if (block.textured) return fill_grid_row(block, result, row, fuzz.data(), target);
    const float roughness = count == 1 ? block.roughness.lower : float(row.row) / float(count - 1);
    fill_row(l, {roughness, row.azimuth, grid.azimuth_count, count_samples(block, grid)},
             &fuzz[l.first_entry], target);
}

/// Of the rests of all azimuths.
void fill_averages(const scalar::LayerGrid& grid, Vec2f* block) {
    const std::vector<double> weights = weigh_azimuths(grid.azimuth_count);
    for (uint32_t row = 0; row < grid.row_count; ++row) {
        Vec2<double> sum{};
        for (uint32_t azimuth = 0; azimuth < grid.azimuth_count; ++azimuth) {
            const Vec2f mean = average_row(block + (azimuth * grid.row_count + row) * kColumns);
            sum.x += weights[azimuth] * double(mean.x), sum.y += weights[azimuth] * double(mean.y);
        }
        block[count_rests(grid) + row] = {float(sum.x), float(sum.y)};
    }
}

/// Whether nothing of a material is ever opaque.
bool is_all_glass(const Material& material) {
    return material.transmission_weight == 1 && material.metallic == 0 &&
           !find_input_texture(material, MaterialInput::transmission_weight);
}

} // namespace

bool is_layered(const Material& material) {
    return material.base_diffuse_roughness > 0 || material.specular_weight != 1 ||
           !(material.specular_color == kWhite) || material.coat_weight > 0 || material.fuzz_weight > 0 ||
           find_input_texture(material, MaterialInput::specular_weight) ||
           find_input_texture(material, MaterialInput::specular_color) ||
           (is_anisotropic(material) && !is_all_glass(material));
}

void fill_vertex_block(scalar::GridTable table, const scalar::LayerGrid& grid,
                       const scalar::InputNumbers& numbers, scalar::LayerParameters& layers, Vec2f* block) {
    const scalar::LayerPlace place = scalar::place_layers(grid, layers.first_entry, numbers);
    for (uint32_t i = 0; i < count_entries(grid.azimuth_count); ++i)
        block[i] = scalar::blend_layer_block(table, place, i);
    layers.fuzz_scale = block[scalar::find_block_average(grid.azimuth_count) + 1].y;
    layers.row_scale = 0;
}

MaterialLayers make_material_layers(const std::vector<Material>& materials,
                                    const TexturedMaterials& textured) {
    MaterialLayers result;
    std::vector<Block> blocks;
    std::vector<Row> rows, fuzz_rows;
    for (uint32_t k = 0; k < materials.size(); ++k) {
        const Material& material = materials[k];
        const bool has_layers = is_layered(material);
        result.record_of_material.push_back(has_layers ? uint32_t(result.records.size()) : kNoIndex);
        if (!has_layers) continue;
        const TexturedMaterial* placed = textured.find(k);
        if (placed && !placed->has_vertex_numbers) placed = nullptr;
        add_block({.material = &material, .textured = placed}, blocks, result);
    }
    for (const Block& block : blocks) {
        const scalar::LayerGrid& grid = result.grids[block.record];
        for (uint32_t azimuth = 0; azimuth < grid.azimuth_count; ++azimuth)
            for (uint32_t k = 0; k < grid.row_count; ++k) rows.push_back({block.record, k, azimuth});
        for (uint32_t k = 0; k < block.fuzz_rows; ++k) fuzz_rows.push_back({block.record, k, 0});
    }
    std::vector<Vec2f> fuzz = result.entries; // without rests, which are measured beside them
    parallel_for("fuzz", fuzz_rows.size(), 1, [&](size_t begin, size_t end) {
        for (size_t k = begin; k < end; ++k)
            fill_fuzz_row(blocks[fuzz_rows[k].block], fuzz_rows[k].row, result, fuzz);
    });
    parallel_for("layers", rows.size(), 1, [&](size_t begin, size_t end) {
        for (size_t k = begin; k < end; ++k) fill_rests(blocks[rows[k].block], rows[k], fuzz, result);
    });
    for (uint32_t k = 0; k < result.records.size(); ++k)
        fill_averages(result.grids[k], &result.entries[result.records[k].first_entry]);
    return result;
}

} // namespace relief
