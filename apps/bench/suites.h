// The suites: name, supported options, and how to run them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "bench/bench_options.h"
#include "bench/measure.h"
#include "common/report.h"

namespace relief::bench {

struct SuiteResult {
    Value result;
    std::vector<ReportFile> files; ///< the first is the result as JSON
};

struct Suite {
    std::string_view name, help;
    SuiteResult (*run)(const BenchOptions& options, const Report& report);
    std::vector<std::string_view> options; ///< supported options that not every suite has
};

/// Throws Error{usage} with the nearest name for an unknown suite.
const Suite& find_suite(const std::string& name);

/// All suites with their help, in one line.
std::string describe_suites();

/// Throws Error{usage} for given options that the suite does not support.
void refuse_options_of_others(const Suite& suite, const BenchOptions& options);

} // namespace relief::bench
