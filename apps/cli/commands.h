// The verbs of the command line: each adds its options to a subcommand and returns what runs it.
#pragma once

#include "common/command_line.h"

namespace relief::cli {

Command add_render(CLI::App& verb);
Command add_inspect(CLI::App& verb);
Command add_convert(CLI::App& verb);
Command add_scene(CLI::App& verb);
Command add_compare(CLI::App& verb);
Command add_merge(CLI::App& verb);
Command add_devices(CLI::App& verb);
/// All arguments after `bench` go to the program relief-bench, which replaces this process.
Command add_bench(CLI::App& verb);
/// Likewise relief-view.
Command add_view(CLI::App& verb);

} // namespace relief::cli
