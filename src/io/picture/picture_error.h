// What readers of pictures say of a file that they cannot read.
#pragma once

#include <algorithm>
#include <string>
#include <utility>

#include "io/picture/picture_text.h"
#include "relief/error.h"

namespace relief {

/// Throws Error{bad_input} with the reader's own words, which may have several lines.
[[noreturn]] inline void fail_damaged(const std::string& name, std::string message) {
    std::replace(message.begin(), message.end(), '\n', ' ');
    throw Error(ErrorKind::bad_input, {make_printable(message), name,
                                       "the file is damaged or incomplete: export or copy it again"});
}

} // namespace relief
