// Verbs of a command: `relief VERB`, and `relief farm VERB` under one of them.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "common/command_line.h"

namespace relief::cli {

/// The words of one command that verbs follow.
class Verbs {
  public:
    /// `name`: as the user types it, "relief farm".
    Verbs(CLI::App& app, std::string name) : app_(&app), name_(std::move(name)) {}

    void add(const char* name, const char* description, Command (*add_options)(CLI::App&));

    /// Of the verb on the command line. Throws Error{usage} where there is none, or where a word behind it
    /// means nothing.
    const Command& find() const;

  private:
    struct Verb {
        CLI::App* app;
        Command command;
    };

    [[noreturn]] void refuse() const;

    CLI::App* app_;
    std::string name_;
    std::vector<Verb> verbs_;
};

} // namespace relief::cli
