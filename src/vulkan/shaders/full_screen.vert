// The framebuffer in squares, for fragments as invocations of a kernel (GRAPP 2019, section 3.3): a point the size of a
// square is a work group. Not triangles: helper invocations along their edge block lavapipe's loops.
#include "formulas/lang.h"
#include "vulkan/layout/bindings.h"

void main() {
    uvec2 square = uvec2(uint(gl_VertexIndex) % kScreenColumns, uint(gl_VertexIndex) / kScreenColumns);
    gl_Position = vec4((vec2(square) + 0.5) / vec2(kScreenColumns, kScreenRows) * 2.0 - 1.0, 0.0, 1.0);
    gl_PointSize = float(kFragmentSquare);
}
