// A file of results before it is written.
#pragma once

#include <string>

namespace relief::bench {

struct ReportFile {
    std::string name, text;
};

} // namespace relief::bench
