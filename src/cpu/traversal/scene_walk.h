// A traversal of the scene in place of the engine's own: src/lab has those of papers 2 and 3.
#pragma once

#include <cstddef>

#include "cpu/traversal/kernels.h"

namespace relief::cpu {

/// Immutable; thread safe. What patches and polygons do with a ray is given by `primitive`.
class SceneWalk {
  public:
    virtual ~SceneWalk() = default;

    /// As those of Kernels.
    virtual void closest_hits(const SceneView& scene, const PrimitiveKernels& primitive,
                              TraceContext& context, const TraceRay* rays, TraceHit* hits,
                              size_t count) const = 0;
    virtual void any_hits(const SceneView& scene, const PrimitiveKernels& primitive, TraceContext& context,
                          const TraceRay* rays, uint8_t* occluded, size_t count) const = 0;
    virtual size_t byte_count() const = 0;
};

} // namespace relief::cpu
