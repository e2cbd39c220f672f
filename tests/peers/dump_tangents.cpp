// Prints the MikkTSpace tangent of each corner of an OBJ file: x y z sign, a line a corner, in the order of
// the file.
#include <array>
#include <cstdio>
#include <exception>

#include "relief/io.h"
#include "surface/mesh/mikk_tangents.h"

int main(int argument_count, char** arguments) {
    if (argument_count != 2) return std::fputs("usage: dump_tangents FILE.obj\n", stderr), 2;
    try {
        relief::Polygons polygons =
            relief::make_polygons(relief::load_mesh(arguments[1]), relief::Welding::joined_points);
        relief::add_mikk_tangents(polygons, {}, relief::FrameLengths::absolute);
        for (const std::array<float, 4>& t : polygons.tangents)
            std::printf("%.9g %.9g %.9g %g\n", t[0], t[1], t[2], t[3]);
    } catch (const std::exception& error) {
        return std::fprintf(stderr, "%s\n", error.what()), 1;
    }
}
