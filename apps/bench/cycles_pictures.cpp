// Scenes that Cycles and Relief both support, and comparison of their pictures.
#include <algorithm>
#include <cmath>

#include "bench/cycles.h"
#include "bench/picture_channels.h"
#include "lab/scenes/peer_scenes.h"
#include "relief/error.h"
#include "relief/samples.h"

namespace relief::bench {

namespace {

/// White, rough, without a coat: Lambertian.
Material make_white() {
    Material white;
    white.name = "white", white.roughness = 1, white.ior = 1;
    return white;
}

} // namespace

std::vector<std::string> cycles_scene_names() { return {"rock", "rocks", "rock_close", "pumpkin", "ear"}; }

Scene make_cycles_scene(const std::string& name) {
    const std::vector<std::string> peers = peer_scene_names();
    if (std::find(peers.begin(), peers.end(), name) != peers.end())
        return make_peer_scene(name, 1, PeerWorld::sky);
    Scene scene = make_sample_scene(name, Instancing::none);
    scene.materials = {make_white()};
    for (Object& object : scene.objects) object.material = 0;
    scene.lights.clear();
    scene.camera.aperture_radius = 0;
    scene.picture = {};
    return scene;
}

Value compare_with_cycles(const Image& relief, const Image& cycles) {
    if (relief.width != cycles.width || relief.height != cycles.height)
        throw Error(ErrorKind::failed, {"the pictures differ in size", "bench cycles", ""});
    const size_t alpha = find_channel(relief, "A"), alpha_of_cycles = find_channel(cycles, "A");
    size_t hits = 0, differences = 0;
    double sum = 0, sum_of_cycles = 0;
    for (int y = 0; y < relief.height; ++y)
        for (int x = 0; x < relief.width; ++x) {
            const float a = relief.at(x, y, alpha), b = cycles.at(x, y, alpha_of_cycles);
            hits += a > 0.5f || b > 0.5f;
            differences += std::fabs(a - b) > 0.75f; // more than a silhouette through the pixel explains
            if (a < 1 || b < 1) continue;
            for (const char* channel : {"R", "G", "B"}) {
                sum += relief.at(x, y, find_channel(relief, channel));
                sum_of_cycles += cycles.at(x, y, find_channel(cycles, channel));
            }
        }
    return {{"hit_pixels", hits}, {"masks_differ", differences}, {"brightness_ratio", sum / sum_of_cycles}};
}

} // namespace relief::bench
