#include "common/verbs.h"

#include <string_view>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "common/option_hints.h"
#include "relief/error.h"

namespace relief::cli {

void Verbs::add(const char* name, const char* description, Command (*add_options)(CLI::App&)) {
    CLI::App* verb = app_->add_subcommand(name, description);
    verb->allow_extras(); // collected, so that the error can suggest the nearest option
    verbs_.push_back({verb, add_options(*verb)});
}

const Command& Verbs::find() const {
    for (const Verb& verb : verbs_) {
        if (!verb.app->parsed()) continue;
        const bool checks_itself = verb.app->get_prefix_command() || !verb.app->get_subcommands({}).empty();
        if (!checks_itself) refuse_extras(*verb.app, name_ + " " + verb.app->get_name());
        refuse_empty_names(*verb.app);
        return verb.command;
    }
    refuse();
}

void Verbs::refuse() const {
    const std::vector<std::string> extras = app_->remaining();
    const std::string help = name_ + " --help lists the commands", place = app_->get_parent() ? name_ : "";
    if (extras.empty()) throw Error(ErrorKind::usage, {"no command given", place, help});
    if (extras.front()[0] == '-') refuse_option(extras.front(), "", *app_, help);
    std::vector<std::string_view> names;
    for (const Verb& verb : verbs_) names.push_back(verb.app->get_name());
    const std::string hint = suggest_command(extras.front(), names);
    throw Error(ErrorKind::usage,
                {fmt::format("unknown command '{}'", extras.front()), place, hint.empty() ? help : hint});
}

} // namespace relief::cli
