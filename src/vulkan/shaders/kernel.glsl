// Prologue of kernels: group size as constant 0, and the invocation index. FULL_SCREEN: see full_screen.vert.
#include "vulkan/shaders/extensions.glsl"
#include "formulas/lang.h"
#include "vulkan/layout/bindings.h"

#ifdef FULL_SCREEN
/// Index of this fragment: squares row by row, then the fragments of a square, like the invocations of a work group.
uint invocation_index() {
    uvec2 pixel = uvec2(gl_FragCoord.xy);
    uvec2 square = pixel / kFragmentSquare;
    uvec2 within = pixel % kFragmentSquare;
    uint group = square.y * kScreenColumns + square.x;
    return (group * kFragmentSquare + within.y) * kFragmentSquare + within.x;
}
#else
layout(local_size_x_id = 0) in;

/// Index of this invocation in a launch of one or two dimensions.
uint invocation_index() {
    uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    return group * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
}
#endif
