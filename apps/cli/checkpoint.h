// --checkpoint and --resume: the sums of all samples are kept beside the picture, in FILE.film.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "common/cli_app.h"
#include "relief/render.h"

namespace relief::cli {

struct CheckpointOptions {
    double minutes = 0;            ///< 0: none
    std::filesystem::path resumed; ///< a picture; empty: none
    bool is_on() const { return minutes > 0 || !resumed.empty(); }
};

/// Adds the options; `options` must outlive parsing.
void add_checkpoint_options(CLI::App& verb, CheckpointOptions& options);

/// The files of sums that a render reads and writes; empty without the options.
std::vector<std::string> list_films(const CheckpointOptions& options, const std::filesystem::path& output);

/// Throws Error where the sums of the resumed picture are missing, or those of `output` cannot be written.
/// Warns where others are replaced.
void check_checkpoint(const CheckpointOptions& options, const std::filesystem::path& output);

/// Reads and writes the sums of one render. A write that fails is told on stderr: the render goes on.
class FilmKeeper {
  public:
    FilmKeeper(const CheckpointOptions& options, const std::filesystem::path& output);
    /// Refers to this object.
    Checkpoints checkpoints();
    /// Whether the last write failed.
    bool has_failed() const { return has_failed_; }

  private:
    CheckpointOptions options_;
    std::filesystem::path file_;
    std::ifstream resumed_;
    bool has_failed_ = false;
};

} // namespace relief::cli
