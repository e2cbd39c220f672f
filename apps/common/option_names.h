// The library's messages name settings ("image.crop"); users of the command know them as options ("--crop").
#pragma once

#include <string>

namespace relief::cli {

/// `text` with every "SETTING = VALUE" as "--option VALUE" and every other name of a setting as its option;
/// calls that list devices become the command that does.
std::string name_options(std::string text);

} // namespace relief::cli
