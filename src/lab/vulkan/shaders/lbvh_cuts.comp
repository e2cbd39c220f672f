// Which entries begin the right child of some node, how many of them each tile has, and the order of primitives.
#include "vulkan/shaders/kernel.glsl"
#include "lab/vulkan/shaders/lbvh.glsl"

layout(set = 0, binding = kBindBuildNumbers) writeonly buffer Numbers { uint numbers[]; };
layout(set = 0, binding = kBindBuildSums) writeonly buffer Sums { uint sums[]; };
layout(set = 0, binding = kBindBuildIds) writeonly buffer Ids { uint ids[]; };

shared uint tile_count;

bool is_code(const uint entry, const HeapKey code) { return is_equal(load_code(entry), code); }

/// How many of the entries before `entry`, at most `most`, have the code.
uint count_before(const uint entry, const HeapKey code, uint most) {
    uint least = 0u;
    most = min(most, entry);
    while (least < most) {
        uint middle = most - (most - least) / 2u;
        if (is_code(entry - middle, code))
            least = middle;
        else
            most = middle - 1u;
    }
    return least;
}

/// The same of those from `entry` on, which has it.
uint count_from(const uint entry, const HeapKey code, uint most) {
    uint least = 1u;
    most = min(most, push.primitive_count - entry);
    while (least < most) {
        uint middle = most - (most - least) / 2u;
        if (is_code(entry + middle - 1u, code))
            least = middle;
        else
            most = middle - 1u;
    }
    return least;
}

/// `entry` > 0. The node that cuts here has the entries of this code whose numbers agree above its lowest bit.
bool is_cut(const uint entry) {
    HeapKey code = load_code(entry);
    if (!is_code(entry - 1u, code)) return true;
    uint most = min(get_lowest_bit(entry), push.max_leaf_size);
    return count_before(entry, code, most) + count_from(entry, code, most) > push.max_leaf_size;
}

void main() {
    uint lane = gl_LocalInvocationID.x;
    uint tile = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    if (lane == 0u) tile_count = 0u;
    barrier();
    uint own = 0u;
    for (uint k = 0u; k < kBuildItemCount; ++k) {
        uint entry = tile * kBuildTileSize + k * kBuildGroupSize + lane;
        if (entry >= push.primitive_count) break;
        uint flag = entry > 0u && is_cut(entry) ? 1u : 0u;
        numbers[entry] = flag;
        ids[entry] = pairs[entry].y;
        own += flag;
    }
    if (own > 0u) atomicAdd(tile_count, own);
    barrier();
    if (lane == 0u && tile * kBuildTileSize < push.primitive_count) sums[tile] = tile_count;
}
