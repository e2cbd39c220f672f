// A statement of a paper's text about what its plots show without numbers.
#pragma once

#include <string_view>

namespace relief::bench {

struct PaperStatement {
    std::string_view about, text; ///< part of the results it belongs to
};

} // namespace relief::bench
