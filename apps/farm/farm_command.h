// The verb `relief farm` and the verbs under it.
#pragma once

#include "common/command_line.h"

namespace relief::cli {

Command add_farm(CLI::App& verb);

} // namespace relief::cli
