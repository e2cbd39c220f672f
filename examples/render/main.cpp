// Renders a displaced square into a picture: render FILE.png|FILE.exr
#include <cstdio>

#include "../displaced_plane.h"
#include "relief/error.h"
#include "relief/io.h"
#include "relief/render.h"

int main(int argument_count, char** arguments) {
    if (argument_count != 2) {
        std::fprintf(stderr, "usage: render FILE\n");
        return 2;
    }
    try {
        relief::RenderSettings settings;
        settings.image.width = 160;
        settings.image.height = 120;
        settings.image.spp = 4;
        const relief::RenderResult result = relief::render(make_displaced_plane(), settings);
        relief::write_image(result.image, arguments[1]);
        const relief::Image written = relief::read_image(arguments[1]);
        std::printf("%s: %d x %d, %zu channels\n", arguments[1], written.width, written.height,
                    written.channels.size());
        return 0;
    } catch (const relief::Error& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
