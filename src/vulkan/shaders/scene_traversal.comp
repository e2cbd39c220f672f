// Front-to-back traversal of the scene trees by one ray: polygons are intersected immediately; of the displaced
// patches, the nearest few beyond the ray's cursor become candidates (Harada 2015, section 1.5.3, in rounds). Rays that
// wait for tiles repeat the round, which is safe: it only changes hits, and those only get nearer.
#include "vulkan/shaders/kernel.glsl"

const bool kMayOfferTwice = false;
#include "vulkan/shaders/scene_candidates.glsl"

#include "vulkan/shaders/node_stack.glsl"

/// Tile directories are traversed on the same stack.
void enter_tiles(const uint root, const float entry) { push_node(root, entry); }

/// False if the device ended the loop before the stack was empty.
bool walk() {
    uint world_size = 0u; // stack entries that belong to the tree of instances
    push_node(push.root, ray_t_min);
    leave_instance();
    for (uint popped = 0u; popped < 0xffffffffu; ++popped) {
        if (stack_size == 0u) return true;
        --stack_size;
        if (instance_index != kNone && stack_size < world_size) leave_instance();
        uvec2 top = stack[stack_size];
        float entry = uintBitsToFloat(top.y);
        if (entry > find_limit()) continue;
        uint node = top.x;
        uint first = texelFetch(nodes, 2 * int(node)).w;
        uint kind_and_count = texelFetch(nodes, 2 * int(node) + 1).w;
        uint kind = kind_and_count >> kNodeKindShift;
        if (kind == kNodeInner)
            enter_inner(first, entry);
        else if (kind == kNodeInstance) {
            if (!is_instance_seen(first)) continue;
            world_size = stack_size;
            enter_instance(first);
            push_node(instances[first].root, entry);
        } else if (kind == kNodePatch)
            enter_patch(first, entry);
        else if (kind == kNodeTile)
            offer_candidate(first, entry);
        else {
            uint count = kind_and_count & ((1u << kNodeKindShift) - 1u);
            for (uint k = 0u; k < count; ++k) intersect_polygon(texelFetch(primitive_ids, int(first + k)).x);
            if (push.is_any != 0u && has_hit) return true;
        }
    }
    return false;
}

void main() { trace_round(); }
