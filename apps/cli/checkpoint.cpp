#include "checkpoint.h"

#include <exception>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "common/console.h"
#include "common/values.h"
#include "relief/io.h"

namespace relief::cli {

namespace {

std::filesystem::path name_film(std::filesystem::path picture) { return picture += ".film"; }

} // namespace

void add_checkpoint_options(CLI::App& verb, CheckpointOptions& options) {
    verb.add_option_function<std::string>(
            "--checkpoint",
            [&options](const std::string& text) {
                options.minutes = parse_number("--checkpoint", text, 1e-3, 1e5);
            },
            "keep what --resume needs in FILE.film: every MIN minutes, and at the end")
        ->type_name("MIN");
    verb.add_option_function<std::string>(
            "--resume", [&options](const std::string& text) { options.resumed = text; },
            "add samples, up to --spp, to a picture rendered with --checkpoint; default of -o: FILE")
        ->type_name("FILE");
}

std::vector<std::string> list_films(const CheckpointOptions& options, const std::filesystem::path& output) {
    std::vector<std::string> films;
    if (options.is_on()) films.push_back(name_film(output).string());
    if (!options.resumed.empty()) films.push_back(name_film(options.resumed).string());
    return films;
}

void check_checkpoint(const CheckpointOptions& options, const std::filesystem::path& output) {
    if (!options.is_on()) return;
    check_text_writable(name_film(output));
    if (options.resumed.empty() && std::filesystem::exists(name_film(output)))
        print_error("relief: warning: {} is replaced; --resume {} goes on from it\n",
                    name_film(output).string(), output.string());
    const std::filesystem::path film = name_film(options.resumed);
    const bool is_resumed = !options.resumed.empty();
    if (is_resumed && !std::filesystem::exists(options.resumed) && !std::filesystem::exists(film))
        read_image(options.resumed); // throws, with the names that may have been meant
    if (is_resumed && !std::filesystem::is_regular_file(film))
        throw Error(ErrorKind::bad_input,
                    {"the sums of its samples are not beside it: " + film.string(), options.resumed.string(),
                     "--checkpoint keeps them; without: --samples A:B for what is missing, then "
                     "relief merge"});
}

FilmKeeper::FilmKeeper(const CheckpointOptions& options, const std::filesystem::path& output)
    : options_(options), file_(name_film(output)) {
    if (!options.resumed.empty()) resumed_.open(name_film(options.resumed), std::ios::binary);
}

Checkpoints FilmKeeper::checkpoints() {
    Checkpoints checkpoints;
    if (!options_.is_on()) return checkpoints;
    if (options_.minutes > 0) checkpoints.interval_s = 60 * options_.minutes;
    if (resumed_.is_open())
        checkpoints.resume = &resumed_, checkpoints.resume_name = name_film(options_.resumed).string();
    checkpoints.save = [this](const std::function<void(std::ostream&)>& write) {
        try {
            write_file(file_, write);
            has_failed_ = false;
        } catch (const std::exception& error) {
            has_failed_ = true;
            print_error("relief: warning: the samples so far could not be kept: {}\n", error.what());
        }
    };
    return checkpoints;
}

} // namespace relief::cli
