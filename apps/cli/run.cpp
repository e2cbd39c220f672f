#include <cstdio>
#include <exception>
#include <memory>
#include <new>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "base/suggest.h"
#include "commands.h"
#include "relief/error.h"
#include "relief/version.h"

namespace relief::cli {

namespace {

constexpr int kExitFailed = int(ErrorKind::failed);
constexpr int kExitOutOfMemory = int(ErrorKind::out_of_memory);

struct Verb {
    CLI::App* app;
    Command command;
};

std::vector<Verb> add_verbs(CLI::App& app) {
    std::vector<Verb> verbs;
    const auto add = [&](const char* name, const char* description, Command (*add_options)(CLI::App&)) {
        CLI::App* verb = app.add_subcommand(name, description);
        verb->allow_extras(); // collected, so that the message can name the nearest option
        verbs.push_back({verb, add_options(*verb)});
    };
    add("render", "Render a scene file, or a mesh alone", add_render);
    add("inspect", "Tell what a scene, mesh or map is, what it costs, what is wrong with it", add_inspect);
    add("convert", "Maps to other conventions, meshes and displaced surfaces to other files", add_convert);
    add("scene", "Write a sample scene", add_scene);
    add("compare", "Difference of two pictures; exit 7 where it is above the threshold", add_compare);
    add("merge", "Join tiles and sample ranges of one picture", add_merge);
    add("bench", "Measure, and compare with the figures of a paper", add_bench);
    add("devices", "List what can render on this machine", add_devices);
    return verbs;
}

[[noreturn]] void refuse_word(const std::string& word, const std::string& what,
                              const std::vector<std::string>& known, const std::string& help) {
    const std::vector<std::string_view> views(known.begin(), known.end());
    std::string hint = suggest_word(word, views);
    if (hint.empty()) hint = help;
    throw Error(ErrorKind::usage, {fmt::format("unknown {} '{}'", what, word), "", hint});
}

std::vector<std::string> get_option_names(const CLI::App& verb) {
    std::vector<std::string> names;
    for (const CLI::Option* option : verb.get_options()) {
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
        for (const std::string& name : option->get_snames()) names.push_back("-" + name);
    }
    return names;
}

void refuse_extras(const CLI::App& verb) {
    const std::vector<std::string> extras = verb.remaining();
    if (extras.empty()) return;
    const std::string help = fmt::format("relief {} --help lists the options", verb.get_name());
    for (const std::string& extra : extras) {
        if (extra.size() > 1 && extra[0] == '-')
            refuse_word(extra.substr(0, extra.find('=')), "option", get_option_names(verb), help);
    }
    throw Error(ErrorKind::usage, {fmt::format("unexpected argument '{}'", extras.front()), "", help});
}

int run_verb(CLI::App& app, const std::vector<Verb>& verbs) {
    for (const Verb& verb : verbs) {
        if (!verb.app->parsed()) continue;
        refuse_extras(*verb.app);
        return verb.command();
    }
    std::vector<std::string> names;
    for (const Verb& verb : verbs) names.push_back(verb.app->get_name());
    const std::vector<std::string> extras = app.remaining();
    if (extras.empty())
        throw Error(ErrorKind::usage, {"no command given", "", "relief --help lists the commands"});
    const bool is_option = extras.front()[0] == '-';
    refuse_word(extras.front(), is_option ? "option" : "command", is_option ? get_option_names(app) : names,
                "relief --help lists the commands");
}

void report(const std::string& where, const std::string& message, const std::string& hint) {
    fmt::print(stderr, "relief: error: {}{}{}\n", where, where.empty() ? "" : ": ", message);
    if (!hint.empty()) fmt::print(stderr, "hint: {}\n", hint);
}

/// One empty line between groups of options in place of two: a help shall fit on a screen.
class HelpFormatter : public CLI::Formatter {
  public:
    std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override {
        std::string text = CLI::Formatter::make_help(app, std::move(name), mode);
        for (size_t at = 0; (at = text.find("\n\n\n", at)) != std::string::npos;) text.erase(at, 1);
        return text;
    }
};

int parse_and_run(int argument_count, const char* const* arguments) {
    CLI::App app("Relief: ray tracing of vector-displaced surfaces", "relief");
    app.formatter(std::make_shared<HelpFormatter>());
    app.get_formatter()->column_width(30);
    app.set_version_flag("--version", "relief " RELIEF_VERSION_STRING);
    app.allow_extras();
    const std::vector<Verb> verbs = add_verbs(app);
    try {
        app.parse(argument_count, arguments);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return app.exit(error); // --help and --version
        throw Error(ErrorKind::usage, {error.what(), "",
                                       "relief --help lists the commands, "
                                       "relief COMMAND --help its options"});
    }
    return run_verb(app, verbs);
}

} // namespace

int run(int argument_count, const char* const* arguments) {
    try {
        return parse_and_run(argument_count, arguments);
    } catch (const Error& error) {
        report(error.where(), error.message(), error.hint());
        return int(error.kind());
    } catch (const std::bad_alloc&) {
        report("", "out of memory",
               "a smaller picture, a lower --level or a smaller --bottom-cache need less");
        return kExitOutOfMemory;
    } catch (const std::exception& error) {
        report("", error.what(), "");
        return kExitFailed;
    }
}

} // namespace relief::cli
