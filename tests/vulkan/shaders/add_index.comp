// values[i] = values[i] * factor + i, group by group over two dimensions.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/bindings.h"
layout(local_size_x_id = 0) in;
layout(binding = kBindFilm) buffer Values { uint values[]; };
layout(push_constant) uniform Push { uint count, factor; };

void main() {
    uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    uint i = group * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
    if (i >= count) return;
    values[i] = values[i] * factor + i;
}
