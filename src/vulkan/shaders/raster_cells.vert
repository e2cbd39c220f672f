// A cell as the conservative rectangle of all pixels whose rays can hit it.
#define READS_RASTER_VERTICES
#include "vulkan/shaders/extensions.glsl"
#include "vulkan/shaders/raster.glsl"
#include "formulas/raster.h"

layout(location = 0) flat out uvec2 item_and_cell;

vec3 bound_vector(const AffineData a, const vec3 v) {
    return vec3(dot(abs(a.x), abs(v)), dot(abs(a.y), abs(v)), dot(abs(a.z), abs(v)));
}

/// Camera in object space. Its scale does not affect the projection, only the range of floats.
ObjectCamera enter_camera(const InstanceData instance) {
    AffineData m = instance.object_from_origin;
    vec3 reach = abs(push.corner) + float(push.x0 + push.width) * abs(push.step_x) +
                 float(push.y0 + push.height) * abs(push.step_y);
    vec3 bound = bound_vector(m, reach);
    float scale = 1.0 / max(bound.x, max(bound.y, bound.z));
    CameraVectors vectors =
        CameraVectors(transform_vector(m, push.corner) * scale, transform_vector(m, push.step_x) * scale,
                      transform_vector(m, push.step_y) * scale);
    CameraVectors bounds = CameraVectors(bound_vector(m, push.corner) * scale, bound_vector(m, push.step_x) * scale,
                                         bound_vector(m, push.step_y) * scale);
    return make_object_camera(transform_point(m, subtract_exact(push.origin, instance.origin)), vectors, bounds, bound * scale);
}

/// In pixels of the drawn region, with a margin: the ray of a pixel may pass through any point of it, but fragments are
/// generated only where the centre is covered.
vec4 place_on_window(const ScreenBox box) {
    vec2 origin = vec2(float(push.x0), float(push.y0 + push.first_row));
    vec2 size = vec2(float(push.width), float(push.row_count));
    vec2 lower = clamp(vec2(box.x0, box.y0) - origin - 1.0, vec2(0.0), size);
    vec2 upper = clamp(vec2(box.x1, box.y1) - origin + 1.0, vec2(0.0), size);
    return vec4(lower, upper) / vec4(size, size) * 2.0 - 1.0;
}

void main() {
    uint number = uint(gl_VertexIndex) / kRasterVertices;
    item_and_cell = uvec2(find_item(number), number);
    RasterCell cell = make_cell(item_and_cell.x, item_and_cell.y);
    CellCorners corners = load_cell(cell);
    ScreenBox box = bound_on_screen(enter_camera(instances[cell.item.instance]), corners.p00, corners.p10, corners.p11,
                                    corners.p01);
    gl_Position = vec4(-1.0, -1.0, 0.0, 1.0);
    if (box.x0 > box.x1) return;
    vec4 window = place_on_window(box);
    uint corner = uint(gl_VertexIndex) % kRasterVertices;
    bool is_right = corner == 1u || corner == 2u || corner == 4u;
    bool is_lower = corner == 2u || corner == 4u || corner == 5u;
    gl_Position.xy = vec2(is_right ? window.z : window.x, is_lower ? window.w : window.y);
}
