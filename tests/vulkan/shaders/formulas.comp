// Runs every shared formula on the device.
#extension GL_EXT_scalar_block_layout : require
#include "all_formulas.glsl"
/// Another table that is always bound.
LayerTable make_test_layers() { return make_layer_table(0u); }
#include "formula_cases-inl.h"
layout(local_size_x_id = 0) in;
layout(constant_id = 1) const uint kPart = 0u;
layout(scalar, binding = kBindRays) readonly buffer Inputs { FormulaInput inputs[]; };
layout(scalar, binding = kBindHits) buffer Outputs { FormulaOutput outputs[]; };
layout(push_constant) uniform Push { uint count; };

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    FormulaInput from = inputs[i];
    if (kPart == 0u) outputs[i].exact = run_exact(from);
    if (kPart == 1u) outputs[i].warp = run_warp(from);
    if (kPart == 2u) outputs[i].camera = run_camera(from);
    if (kPart == 3u) outputs[i].shading = run_shading(from);
    if (kPart == 4u) outputs[i].light = run_light(from);
    if (kPart == 5u) outputs[i].tone = run_tone(from);
    if (kPart == 6u) outputs[i].source = run_source(from);
    if (kPart == 7u) outputs[i].surface = run_surface(from);
    if (kPart == 8u) outputs[i].layers = run_layers(from);
    if (kPart == 9u) outputs[i].glass = run_glass(from);
    if (kPart == 10u) outputs[i].facets = run_facets(from);
}
