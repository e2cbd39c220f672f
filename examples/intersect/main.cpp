// Traces a row of rays downwards through a displaced square and prints what they hit.
#include <cstdio>
#include <vector>

#include "../displaced_plane.h"
#include "relief/error.h"
#include "relief/intersect.h"
#include "relief/version.h"

int main() {
    try {
        relief::IntersectorSettings settings;
        settings.surface.level = 6;
        const relief::Intersector intersector(make_displaced_plane(), settings);
        std::vector<relief::Ray> rays;
        for (const float x : {-1.5f, -0.5f, 0.0f, 0.5f, 1.5f})
            rays.push_back({.origin = {x, 0.01f, 5}, .direction = {0, 0, -1}});
        std::vector<relief::RayHit> hits(rays.size());
        intersector.closest_hits(rays, hits);
        std::printf("relief %s\n", RELIEF_VERSION_STRING);
        for (size_t i = 0; i < rays.size(); ++i) {
            if (hits[i].object == relief::kNoIndex)
                std::printf("x %4.1f  no hit\n", rays[i].origin.x);
            else
                std::printf("x %4.1f  height %.3f  uv %.3f %.3f  normal %.2f %.2f %.2f\n", rays[i].origin.x,
                            5 - hits[i].t, hits[i].uv.x, hits[i].uv.y, hits[i].normal.x, hits[i].normal.y,
                            hits[i].normal.z);
        }
        return 0;
    } catch (const relief::Error& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
