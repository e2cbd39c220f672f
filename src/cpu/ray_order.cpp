#include "cpu/ray_order.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace relief::cpu {

namespace {

/// The sphere of directions is cut into so many columns and rows of an octahedral map (Meyer et al. 2010).
constexpr int kCellsASide = 16;
constexpr size_t kLeastRays = 256; ///< of fewer rays few go the same way

/// NaN is in the last one.
uint32_t find_column(float coordinate) {
    constexpr float kLast = float(kCellsASide) - 0.5f;
    const float place = (coordinate + 1) * (0.5f * kCellsASide);
    return uint32_t(place < kLast ? std::max(place, 0.0f) : kLast);
}

/// Of a finite direction; any cell for others.
uint32_t find_cell(const Vec3f& d) {
    const float scale = 1 / (std::fabs(d.x) + std::fabs(d.y) + std::fabs(d.z));
    const float x = d.x * scale, y = d.y * scale;
    // The lower half is folded out over the corners.
    const float u = d.z < 0 ? std::copysign(1 - std::fabs(y), x) : x;
    const float v = d.z < 0 ? std::copysign(1 - std::fabs(x), y) : y;
    return find_column(v) * kCellsASide + find_column(u);
}

/// To at least so many members.
template <class T> void grow_to(std::vector<T>& members, size_t count) {
    if (members.size() < count) members.resize(count);
}

/// Fills order.places and order.rays: rays of one cell of directions after those of another. Stable. False,
/// with the places alone, for fewer rays than an order is worth its time for.
bool order_by_direction(std::span<const TraceRay> rays, RayOrder& order) {
    constexpr size_t kCellCount = size_t(kCellsASide) * kCellsASide;
    // Rays of a packet have one LOD bias: those of M_0 come before those of a coarser surface.
    constexpr size_t kKeyCount = 2 * kCellCount;
    order.places.resize(rays.size());
    if (rays.size() < kLeastRays) {
        std::iota(order.places.begin(), order.places.end(), 0u);
        return false;
    }
    std::array<uint32_t, kKeyCount + 1> begin{};
    grow_to(order.cells, rays.size());
    for (size_t k = 0; k < rays.size(); ++k) {
        order.cells[k] = uint16_t(find_cell(rays[k].direction) + (rays[k].lod_bias > 0 ? kCellCount : 0));
        ++begin[order.cells[k] + 1];
    }
    for (size_t cell = 0; cell < kKeyCount; ++cell) begin[cell + 1] += begin[cell];
    for (uint32_t k = 0; k < rays.size(); ++k) order.places[begin[order.cells[k]]++] = k;
    grow_to(order.rays, rays.size());
    for (size_t k = 0; k < rays.size(); ++k) order.rays[k] = rays[order.places[k]];
    return true;
}

/// `trace` takes rays and where to put what it finds; `found` is in the order of `rays` again.
template <class Found, class Trace>
void trace_in_order(std::span<const TraceRay> rays, std::span<Found> found, RayOrder& order,
                    std::vector<Found>& in_order, const Trace& trace) {
    if (!order_by_direction(rays, order)) return trace(rays, found);
    grow_to(in_order, rays.size());
    trace(std::span<const TraceRay>(order.rays).first(rays.size()), std::span(in_order).first(rays.size()));
    for (size_t k = 0; k < rays.size(); ++k) found[order.places[k]] = in_order[k];
}

} // namespace

void closest_scattered_hits(const Tracer& tracer, std::span<const TraceRay> rays, std::span<TraceHit> hits,
                            int depth, RayOrder& order) {
    trace_in_order(rays, hits, order, order.hits,
                   [&](const auto& some, const auto& found) { tracer.closest_hits(some, found, depth); });
}

void any_scattered_hits(const Tracer& tracer, std::span<const TraceRay> rays, std::span<uint8_t> occluded,
                        int depth, RayOrder& order) {
    trace_in_order(rays, occluded, order, order.occluded,
                   [&](const auto& some, const auto& found) { tracer.any_hits(some, found, depth); });
}

} // namespace relief::cpu
