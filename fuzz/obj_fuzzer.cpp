// OBJ text must end in a mesh whose indices are in range or in an Error, and the mesh in surfaces whose
// vertices lie in the boxes of their patches or in an Error: plain, and displaced where it has uvs.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string_view>

#include "io/mesh_obj.h"
#include "math/vec.h"
#include "relief/error.h"
#include "surface/surface.h"

namespace relief {

namespace {

constexpr uint32_t kMapSize = 4;

/// A small map that moves every texel differently.
Displacement make_displacement() {
    auto texture = std::make_shared<Texture>();
    texture->width = texture->height = kMapSize;
    for (uint32_t k = 0; k < 4 * kMapSize * kMapSize; ++k)
        texture->floats.push_back(float(k * 37 % 11) * 0.1f - 0.5f);
    Displacement displacement;
    displacement.tiles.push_back({1001, texture});
    return displacement;
}

void check_surface(const Mesh& mesh, const Displacement* displacement) {
    try {
        const Surface surface = make_surface(mesh, displacement, Affine{});
        for (const Quad& quad : surface.quads)
            for (const uint32_t vertex : quad.vertex)
                if (vertex >= surface.positions.size()) std::abort();
        if (!surface.has_displacement) return;
        const PatchLevels levels{2, {2, 1, 0, 2}};
        for (uint32_t patch = 0; patch < surface.patch_count(); ++patch) {
            const Box box = compute_patch_box(surface, patch);
            for (uint32_t k = 0; k < 25; ++k) {
                const Vec3f p = evaluate_vertex(surface, patch, levels, k % 5, k / 5);
                if (!box.contains(p)) std::abort();
            }
        }
    } catch (const Error&) {
        // refused with a message: what is wanted
    }
}

} // namespace

} // namespace relief

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    try {
        const relief::Mesh mesh = relief::parse_obj({reinterpret_cast<const char*>(data), size}, "fuzz.obj");
        for (const uint32_t index : mesh.position_indices)
            if (index >= mesh.positions.size()) std::abort();
        for (const uint32_t index : mesh.uv_indices)
            if (index >= mesh.uvs.size()) std::abort();
        static const relief::Displacement displacement = relief::make_displacement();
        relief::check_surface(mesh, nullptr);
        if (!mesh.uv_indices.empty()) relief::check_surface(mesh, &displacement);
    } catch (const relief::Error&) {
        // refused with a message: what is wanted
    }
    return 0;
}
