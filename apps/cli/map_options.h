// Options that say what a displacement map means, for every verb that reads one.
#pragma once

#include <string>
#include <vector>

#include "common/cli_app.h"
#include "relief/io.h"

namespace relief::cli {

/// Where the options stand in the help, and who is told which of them were given.
struct MapOptionPlace {
    std::string group;
    std::string preset = "--preset";           ///< names of the option for the preset
    std::string prefix;                        ///< of the other names: "to-" makes --to-axes
    std::vector<std::string>* given = nullptr; ///< may be null
};

/// Adds the option for the preset, --type, --space, --axes, --encoding, --midlevel, --vdm-scale, --wrap and
/// --flip-v; with a prefix --PREFIXscale for the scale, and no wrap. `options` and `place.given` must outlive
/// the parsing.
void add_map_options(CLI::App& verb, MapOptions& options, const MapOptionPlace& place);

/// "F" or "F,F,F". Throws Error{usage}.
Vec3f parse_factors(const std::string& option, const std::string& text);

} // namespace relief::cli
