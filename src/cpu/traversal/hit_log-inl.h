// Hits of a bundle as they are found, all of one instance: a ray keeps the index of its nearest one;
// TraceHits are completed sixteen at a time at the end, since most rays meet several hits before the nearest.
#pragma once

#include <cstddef>
#include <cstring>

#include "base/check.h"
#include "cpu/traversal/ray_bundle-inl.h"
#include "cpu/traversal/triangle_test-inl.h"

HWY_BEFORE_NAMESPACE();
namespace relief::HWY_NAMESPACE {

/// What sixteen hits are on.
struct HitPlaces {
    LaneIndices patch;
    LaneIndices cell; ///< i, j << 16, and kUpper for second triangles
    uint32_t levels;  ///< as in TraceHit
    float cell_size;  ///< in (u, v) of the patch

    static constexpr uint32_t kUpper = 1u << 31;
};

struct HitLog {
    static constexpr uint32_t kCapacity = 512, kRoom = kCapacity + 16; ///< whole registers are stored

    alignas(64) float u[kRoom], v[kRoom], w[kRoom]; ///< edge functions
    alignas(64) float t[kRoom]; ///< place along the major axis; once taken, that of the hit
    alignas(64) float cell_size[kRoom];
    alignas(64) uint32_t ray[kRoom], patch[kRoom], cell[kRoom], levels[kRoom];
    alignas(64) float hit[kRoom][8]; ///< a TraceHit each, of make_hits; it takes no time to begin with
    uint32_t count = 0;

    RELIEF_INLINE bool has_room() const { return count + 16 <= kCapacity; }

