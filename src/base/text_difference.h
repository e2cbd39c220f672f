// What two lists written as text, "size 4, seed 1", have otherwise.
#pragma once

#include <string>

namespace relief {

/// The parts of `mine` that `theirs` has otherwise, as "part (there: part)"; parts are separated by ", ".
std::string describe_difference(std::string mine, std::string theirs);

} // namespace relief
