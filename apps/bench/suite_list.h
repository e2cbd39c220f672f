// Names of the suites and what their help says. `relief bench --help` needs no more than this.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace relief::bench {

inline constexpr const char* kBenchDescription = "Measure, and compare with the figures of a paper";

struct SuiteText {
    std::string_view name, help;
    std::vector<std::string_view> options; ///< supported options that not every suite has
};

/// The suites of this build.
const std::vector<SuiteText>& list_suites();

/// Throws Error{usage} with the nearest name for an unknown suite.
const SuiteText& find_suite(const std::string& name);

/// All suites with their help, in one line.
std::string describe_suites();

} // namespace relief::bench
