// Texels of maps by integer coordinates, beyond the border of a tile those of the tile beside it: read_beyond_tile of
// surface/map/tile_texels.h.
#ifndef RELIEF_TILE_TEXELS_GLSL
#define RELIEF_TILE_TEXELS_GLSL

#include "vulkan/shaders/scene.glsl"

layout(constant_id = kTileBordersConstant) const uint kHasTileBorders = 0;

/// An image of a map: copy `mip` of a tile.
struct MapImage {
    TextureData texels;
    uint tile, mip;
};

/// The tile beside one in the direction that leads to `at`, outside of [0, size); kNoTile where there is none.
uint find_neighbour(const MapData map, const uint tile, const int at, const int size, const uint first_direction) {
    if (at >= 0 && at < size) return kNoTile;
    uint beside = texelFetch(override_bits, int(map.first_neighbour + 2u * tile + first_direction / 2u)).x;
    return at < 0 ? beside & 0xffffu : beside >> 16u;
}

bool is_near_tile(const int at, const int size) {
    int margin = find_tile_margin(size);
    return at >= -margin && at < size + margin;
}

vec3 read_between(const TextureData texels, const ivec2 at, const ivec2 size) {
    ivec2 own = ivec2(int(texels.width), int(texels.height));
    precise vec2 place = vec2(scale_texel_place(at.x, size.x, own.x), scale_texel_place(at.y, size.y, own.y));
    precise vec2 low = vec2(floor_texel(place.x), floor_texel(place.y));
    precise vec2 part = place - low;
    ivec2 first = clamp(ivec2(low), ivec2(0), own - 1);
    ivec2 last = clamp(ivec2(low) + 1, ivec2(0), own - 1);
    // Without resampling along an axis of the same size.
    if (own.x == size.x) {
        first.x = last.x = at.x;
        part.x = 0.0;
    }
    if (own.y == size.y) {
        first.y = last.y = at.y;
        part.y = 0.0;
    }
    vec3 t00 = load_texel(texels, uint(first.x), uint(first.y)).xyz;
    if (first == last) return t00;
    vec3 t10 = load_texel(texels, uint(last.x), uint(first.y)).xyz;
    vec3 t01 = load_texel(texels, uint(first.x), uint(last.y)).xyz;
    vec3 t11 = load_texel(texels, uint(last.x), uint(last.y)).xyz;
    return vec3(filter_texels(t00.x, t10.x, t01.x, t11.x, part.x, part.y),
                filter_texels(t00.y, t10.y, t01.y, t11.y, part.x, part.y),
                filter_texels(t00.z, t10.z, t01.z, t11.z, part.x, part.y));
}

vec3 load_beyond_tile(const MapImage image, const MapData map, const ivec2 place, const ivec2 size) {
    ivec2 at = place;
    uint tile = image.tile;
    for (int k = 0; k < kMostTileSteps; ++k) {
        uint next = find_neighbour(map, tile, at.x, size.x, 0u);
        if (next != kNoTile) {
            at.x += at.x < 0 ? size.x : -size.x;
        } else {
            next = find_neighbour(map, tile, at.y, size.y, 2u);
            if (next == kNoTile) break;
            at.y += at.y < 0 ? size.y : -size.y;
        }
        tile = next;
    }
    if (at.x < 0 || at.x >= size.x || at.y < 0 || at.y >= size.y) {
        if (!is_near_tile(at.x, size.x) || !is_near_tile(at.y, size.y)) return map.midlevel;
        at = ivec2(wrap_texel(at.x, size.x, map.wrap), wrap_texel(at.y, size.y, map.wrap));
        if (at.x < 0 || at.y < 0) return map.midlevel;
    }
    return read_between(textures[map.first_tile + image.mip * map.tile_count + tile], at, size);
}

/// Texel for a fetch; where none is, and outside with kWrapBlack, there is no displacement. `wrapped` is `at` by
/// wrap_texel: callers wrap each row and column once, which takes fewer registers.
vec3 load_map_texel(const MapImage image, const MapData map, const ivec2 at, const ivec2 wrapped) {
    ivec2 size = ivec2(int(image.texels.width), int(image.texels.height));
    if (kHasTileBorders != 0 && map.first_neighbour != kNone &&
        (at.x < 0 || at.y < 0 || at.x >= size.x || at.y >= size.y))
        return load_beyond_tile(image, map, at, size);
    return wrapped.x < 0 || wrapped.y < 0 ? map.midlevel
                                          : load_texel(image.texels, uint(wrapped.x), uint(wrapped.y)).xyz;
}

#endif
