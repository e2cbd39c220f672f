// The environment as a light for sixteen directions: bit-identical to EnvironmentLight.
#pragma once

#include <cstring>

#include "cpu/shading/environment_light.h"
#include "cpu/shading/texture_lanes-inl.h"
#include "formulas/environment_data.h"

HWY_BEFORE_NAMESPACE();
namespace relief::HWY_NAMESPACE {
namespace wide {

using scalar::EnvironmentData;
#define RELIEF_LANES
#include "formulas/environment.h"
#undef RELIEF_LANES

/// Interval of a cumulative distribution, and a place within it.
struct Interval {
    Uint index;
    Float position; ///< [0, 1)
    Float width;    ///< its probability
};

/// Number of the guide of a random number; its distribution's guides begin at `first`.
RELIEF_INLINE Uint locate_guide(const Uint& first, const Float& u) {
    const float count = float(cpu::EnvironmentTables::kGuides);
    return first + Uint(min(u * Float(count), Float(count - 1)));
}

/// The distribution begins at cumulative[first].
RELIEF_INLINE Interval find_interval(const float* cumulative, const Uint& first, const Uint& guide,
                                     const Float& u) {
    Uint index = first + (guide & Uint(0xffffu)), length = (guide >> 16) - (guide & Uint(0xffffu));
    while (!length.is_zero()) {
        const Uint half = (length + Uint(1u)) >> 1;
        index = select(gather(cumulative, index + half) <= u, index + half, index);
        length -= half;
    }
    const Float low = gather(cumulative, index), high = gather(cumulative, index + Uint(1u));
    return {index - first, locate_in_interval(u, low, high), high - low};
}

/// Density per solid angle of directions in cells.
RELIEF_INLINE Float find_cell_density(const cpu::EnvironmentTables& tables, const Uint& column,
                                      const Uint& row, const Vec3& direction) {
    const Uint cell = row * Uint(tables.data.cells_x + 1) + column;
    const auto find_share = [](const float* cumulative, const Uint& index) HWY_ATTR {
        return gather(cumulative, index + Uint(1u)) - gather(cumulative, index);
    };
    return environment_cell_density(
        tables.data, find_share(tables.columns, cell) * find_share(tables.rows, row), direction);
}

/// A place in the environment's image in texels from the centre of texel (0, 0).
RELIEF_INLINE Vec2 locate_on_image(const Texture& texture, const Vec2& position) {
    return locate_latlong(position, {Float(float(texture.width)), Float(float(texture.height))});
}

/// Radiance at sixteen places; of lanes that `which` lacks anything.
RELIEF_INLINE Vec3 fetch_radiance(const cpu::EnvironmentTables& tables, const FourTexelLanes& places,
                                  LaneMask which) {
    const Vec3 color = places.fetch(*tables.texture, which);
    const Vec3f& scale = tables.data.scale;
    return {color.x * Float(scale.x), color.y * Float(scale.y), color.z * Float(scale.z)};
}

/// EnvironmentLight::look_up of each direction.
inline void look_up_environment(const cpu::EnvironmentTables& tables, const Vec3f* directions, size_t count,
                                cpu::EnvironmentLookup* found) {
    static_assert(sizeof(cpu::EnvironmentLookup) == 16);
    const scalar::EnvironmentData& data = tables.data;
    const Float cells_x(float(data.cells_x)), cells_y(float(data.cells_y));
    struct Round {
        FourTexelLanes places;
        alignas(64) float densities[16];
    };
    const auto find_cell = [](const Float& at, const Float& cells, uint32_t cell_count) HWY_ATTR {
        return min(Uint(locate_environment_cell(at, cells)), Uint(cell_count - 1));
    };
    const auto locate = [&](Round& round, size_t first, size_t left) HWY_ATTR {
        const Vec3 direction = load_vectors(directions + first, left);
        const Vec2 position = locate_in_environment(data, direction);
        round.places.place(*tables.texture, locate_on_image(*tables.texture, position), TexelRows::clamped);
        round.places.prefetch(*tables.texture, first_lanes(left));
        find_cell_density(tables, find_cell(position.x, cells_x, data.cells_x),
                          find_cell(position.y, cells_y, data.cells_y), direction)
            .store(round.densities);
    };
    const auto fetch = [&](const Round& round, size_t first, size_t left) HWY_ATTR {
        const Vec3 radiance = fetch_radiance(tables, round.places, first_lanes(left));
        LaneQuads quads;
        quads.set(radiance.x, radiance.y, radiance.z, Float::load(round.densities));
        std::memcpy(found + first, quads.lane, 16 * HWY_MIN(size_t(16), left));
    };
    run_rounds<Round>(count, locate, fetch);
}

/// EnvironmentLight::radiance of each place.
inline void fetch_environment(const cpu::EnvironmentTables& tables, const Vec2f* positions, size_t count,
                              Vec3f* radiances) {
    const auto locate = [&](FourTexelLanes& places, size_t first, size_t left) HWY_ATTR {
        places.place(*tables.texture, locate_on_image(*tables.texture, load_pairs(positions + first, left)),
                     TexelRows::clamped);
        places.prefetch(*tables.texture, first_lanes(left));
    };
    const auto fetch = [&](const FourTexelLanes& places, size_t first, size_t left) HWY_ATTR {
        store_vectors(fetch_radiance(tables, places, first_lanes(left)), left, radiances + first);
    };
    run_rounds<FourTexelLanes>(count, locate, fetch);
}

template <class T> RELIEF_INLINE void prefetch(const T* base, const Uint& index) {
    alignas(64) uint32_t stored[16];
    index.store(stored);
    for (const uint32_t k : stored) __builtin_prefetch(base + k);
}

/// Sixteen directions on their way.
struct DrawLanes {
    Vec2 u;
    Interval row;
    Uint guide, first; ///< of the cells of the row

