// Translates settings in library messages ("image.crop") to command options ("--crop").
#pragma once

#include <string>

namespace relief::cli {

/// `text` with every "SETTING = VALUE" replaced by "--option VALUE", other setting names by their option, and
/// calls that list devices by the corresponding command.
std::string name_options(std::string text);

} // namespace relief::cli
