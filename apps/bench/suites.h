// The suites by name: what each is called, which options it takes, how it is run.
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
    std::vector<std::string_view> options; ///< those that not every suite has
};

/// Throws Error{usage} with the nearest name where there is no such suite.
const Suite& find_suite(const std::string& name);

/// All suites, each with its help, in one line.
std::string describe_suites();

/// Throws Error{usage} where an option was given that the suite does not have.
void refuse_options_of_others(const Suite& suite, const BenchOptions& options);

} // namespace relief::bench