    /// The lanes of test.mask.
    RELIEF_INLINE void append(const TriangleTest<16>& test, const LaneIndices& rays,
                              const HitPlaces& places) {
        DCHECK(has_room());
        constexpr size_t kLanes = Lanes16::kLanes;
        const Lanes16::D d;
        const hn::RebindToUnsigned<LaneIndices::D> du;
        for (size_t p = 0; p < Lanes16::kParts; ++p) {
            const LaneMask of_part = test.mask >> (p * kLanes) & ((1u << kLanes) - 1);
            store_compressed(d, test.u.part[p], of_part, u + count);
            store_compressed(d, test.v.part[p], of_part, v + count);
            store_compressed(d, test.w.part[p], of_part, w + count);
            store_compressed(d, test.t.part[p], of_part, t + count);
            store_compressed(du, hn::BitCast(du, rays.part[p]), of_part, ray + count);
            store_compressed(du, hn::BitCast(du, places.patch.part[p]), of_part, patch + count);
            store_compressed(du, hn::BitCast(du, places.cell.part[p]), of_part, cell + count);
            hn::StoreU(hn::Set(du, places.levels), du, levels + count);
            hn::StoreU(hn::Set(d, places.cell_size), d, cell_size + count);
            count += uint32_t(__builtin_popcount(of_part));
        }
    }
};

static_assert(sizeof(cpu::TraceHit) == 32 && offsetof(cpu::TraceHit, t) == 0 &&
              offsetof(cpu::TraceHit, instance) == 4 && offsetof(cpu::TraceHit, patch) == 8 &&
              offsetof(cpu::TraceHit, u) == 12 && offsetof(cpu::TraceHit, v) == 16 &&
              offsetof(cpu::TraceHit, i) == 20 && offsetof(cpu::TraceHit, j) == 22 &&
              offsetof(cpu::TraceHit, is_upper) == 24 && offsetof(cpu::TraceHit, lod_bias) == 25 &&
              offsetof(cpu::TraceHit, levels) == 28);

/// Hits first..first + 15 of the log, by the operations of locate_in_block and locate_on_polygon.
RELIEF_INLINE void make_hits(const RayBundle& bundle, HitLog& log, uint32_t first) {
    const Lanes16 v = Lanes16::load(log.v + first), w = Lanes16::load(log.w + first);
    const Lanes16 sum = Lanes16::load(log.u + first) + v + w;
    const Lanes16 weight_b = v / sum, weight_c = w / sum, both = weight_b + weight_c;
    const LaneIndices cell = LaneIndices::load(log.cell + first);
    const Lanes16 i = cell.masked(0xffff).to_floats(), j = cell.shifted_down<16>().masked(0x7fff).to_floats();
    const Lanes16 size = Lanes16::load(log.cell_size + first);
    const Lanes16 place_u = (i + select_negative(cell, weight_b, both)) * size,
                  place_v = (j + select_negative(cell, both, weight_c)) * size;
    const LaneIndices flags =
        cell.shifted_down<31>().masked(1) + LaneIndices(int32_t(uint32_t(bundle.rays->lod_bias) << 8));
    LaneQuads begin, end;
    begin.set(Lanes16::load(log.t + first), LaneIndices(int32_t(bundle.instance)).bits(),
              LaneIndices::load(log.patch + first).bits(), place_u);
    end.set(place_v, cell.masked(0x7fffffff).bits(), flags.bits(),
            LaneIndices::load(log.levels + first).bits());
    for (uint32_t lane = 0; lane < 16; ++lane) {
        std::memcpy(log.hit[first + lane], begin.lane[lane], 16);
        std::memcpy(log.hit[first + lane] + 4, end.lane[lane], 16);
    }
}

/// What rays have found so far, into their hits; the log is empty then.
HWY_NOINLINE inline void write_hits(RayBundle& bundle) {
    BundleRays& rays = *bundle.rays;
    HitLog& log = *rays.log;
    if (log.count == 0) return;
    for (uint32_t first = 0; first < log.count; first += 16) make_hits(bundle, log, first);
    for (uint32_t k = 0; k < rays.count; ++k) {
        const uint32_t number = rays.found[k];
        if (number >= kWritten) continue;
        std::memcpy(&rays.hits[k], log.hit[number], sizeof(cpu::TraceHit));
        rays.found[k] = kWritten;
    }
    log.count = 0;
}

/// Whether hit `number` of the log, as far along ray k as what that has found, comes before it.
HWY_NOINLINE inline bool wins_tie(const RayBundle& bundle, uint32_t k, uint32_t number) {
    const BundleRays& rays = *bundle.rays;
    const HitLog& log = *rays.log;
    const uint32_t found = rays.found[k];
    if (found == kNothing) return true;
    const auto make_hit = [&](uint32_t of_log) {
        cpu::TraceHit hit;
        hit.instance = bundle.instance, hit.patch = log.patch[of_log];
        hit.i = uint16_t(log.cell[of_log] & 0xffff), hit.j = uint16_t(log.cell[of_log] >> 16 & 0x7fff);
        hit.is_upper = (log.cell[of_log] & HitPlaces::kUpper) != 0;
        return hit;
    };
    return comes_before(make_hit(number), found == kWritten ? rays.hits[k] : make_hit(found));
}

/// Offers hits [first, log.count) to their rays; sets hit_rays and returns the groups that took one.
RELIEF_INLINE LaneMask offer_logged(RayBundle& bundle, uint32_t first, LaneMask (&hit_rays)[kGroupCount]) {
    BundleRays& rays = *bundle.rays;
    HitLog& log = *rays.log;
    LaneMask dirty = 0;
    for (uint32_t number = first; number < log.count; ++number) {
        const uint32_t k = log.ray[number];
        const float t = log.t[number] * bundle.shear[2][k];
        if (!(rays.t_min[k] < t && t <= rays.t[k])) continue;
        hit_rays[k / kGroupSize] |= 1u << k % kGroupSize;
        if (t == rays.t[k] && !wins_tie(bundle, k, number)) continue;
        dirty |= 1u << k / kGroupSize;
        rays.t[k] = log.t[number] = t, rays.found[k] = number;
    }
    return dirty;
}

/// The hits of one block, offered to their rays all at once: that makes branches predictable.
template <class Bundle> class BlockHits {
  public:
    RELIEF_INLINE BlockHits(Bundle& bundle, LaneMask (&hit_rays)[kGroupCount])
        : bundle_(bundle), hit_rays_(hit_rays), first_(bundle.rays->log->count) {}

    RELIEF_INLINE void note(const TriangleTest<16>& test, const LaneIndices& rays, const HitPlaces& places) {
        HitLog& log = *bundle_.rays->log;
        if (!log.has_room()) {
            offer();
            write_hits(bundle_);
            first_ = 0;
        }
        log.append(test, rays, places);
    }
    RELIEF_INLINE void offer() {
        if (first_ < bundle_.rays->log->count)
            update_groups(bundle_, offer_logged(bundle_, first_, hit_rays_));
    }

  private:
    Bundle& bundle_;
    LaneMask (&hit_rays_)[kGroupCount];
    uint32_t first_; ///< what is before it in the log has been offered
};

} // namespace relief::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
