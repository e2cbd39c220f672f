// Sizes of subsequent launches, as work groups and as full-screen draws, from counters on the device.
#include "vulkan/shaders/kernel.glsl"
#include "formulas/lang.h"
#include "vulkan/layout/bindings.h"
#include "vulkan/layout/device_rays.h"

layout(scalar, set = 0, binding = kBindCounters) buffer Counters { CounterData counters; };
layout(scalar, set = 0, binding = kBindArguments) buffer Arguments { uint arguments[]; };
layout(scalar, push_constant) uniform Push { ArgumentsPush push; };

const uint kMostGroups = 65535u;

void write_groups(const uint place, const uint items, const uint items_per_group) {
    uint groups = (items + items_per_group - 1u) / items_per_group;
    uint rows = (groups + kMostGroups - 1u) / kMostGroups;
    uint word = kArgumentWords * place;
    arguments[word] = rows > 1u ? kMostGroups : groups;
    arguments[word + 1u] = rows;
    arguments[word + 2u] = groups > 0u ? 1u : 0u;
    uint draw = word + kArgumentDrawWord; // vertex count, instance count, and the first of each
    arguments[draw] = groups;
    arguments[draw + 1u] = 1u;
    arguments[draw + 2u] = arguments[draw + 3u] = 0u;
}

void main() {
    if (gl_GlobalInvocationID.x > 0u) return;
    write_groups(kArgumentsPairs, counters.pair_count, push.group_size);
    write_groups(kArgumentsJobs, counters.job_count, push.group_size);
    for (uint bin = 0u; bin < kBuildBinCount; ++bin)
        write_groups(kArgumentsBuilds + bin, counters.build_count[bin], push.builds_per_group[bin]);
}
