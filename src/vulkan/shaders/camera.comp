// Starts one path per pixel with a camera ray through a random point of the pixel.
#include "vulkan/shaders/kernel.glsl"
#include "vulkan/shaders/paths.glsl"

layout(scalar, push_constant) uniform Push { CameraPush push; };

void main() {
    uint index = invocation_index();
    if (index >= push.count) return;
    // Before shadow rays are listed their list holds the pixels: no device needs to offer one more binding.
    uint x = shadow_list[index] & 0xffffu;
    uint y = shadow_list[index] >> 16;
    PathData path;
    path.throughput = vec3(1.0);
    path.bsdf_pdf = 0.0;
    path.previous = vec3(0.0);
    path.pixel_seed = make_pixel_seed(push.seed, x, y);
    path.radiance = vec3(0.0);
    path.cost = 1.0;
    path.contribution = vec3(0.0);
    path.normal = vec3(0.0);
    path.instance = kNone;
    path.body = kNone;
    CameraRay start = start_camera_ray(push.camera, vec2(x, y), path.pixel_seed, push.sample_index);
    RayData ray = {start.origin, 0.0, start.direction, make_infinity(), 0u};
    paths[index] = path;
    rays[index] = ray;
    path_list[index] = index;
}
