#include "common/command_line.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <exception>
#include <memory>
#include <new>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "common/console.h"
#include "common/option_hints.h"
#include "common/option_names.h"
#include "relief/error.h"
#include "relief/io.h"
#include "relief/version.h"

namespace relief::cli {

namespace {

void report(const std::string& where, const std::string& message, const std::string& hint) {
    print_error("relief: error: {}{}{}\n", where, where.empty() ? "" : ": ", message);
    if (!hint.empty()) print_error("hint: {}\n", hint);
}

/// One empty line between option groups instead of two, and of the details only under --help-all, so that the
/// help fits on a screen.
class HelpFormatter : public CLI::Formatter {
  public:
    std::string make_group(std::string group, bool is_positional,
                           std::vector<const CLI::Option*> options) const override {
        if (!shows_all_ && (group == kResearchGroup || group == kMapDetailGroup)) return {};
        return CLI::Formatter::make_group(std::move(group), is_positional, std::move(options));
    }
    std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override {
        shows_all_ = mode == CLI::AppFormatMode::All;
        std::string text = CLI::Formatter::make_help(app, std::move(name), mode);
        for (size_t at = 0; (at = text.find("\n\n\n", at)) != std::string::npos;) text.erase(at, 1);
        return text;
    }

  private:
    mutable bool shows_all_ = false;
};

/// Options of the command and of those below it that were given.
std::vector<const CLI::Option*> list_options(const CLI::App& app) {
    std::vector<const CLI::Option*> options = app.get_options();
    for (const CLI::App* below : app.get_subcommands()) {
        const std::vector<const CLI::Option*> more = list_options(*below);
        options.insert(options.end(), more.begin(), more.end());
    }
    return options;
}

/// CLI11 counts values; this says it of the option that the user typed. Returns where the error is another.
void refuse_count(const CLI::App& app, const CLI::ParseError& error) {
    if (error.get_name() != "ArgumentMismatch") return;
    const std::string message = error.what();
    for (const CLI::Option* option : list_options(app)) {
        const std::string name = option->get_name();
        if (!message.starts_with(name + ": ")) continue;
        const std::vector<std::string>& values = option->results();
        if (values.size() > 1 && option->get_items_expected_max() == 1) {
            const std::string count = values.size() == 2 ? "twice" : fmt::format("{} times", values.size());
            const bool is_list = option->get_type_name() == "LIST" && !name.ends_with("axes");
            throw Error(ErrorKind::usage,
                        {fmt::format("given {}: '{}'", count, fmt::join(values, "', '")), name,
                         is_list ? fmt::format("one list holds them all: {} {}", name, fmt::join(values, ","))
                                 : fmt::format("keep one of them: {} {}", name, values.back())});
        }
        if (values.empty() && option->get_items_expected_min() == 1)
            throw Error(ErrorKind::usage,
                        {"its value is missing", name, fmt::format("{} {}", name, option->get_type_name())});
    }
}

/// An option that stands where the value of the one before it should.
void refuse_options_as_values(const CLI::App& app) {
    for (const CLI::Option* option : app.get_options()) {
        if (option->get_positional()) continue;
        for (const std::string& value : option->results())
            if (value.starts_with('-') && app.get_option_no_throw(value))
                throw Error(ErrorKind::usage,
                            {fmt::format("its value is missing before {}", value), option->get_name(),
                             fmt::format("{} {}", option->get_name(), option->get_type_name())});
    }
}

} // namespace

int run_program(const std::function<int()>& body) {
    open_console();
    return close_console(run_guarded(body));
}

int run_guarded(const std::function<int()>& body) {
    try {
        return body();
    } catch (const Error& error) {
        report(error.where(), error.message(), name_options(error.hint()));
        for (const Error::Parts& other : error.further())
            report(other.where, other.message, name_options(other.hint));
        return int(error.kind());
    } catch (const std::bad_alloc&) {
        report("", "out of memory",
               "a smaller picture, a lower --level or a smaller --bottom-cache need less");
        return int(ErrorKind::out_of_memory);
    } catch (const std::exception& error) {
        report("", error.what(), "");
        return int(ErrorKind::failed);
    }
}

void prepare_parsing(CLI::App& app) {
    app.formatter(std::make_shared<HelpFormatter>());
    app.get_formatter()->column_width(30);
    app.set_help_all_flag("--help-all", "Print all options, those for research as well");
    app.set_version_flag("--version", "relief " RELIEF_VERSION_STRING);
    app.allow_extras();
}

std::optional<int> parse_words(CLI::App& app, int argument_count, const char* const* arguments) {
    refuse_single_dashes(app, argument_count, arguments);
    try {
        app.parse(argument_count, arguments);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) { // --help and --version
            std::ostringstream text;
            const int exit_code = app.exit(error, text, text);
            write_output(text.str());
            return exit_code;
        }
        refuse_count(app, error);
        throw Error(ErrorKind::usage, {error.what(), "",
                                       "relief --help lists the commands, "
                                       "relief COMMAND --help its options"});
    }
    return std::nullopt;
}

void refuse_option(const std::string& word, const std::string& value, const CLI::App& app,
                   const std::string& help) {
    const std::string hint = suggest_option(word, value, app);
    throw Error(ErrorKind::usage, {fmt::format("unknown option '{}'", word), "", hint.empty() ? help : hint});
}

void refuse_extras(const CLI::App& app, const std::string& command) {
    refuse_options_as_values(app);
    const std::vector<std::string> extras = app.remaining();
    if (extras.empty()) return;
    const std::string help = fmt::format("{} --help lists the options", command);
    for (size_t k = 0; k < extras.size(); ++k) {
        const std::string& extra = extras[k];
        if (extra.size() < 2 || extra[0] != '-') continue;
        const size_t equals = extra.find('=');
        const std::string next = k + 1 < extras.size() ? extras[k + 1] : std::string();
        refuse_option(extra.substr(0, equals), equals == std::string::npos ? next : extra.substr(equals + 1),
                      app, help);
    }
    const std::string& extra = extras.front();
    const bool is_map = is_picture_name(extra) && app.get_option_no_throw("--vdm") != nullptr;
    throw Error(ErrorKind::usage, {fmt::format("unexpected argument '{}'", extra), "",
                                   is_map ? fmt::format("a map goes with its mesh: --vdm {}", extra) : help});
}

void refuse_empty_names(const CLI::App& app) {
    constexpr std::array<std::string_view, 5> kFiles = {"FILE", "DIR", "MAP", "MESH", "PARTS"};
    for (const CLI::Option* option : app.get_options()) {
        const std::string type = option->get_type_name();
        if (std::none_of(kFiles.begin(), kFiles.end(),
                         [&](std::string_view file) { return type.find(file) != std::string::npos; }))
            continue;
        for (const std::string& value : option->results())
            if (value.empty())
                throw Error(ErrorKind::usage,
                            {fmt::format("an empty text names no {}", type == "DIR" ? "folder" : "file"),
                             option->get_name(), "leave it out, or give a name"});
    }
}

} // namespace relief::cli
