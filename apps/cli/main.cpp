#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "commands.h"
#include "common/command_line.h"
#include "common/option_hints.h"
#include "farm/farm_command.h"
#include "relief/error.h"
#include "relief/io.h"

namespace relief::cli {

namespace {

struct Verb {
    CLI::App* app;
    Command command;
};

std::vector<Verb> add_verbs(CLI::App& app) {
    std::vector<Verb> verbs;
    const auto add = [&](const char* name, const char* description, Command (*add_options)(CLI::App&)) {
        CLI::App* verb = app.add_subcommand(name, description);
        verb->allow_extras(); // collected, so that the error can suggest the nearest option
        verbs.push_back({verb, add_options(*verb)});
    };
    add("render", "Render a scene file, or a mesh alone", add_render);
    add("inspect", "Tell what a scene, mesh or map is, what it costs, what is wrong with it", add_inspect);
    add("convert", "Maps to other conventions, meshes and displaced surfaces to other files", add_convert);
    add("scene", "Write a sample scene", add_scene);
    add("compare", "Difference of two pictures; exit 7 where it is above the threshold", add_compare);
    add("merge", "Join tiles and sample ranges of one picture", add_merge);
#ifdef RELIEF_VIEWER
    add("view", "Look at a scene or mesh in a window, change and paint its maps", add_view);
#endif
    add("bench", "Measure, and compare with the figures of a paper", add_bench);
    add("farm", "Render a shot on many machines, or by many processes", add_farm);
    add("devices", "List what can render on this machine", add_devices);
    return verbs;
}

/// What the words on the command line name. Throws Error{usage} where they name nothing.
const Command& find_command(CLI::App& app, const std::vector<Verb>& verbs) {
    for (const Verb& verb : verbs) {
        if (!verb.app->parsed()) continue;
        const bool checks_itself = verb.app->get_prefix_command() || !verb.app->get_subcommands({}).empty();
        if (!checks_itself) refuse_extras(*verb.app, "relief " + verb.app->get_name());
        refuse_empty_names(*verb.app);
        return verb.command;
    }
    const std::vector<std::string> extras = app.remaining();
    const std::string help = "relief --help lists the commands";
    if (extras.empty()) throw Error(ErrorKind::usage, {"no command given", "", help});
    if (extras.front()[0] == '-') refuse_option(extras.front(), "", app, help);
    std::vector<std::string_view> names;
    for (const Verb& verb : verbs) names.push_back(verb.app->get_name());
    const std::string hint = suggest_command(extras.front(), names);
    throw Error(ErrorKind::usage,
                {fmt::format("unknown command '{}'", extras.front()), "", hint.empty() ? help : hint});
}

} // namespace
} // namespace relief::cli

int main(int argument_count, char** arguments) {
    using namespace relief::cli;
    // The command starts itself to read files that a third-party library parses.
    if (const auto read = relief::run_mesh_reader(argument_count, arguments)) return *read;
    return run_guarded([&] {
        CLI::App app("Relief: ray tracing of vector-displaced surfaces", "relief");
        prepare_parsing(app);
        const std::vector<Verb> verbs = add_verbs(app);
        if (const auto answered = parse_words(app, argument_count, arguments)) return *answered;
        return find_command(app, verbs)();
    });
}