    RELIEF_INLINE void find_row(const cpu::EnvironmentTables& tables, const Vec2f* pairs, size_t count) {
        const uint32_t guides = cpu::EnvironmentTables::kGuides;
        u = load_pairs(pairs, count);
        const Uint guide_of_rows = locate_guide(Uint(tables.data.cells_y * guides), u.y);
        row = find_interval(tables.rows, Uint(0u), gather(tables.guides, guide_of_rows), u.y);
        first = row.index * Uint(tables.data.cells_x + 1);
        guide = locate_guide(row.index * Uint(guides), u.x);
        prefetch(tables.guides, guide);
    }
    RELIEF_INLINE void find_guide(const cpu::EnvironmentTables& tables) {
        guide = gather(tables.guides, guide);
        prefetch(tables.columns, first + (guide & Uint(0xffffu)));
    }
    RELIEF_INLINE void finish(const cpu::EnvironmentTables& tables, size_t count,
                              cpu::DirectionSample* drawn) const {
        const EnvironmentData& data = tables.data;
        const Interval column = find_interval(tables.columns, first, guide, u.x);
        const Vec2 position{(Float(column.index) + column.position) / Float(float(data.cells_x)),
                            (Float(row.index) + row.position) / Float(float(data.cells_y))};
        const Vec3 direction = turn_out_of_environment(data, latlong_to_direction(position));
        LaneQuads quads;
        quads.set(direction.x, direction.y, direction.z,
                  environment_cell_density(data, column.width * row.width, direction));
        alignas(64) float x[16], y[16];
        position.x.store(x), position.y.store(y);
        for (size_t lane = 0; lane < HWY_MIN(size_t(16), count); ++lane) {
            std::memcpy(&drawn[lane], quads.lane[lane], 16);
            drawn[lane].position = {x[lane], y[lane]};
        }
    }
};

/// EnvironmentLight::draw_direction of each pair.
inline void draw_directions(const cpu::EnvironmentTables& tables, const Vec2f* u, size_t count,
                            cpu::DirectionSample* drawn) {
    static_assert(offsetof(cpu::DirectionSample, pdf) == 12);
    run_rounds<DrawLanes>(
        count,
        [&](DrawLanes& lanes, size_t first, size_t left)
            HWY_ATTR { lanes.find_row(tables, u + first, left); },
        [&](DrawLanes& lanes, size_t, size_t) HWY_ATTR { lanes.find_guide(tables); },
        [&](const DrawLanes& lanes, size_t first, size_t left)
            HWY_ATTR { lanes.finish(tables, left, drawn + first); });
}

} // namespace wide
} // namespace relief::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
