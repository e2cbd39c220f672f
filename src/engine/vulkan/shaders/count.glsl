// Counting on one word by many invocations: one atomic operation a subgroup.
#ifndef RELIEF_COUNT_GLSL
#define RELIEF_COUNT_GLSL

#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_arithmetic : require

/// Adds one for every invocation that is here.
#define COUNT(counter)                                                        \
    {                                                                         \
        uint here = subgroupBallotBitCount(subgroupBallot(true));             \
        if (subgroupElect()) atomicAdd(counter, here);                        \
    }

/// Sets `place` to the first of `amount` words of one's own.
#define RESERVE(counter, amount, place)                                       \
    {                                                                         \
        uint before = subgroupExclusiveAdd(amount);                           \
        uint whole = subgroupAdd(amount);                                     \
        uint first = 0u;                                                      \
        if (subgroupElect()) first = whole > 0u ? atomicAdd(counter, whole) : 0u; \
        place = subgroupBroadcastFirst(first) + before;                       \
    }

#endif
