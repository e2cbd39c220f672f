// Ray queries of other programs on the device: spans in, hits out, in batches.
#pragma once

#include <span>

#include "relief/intersect.h"
#include "vulkan/tracer.h"

namespace relief::vulkan {

/// Not thread safe. Binds its lists on every call, so that it can share a tracer.
class RayBatch {
  public:
    /// The tracer must outlive it. Throws Error{out_of_memory}.
    explicit RayBatch(Tracer& tracer);

    /// Spans of equal, arbitrary length; `mask` as for Engine.
    void closest_hits(std::span<const Ray> rays, std::span<RayHit> hits, uint32_t mask);
    void any_hits(std::span<const Ray> rays, std::span<uint8_t> hits, uint32_t mask);

  private:
    /// One batch of at most capacity_ rays.
    void upload(std::span<const Ray> rays);

    Tracer& tracer_;
    uint32_t capacity_;
    Kernel geometric_normal_;
    Buffer list_, points_;
};

} // namespace relief::vulkan
