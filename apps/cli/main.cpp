#include <CLI/CLI.hpp>

#include "commands.h"
#include "common/command_line.h"
#include "common/verbs.h"
#include "farm/farm_command.h"
#include "relief/io.h"

namespace relief::cli {

namespace {

Verbs make_verbs(CLI::App& app) {
    Verbs verbs(app, "relief");
    verbs.add("render", "Render a scene file, or a mesh alone", add_render);
    verbs.add("inspect", "Tell what a scene, mesh or map is, what it costs, what is wrong with it",
              add_inspect);
    verbs.add("convert", "Maps to other conventions, meshes and displaced surfaces to other files",
              add_convert);
    verbs.add("scene", "Write a sample scene", add_scene);
    verbs.add("compare", "Difference of two pictures; exit 7 where it is above the threshold", add_compare);
    verbs.add("merge", "Join tiles and sample ranges of one picture", add_merge);
    verbs.add("view", "Look at a scene or mesh in a window, change and paint its maps", add_view);
    verbs.add("bench", "Measure, and compare with the figures of a paper", add_bench);
    verbs.add("farm", "Render a shot on many machines, or by many processes", add_farm);
    verbs.add("devices", "List what can render on this machine", add_devices);
    return verbs;
}

} // namespace
} // namespace relief::cli

int main(int argument_count, char** arguments) {
    using namespace relief::cli;
    // The command starts itself to read files that a third-party library parses.
    if (const auto read = relief::run_mesh_reader(argument_count, arguments)) return *read;
    return run_program([&] {
        CLI::App app("Relief: ray tracing of vector-displaced surfaces", "relief");
        prepare_parsing(app);
        const Verbs verbs = make_verbs(app);
        if (const auto answered = parse_words(app, argument_count, arguments)) return *answered;
        return verbs.find()();
    });
}
