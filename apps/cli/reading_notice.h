// Tells that a file is still being read: large pictures and meshes take longer than a moment.
#pragma once

#include <chrono>
#include <string>

#include "common/progress.h"
#include "wait_notice.h"

namespace relief::cli {

/// Calls `read`, and prints the name of the file after `first` until that is done.
template <class Read>
auto read_with_notice(const ProgressOptions& options, const std::string& file, const Read& read,
                      std::chrono::milliseconds first = std::chrono::milliseconds(700)) {
    ProgressPrinter printer(options);
    const WaitNotice notice(printer, "reading " + file, first);
    return read();
}

} // namespace relief::cli
