// Options for the convention of a displacement map, shared by all verbs that read one.
#pragma once

#include <string>
#include <vector>

#include "common/cli_app.h"
#include "relief/io.h"

namespace relief::cli {

/// Help group and prefix of the options, and the list that records given ones.
struct MapOptionPlace {
    std::string group;
    std::string preset = "--preset";           ///< name of the preset option
    std::string prefix;                        ///< prefix of the other names: "to-" gives --to-axes
    std::vector<std::string>* given = nullptr; ///< may be null
};

/// Adds the preset option, --type, --space, --axes, --encoding, --midlevel, --vdm-scale, --wrap and --flip-v;
/// with a prefix the scale is --PREFIXscale and there is no --wrap. `options` and `place.given` must outlive
/// parsing.
void add_map_options(CLI::App& verb, MapOptions& options, const MapOptionPlace& place);

/// Throws Error{usage} for words and axes that mean nothing.
void check_map_words(const MapOptions& options);

/// "F" or "F,F,F". Throws Error{usage}.
Vec3f parse_factors(const std::string& option, const std::string& text);

} // namespace relief::cli
