// A statement in a paper's text about a plot without numbers.
#pragma once

#include <string_view>

namespace relief::bench {

struct PaperStatement {
    std::string_view about, text; ///< `about`: the related part of the results
};

} // namespace relief::bench
