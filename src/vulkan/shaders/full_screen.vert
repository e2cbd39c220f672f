// The framebuffer in squares, for fragments that act as the invocations of a kernel (GRAPP 2019, section 3.3, fragment
// shaders): a point as large as a square replaces a work group. Not two triangles: helper invocations would run along
// their shared edge, and lavapipe's loops wait for those.
#include "formulas/lang.h"
#include "vulkan/layout/bindings.h"

void main() {
    uvec2 square = uvec2(uint(gl_VertexIndex) % kScreenColumns, uint(gl_VertexIndex) / kScreenColumns);
    gl_Position = vec4((vec2(square) + 0.5) / vec2(kScreenColumns, kScreenRows) * 2.0 - 1.0, 0.0, 1.0);
    gl_PointSize = float(kFragmentSquare);
}
