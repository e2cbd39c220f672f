// The table of formulas/ggx_table.h in a buffer, always bound: as a constant array it takes minutes to compile.
#ifndef RELIEF_GGX_TABLE_GLSL
#define RELIEF_GGX_TABLE_GLSL

#include "formulas/ggx_table.h"
#include "vulkan/layout/bindings.h"

layout(binding = kBindAlbedos) uniform samplerBuffer ggx_albedo_table;

/// Scale and bias of an entry.
Vec2 read_ggx_table(uint i) { return texelFetch(ggx_albedo_table, int(i)).xy; }

#endif
