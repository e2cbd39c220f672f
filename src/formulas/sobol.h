// Owen-scrambled Sobol sampler, a pure function of (seed, pixel, sample index, dimension pair). Burley 2020,
// Practical Hash-based Owen Scrambling (JCGT 9, 4): each pair of dimensions is the (0, 2)-sequence of Sobol,
// scrambled independently. Samples do not depend on their count, so renders can be extended. The first
// sixteen points of the pixels of a block of 8 x 8 are nets together, too, so that their error is closer to
// blue noise; Ahmed and Wonka 2020 do it for a known count (docs/decisions/blue-noise.md).
#if !defined(RELIEF_SOBOL_H) || defined(RELIEF_LANES)
#ifndef RELIEF_LANES
#define RELIEF_SOBOL_H
#endif
#include "formulas/begin.h"

struct UintPair {
    uint x, y;
};

/// Integer hash with full avalanche (Wellons 2018, hash prospector, lowbias32).
FN uint hash_uint(uint x) {
    x ^= x >> 16u;
    x *= 0x7feb352du;
    x ^= x >> 15u;
    x *= 0x846ca68bu;
    x ^= x >> 16u;
    return x;
}

FN uint hash_combine(const uint seed, const uint value) {
    return hash_uint(seed ^ (hash_uint(value) + 0x9e3779b9u));
}

FN uint reverse_bits(uint x) {
    x = (x << 16u) | (x >> 16u);
    x = ((x & 0x00ff00ffu) << 8u) | ((x & 0xff00ff00u) >> 8u);
    x = ((x & 0x0f0f0f0fu) << 4u) | ((x & 0xf0f0f0f0u) >> 4u);
    x = ((x & 0x33333333u) << 2u) | ((x & 0xccccccccu) >> 2u);
    x = ((x & 0x55555555u) << 1u) | ((x & 0xaaaaaaaau) >> 1u);
    return x;
}

/// Owen scrambling of a bit-reversed integer: each bit is flipped by a hash of the lower ones (Laine and
/// Karras 2011, with the constants of Vegdahl 2021).
FN uint scramble_reversed(uint x, const uint seed) {
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16u) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

/// Bit-reversed second Sobol coordinate of an index: the index as a polynomial over GF(2), shifted by one (t
/// -> 1 + t), which is what the direction numbers v_{k+1} = v_k ^ (v_k >> 1) sum up to.
FN uint shift_polynomial(uint x) {
    x ^= x >> 16u;
    x ^= (x & 0xff00ff00u) >> 8u;
    x ^= (x & 0xf0f0f0f0u) >> 4u;
    x ^= (x & 0xccccccccu) >> 2u;
    x ^= (x & 0xaaaaaaaau) >> 1u;
    return x;
}

/// Seed of one pixel for a render seed: a hash of its block of 8 x 8 pixels, and its place there along a
/// Morton curve.
FN uint make_pixel_seed(const uint seed, const uint x, const uint y) {
    uint block = hash_combine(hash_combine(hash_uint(seed), x >> 3u), y >> 3u);
    uint place = (x & 1u) | ((y & 1u) << 1u) | ((x & 2u) << 1u) | ((y & 2u) << 2u) | ((x & 4u) << 2u) |
                 ((y & 4u) << 3u);
    return (block & 0xffffffc0u) | place;
}

/// Bit-reversed digital shifts of the first six bits of a pixel's points, by its place: of x in bits 0 to 5,
/// of y in bits 6 to 11. The columns are those of generator matrices, found by search: the first 2^a points
/// of 2^b pixels along the curve, a <= 4, a + b <= 6, together are (t, a + b, 2)-nets. t is 0 for 1 point of
/// 2 x 2, 4 x 4 and 8 x 8 pixels and for 16 points of 2 x 2, elsewhere at most 1, 2 for 8 points of 2 x 2.
FN uint shift_by_place(const uint place) {
    uint shifts = (0u - (place & 1u)) & 0x6ffu;
    shifts ^= (0u - ((place >> 1u) & 1u)) & 0xb6au;
    shifts ^= (0u - ((place >> 2u) & 1u)) & 0x3ceu;
    shifts ^= (0u - ((place >> 3u) & 1u)) & 0xcdcu;
    shifts ^= (0u - ((place >> 4u) & 1u)) & 0xba9u;
    shifts ^= (0u - ((place >> 5u) & 1u)) & 0x6bdu;
    return shifts;
}

/// Owen shuffling of an index among those with the same highest bit: any first 2^a stay the first 2^a.
FN uint shuffle_octave(const uint index, const uint seed) {
    uint below = index;
    below |= below >> 1u;
    below |= below >> 2u;
    below |= below >> 4u;
    below |= below >> 8u;
    below |= below >> 16u;
    uint highest = below ^ (below >> 1u);
    return highest | (reverse_bits(scramble_reversed(reverse_bits(index), seed)) & (below >> 1u));
}

FN uint swap_halves(const uint x) { return (x << 16u) | (x >> 16u); }

/// Point `index` of the scrambled sequence of a pair of dimensions, as 32-bit fractions. The pixels of a
/// block share their scrambling and have points of their own by digital shifts: of the first six bits by
/// their place, of those below by a hash.
FN UintPair sobol_bits(const uint pixel_seed, const uint index, const uint pair) {
    uint seed_x = hash_combine(pixel_seed & 0xffffffc0u, pair);
    uint seed_y = hash_uint(seed_x ^ 0x68bc21ebu);
    uint own_seed = hash_combine(pixel_seed, pair ^ 0x80000000u);
    uint place = reverse_bits(scramble_reversed(reverse_bits(pixel_seed & 63u), hash_uint(seed_y)));
    uint shifts = shift_by_place(place & 63u);
    uint x = shuffle_octave(index, hash_uint(own_seed));
    uint y = shift_polynomial(x);
    x ^= (shifts & 63u) | (own_seed & 0xffffffc0u);
    y ^= (shifts >> 6u) | (swap_halves(own_seed) & 0xffffffc0u);
    UintPair result = {reverse_bits(scramble_reversed(x, seed_x)),
                       reverse_bits(scramble_reversed(y, seed_y))};
    return result;
}

/// Float in [0, 1) from the upper 24 bits, the precision of a float.
FN Float uint_to_unit(const uint bits) { return Float(bits >> 8u) * Float(5.9604644775390625e-8f); }

/// Point in [0, 1)^2 of sample `index` in a pair of dimensions.
FN Vec2 sobol_pair(const uint pixel_seed, const uint index, const uint pair) {
    UintPair bits = sobol_bits(pixel_seed, index, pair);
    Vec2 result = {uint_to_unit(bits.x), uint_to_unit(bits.y)};
    return result;
}

#include "formulas/end.h"
#endif
