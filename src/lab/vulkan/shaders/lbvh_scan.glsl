// Sums over lanes. Included by the kernels that number cuts.
shared uint lane_sums[kBuildGroupSize];

/// Sum over the lanes before this one; the last of lane_sums holds the sum over all afterwards.
uint scan_lanes(const uint lane, const uint value) {
    barrier();
    lane_sums[lane] = value;
    barrier();
    for (uint distance = 1u; distance < kBuildGroupSize; distance *= 2u) {
        uint below = lane >= distance ? lane_sums[lane - distance] : 0u;
        barrier();
        lane_sums[lane] += below;
        barrier();
    }
    return lane_sums[lane] - value;
}
