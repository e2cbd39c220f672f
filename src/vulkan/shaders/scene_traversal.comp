// Front-to-back traversal of the scene trees by one ray: polygons are intersected immediately; of the displaced
// patches, the nearest few beyond the ray's cursor become candidates (Harada 2015, section 1.5.3, in rounds). Rays that
// wait for tiles repeat the round, which is safe: it only changes hits, and those only get nearer.
#include "vulkan/shaders/kernel.glsl"

const bool kMayOfferTwice = false;
#include "vulkan/shaders/scene_candidates.glsl"

#include "vulkan/shaders/tile_walk.glsl"
#include "vulkan/shaders/wide_nodes.glsl"

/// `word` of a child that is a leaf, of the tree of a surface.
void enter_leaf(const uint word, const float entry) {
    uint first = word & kLeafFirstMask;
    if (surfaces[instances[instance_index].surface].map != kNone) {
        enter_patch(first, entry);
        return;
    }
    uint count = ((word >> kLeafCountShift) & 7u) + 1u;
    for (uint k = 0u; k < count; ++k) intersect_polygon(texelFetch(primitive_ids, int(first + k)).x);
}

/// False if the device ended the loop before the stack was empty.
bool walk() {
    uint world_size = 0u; // stack entries that belong to the tree of instances
    leave_instance();
    enter_node(push.root, ray_t_min);
    for (uint taken = 0u; taken < 0xffffffffu; ++taken) {
        if (stack_size == 0u) return true;
        if (instance_index != kNone && stack_size <= world_size) leave_instance();
        NextChild next = take_child();
        if (next.word == kNone) continue;
        if ((next.word & kLeafFlag) == 0u)
            enter_node(next.word, next.entry);
        else if (instance_index == kNone) {
            uint index = next.word & kLeafFirstMask;
            if (!is_instance_seen(index)) continue;
            world_size = stack_size;
            enter_instance(index);
            enter_node(instances[index].root, next.entry);
        } else {
            enter_leaf(next.word, next.entry);
            if (push.is_any != 0u && has_hit) return true;
        }
    }
    return false;
}

void main() { trace_round(); }
