// A rectangle over the first rows of squares of the screen, for fragments that stand for the invocations of a
// kernel (GRAPP 2019, section 3.3, fragment shaders). How many rows is told by the number of the first
// vertex, which an indirect draw can set too.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/lang.h"
#include "shared/bindings.h"

void main() {
    uint rows = uint(gl_VertexIndex) / kScreenVertexCount;
    uint corner = uint(gl_VertexIndex) % kScreenVertexCount;
    bool is_right = corner == 1u || corner == 2u || corner == 4u;
    bool is_lower = corner == 2u || corner == 4u || corner == 5u;
    float y = is_lower ? float(rows) / float(kScreenRows) : 0.0;
    gl_Position = vec4(is_right ? 1.0 : -1.0, 2.0 * y - 1.0, 0.0, 1.0);
}
