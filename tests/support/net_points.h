// Points for integrals over three numbers in [0, 1), with a far smaller error than scrambled or random ones.
#pragma once

#include <cstdint>

#include "formulas/sobol.h"

namespace relief::test {

struct NetPoint {
    float x;
    Vec2f yz;
};

/// Point k of `count`, a power of two: k + 1/2 over `count`, and the (0, 2)-sequence of Sobol; together a
/// (0, m, 3)-net in base 2.
inline NetPoint find_net_point(uint32_t k, uint32_t count) {
    return {(float(k) + 0.5f) / float(count),
            {scalar::uint_to_unit(scalar::reverse_bits(k)),
             scalar::uint_to_unit(scalar::reverse_bits(scalar::shift_polynomial(k)))}};
}

} // namespace relief::test
