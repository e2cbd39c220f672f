#include "surface/mesh/base_tolerance.h"

#include <algorithm>

namespace relief {

bool is_same_base(const BaseTolerance& then, const BaseTolerance& now, const BaseReserve& reserve) {
    if (then == now) return true;
    if (reserve.is_cut) return false; // where and how depends on the tolerance
    const size_t count = std::max<size_t>({then.of_faces.size(), now.of_faces.size(), 1});
    for (uint32_t face = 0; face < count; ++face) {
        const int before = then.of_faces.empty() ? then.exponent : then.of_faces[face];
        const int after = now.of_faces.empty() ? now.exponent : now.of_faces[face];
        if (after < before - reserve.spare_steps) return false;
    }
    return true;
}

} // namespace relief
