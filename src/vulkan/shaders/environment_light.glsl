// Environment light: radiance and importance sampling. The table: cumulative distribution of rows, then of cells.
#ifndef RELIEF_ENVIRONMENT_LIGHT_GLSL
#define RELIEF_ENVIRONMENT_LIGHT_GLSL

#include "vulkan/shaders/textures.glsl"
#include "formulas/warp.h"
#include "formulas/light.h"
#include "formulas/environment.h"

layout(set = 0, binding = kBindEnvironment) uniform samplerBuffer environment_table;

/// A sampled direction with its position in the image; density per solid angle.
struct EnvironmentDraw {
    vec3 direction;
    float pdf;
    vec2 position;
};

float load_cumulative(const uint first, const uint index) {
    return texelFetch(environment_table, int(first + index)).x;
}

/// First entry of the cells of a row.
uint find_row(const EnvironmentData e, const uint row) { return e.cells_y + 1u + row * (e.cells_x + 1u); }

/// Interval of a cumulative distribution of `count` intervals that contains u; never one of zero width.
uint find_interval(const uint first, const uint count, const float u) {
    uint low = 0u;
    uint high = count - 1u;
    while (low < high) {
        uint middle = (low + high) / 2u;
        if (load_cumulative(first, middle + 1u) > u)
            high = middle;
        else
            low = middle + 1u;
    }
    return low;
}

float cell_density(const EnvironmentData e, const uint column, const uint row, const vec3 direction) {
    uint cells = find_row(e, row);
    float in_row = load_cumulative(cells, column + 1u) - load_cumulative(cells, column);
    float probability = in_row * (load_cumulative(0u, row + 1u) - load_cumulative(0u, row));
    return environment_cell_density(e, probability, direction);
}

EnvironmentDraw draw_environment_direction(const EnvironmentData e, const vec2 u) {
    if (e.texture_index == kNone) {
        EnvironmentDraw uniform_draw = {square_to_sphere(u), sphere_pdf(), vec2(0.0)};
        return uniform_draw;
    }
    uint row = find_interval(0u, e.cells_y, u.y);
    uint cells = find_row(e, row);
    uint column = find_interval(cells, e.cells_x, u.x);
    float x = locate_in_interval(u.x, load_cumulative(cells, column), load_cumulative(cells, column + 1u));
    float y = locate_in_interval(u.y, load_cumulative(0u, row), load_cumulative(0u, row + 1u));
    EnvironmentDraw drawn;
    drawn.position = vec2((float(column) + x) / float(e.cells_x), (float(row) + y) / float(e.cells_y));
    drawn.direction = turn_out_of_environment(e, latlong_to_direction(drawn.position));
    drawn.pdf = cell_density(e, column, row, drawn.direction);
    return drawn;
}

/// Radiance at a position in the image.
vec3 environment_radiance_at(const EnvironmentData e, const vec2 position) {
    return e.texture_index == kNone ? e.scale : fetch_latlong(e.texture_index, position) * e.scale;
}

vec3 environment_radiance(const EnvironmentData e, const vec3 direction) {
    return environment_radiance_at(e, locate_in_environment(e, direction));
}

/// Sampling density of a direction.
float environment_pdf(const EnvironmentData e, const vec3 direction) {
    if (e.texture_index == kNone) return sphere_pdf();
    vec2 position = locate_in_environment(e, direction);
    return cell_density(e, uint(locate_environment_cell(position.x, float(e.cells_x))),
                        uint(locate_environment_cell(position.y, float(e.cells_y))), direction);
}

#endif
