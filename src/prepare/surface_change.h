// What an edit, or another time of a scene, has changed of a surface.
#pragma once

#include <cstdint>
#include <vector>

namespace relief {

/// Patches of a surface, a byte each: those whose displacement has changed, and those that look different,
/// which are more: shading normals read beyond the sides of a patch.
struct SurfaceChange {
    uint32_t surface = 0;
    std::vector<uint8_t> is_changed, looks_different;
    bool is_replaced = false; ///< it is another one, with other patches: both are empty
};

} // namespace relief
