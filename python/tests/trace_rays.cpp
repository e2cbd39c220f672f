// trace_rays SCENE RAYS HITS REPEATS: the rays of a file through a scene, in C++. Prints the least time of a
// call, seconds.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include "relief/intersect.h"
#include "relief/io.h"

int main(int argument_count, char** arguments) {
    if (argument_count != 5) return 2;
    std::vector<relief::Ray> rays(std::filesystem::file_size(arguments[2]) / sizeof(relief::Ray));
    std::ifstream(arguments[2], std::ios::binary)
        .read(reinterpret_cast<char*>(rays.data()), std::streamsize(rays.size() * sizeof(relief::Ray)));
    const relief::Intersector intersector(relief::load_scene(arguments[1]), {});
    std::vector<relief::RayHit> hits;
    double least = std::numeric_limits<double>::infinity();
    for (int repeat = 0; repeat <= std::stoi(arguments[4]); ++repeat) { // the first warms up
        const auto start = std::chrono::steady_clock::now();
        hits = std::vector<relief::RayHit>(rays.size());
        intersector.closest_hits(rays, hits);
        const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
        if (repeat > 0) least = std::min(least, time.count());
    }
    std::ofstream(arguments[3], std::ios::binary)
        .write(reinterpret_cast<const char*>(hits.data()),
               std::streamsize(hits.size() * sizeof(relief::RayHit)));
    std::printf("%.9f\n", least);
}
