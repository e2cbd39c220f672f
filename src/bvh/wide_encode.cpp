#include "bvh/wide_encode.h"

#include <algorithm>
#include <cmath>

namespace relief {

namespace {

/// Largest code that decodes to `value` or less; the origin itself is never above it.
uint8_t encode_lower(float value, float origin, float scale) {
    const double code = std::floor((double(value) - origin) / scale);
    int result = int(std::clamp(code, 0.0, 255.0));
    while (result > 0 && WideNode::decode(origin, scale, uint8_t(result)) > value) --result;
    return uint8_t(result);
}

/// Smallest code that decodes to `value` or more; find_exponent has seen to it that 255 does.
uint8_t encode_upper(float value, float origin, float scale) {
    const double code = std::ceil((double(value) - origin) / scale);
    int result = int(std::clamp(code, 0.0, 255.0));
    while (result < 255 && WideNode::decode(origin, scale, uint8_t(result)) < value) ++result;
    return uint8_t(result);
}

/// Smallest exponent whose code 255 reaches `upper` and lies strictly above `origin`, so that an unused slot
/// is empty after rounding too.
int find_exponent(float origin, float upper) {
    const double step = (double(upper) - origin) / 255;
    int exponent = step > 0 ? std::clamp(std::ilogb(step), -126, 127) : -126;
    // 255 steps of 2^-33 times the origin are below half a unit in its last place: no need to try smaller
    // ones.
    if (origin != 0) exponent = std::max(exponent, std::ilogb(origin) - 33);
    const auto reach = [&] { return WideNode::decode(origin, WideNode::decode_scale(exponent), 255); };
    while (exponent < 127 && !(reach() >= upper && reach() > origin)) ++exponent;
    return exponent;
}

} // namespace

void encode_boxes(WideNode& node, const Box& bounds, const std::array<Box, 8>& boxes) {
    for (int axis = 0; axis < 3; ++axis) {
        const float origin = get_component(bounds.lower, axis);
        const int exponent = find_exponent(origin, get_component(bounds.upper, axis));
        const float scale = WideNode::decode_scale(exponent);
        node.origin[axis] = origin;
        node.exponent[axis] = int8_t(exponent);
        for (int k = 0; k < WideNode::kMaxChildCount; ++k) {
            const bool is_used = k < node.child_count;
            const uint8_t upper =
                is_used ? encode_upper(get_component(boxes[k].upper, axis), origin, scale) : 0;
            node.planes[axis][k] =
                is_used ? encode_lower(get_component(boxes[k].lower, axis), origin, scale) : 255;
            node.planes[3 + axis][k] = upper;
        }
    }
}

WideNode encode_node(const WideNodeParts& parts) {
    WideNode node{};
    node.child_count = uint8_t(parts.count);
    std::copy(parts.child.begin(), parts.child.end(), node.child);
    encode_boxes(node, parts.bounds, parts.boxes);
    return node;
}

} // namespace relief
