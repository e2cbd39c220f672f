// Owen-scrambled Sobol sampler, a pure function of (seed, pixel, sample index, dimension pair). Burley 2020,
// Practical Hash-based Owen Scrambling (JCGT 9, 4): each pair of dimensions is the (0, 2)-sequence of Sobol,
// scrambled independently. Samples do not depend on their count, so renders can be extended.
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

FN uint hash_combine(uint seed, uint value) { return hash_uint(seed ^ (hash_uint(value) + 0x9e3779b9u)); }

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
FN uint scramble_reversed(uint x, uint seed) {
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

/// Seed of one pixel for a render seed.
FN uint make_pixel_seed(uint seed, uint x, uint y) {
    return hash_combine(hash_combine(hash_uint(seed), x), y);
}

/// Point `index` of the scrambled sequence of a pair of dimensions, as 32-bit fractions.
FN UintPair sobol_bits(uint pixel_seed, uint index, uint pair) {
    uint pair_seed = hash_combine(pixel_seed, pair);
    uint shuffled = reverse_bits(scramble_reversed(reverse_bits(index), pair_seed));
    UintPair result = {
        reverse_bits(scramble_reversed(shuffled, hash_combine(pair_seed, 1u))),
        reverse_bits(scramble_reversed(shift_polynomial(shuffled), hash_combine(pair_seed, 2u)))};
    return result;
}

/// Float in [0, 1) from the upper 24 bits, the precision of a float.
FN Float uint_to_unit(uint bits) { return Float(bits >> 8u) * Float(5.9604644775390625e-8f); }

/// Point in [0, 1)^2 of sample `index` in a pair of dimensions.
FN Vec2 sobol_pair(uint pixel_seed, uint index, uint pair) {
    UintPair bits = sobol_bits(pixel_seed, index, pair);
    Vec2 result = {uint_to_unit(bits.x), uint_to_unit(bits.y)};
    return result;
}

#include "formulas/end.h"
#endif
