// How the suites are run.
#pragma once

#include <string>
#include <vector>

#include "bench/bench_options.h"
#include "bench/measure.h"
#include "bench/suite_list.h"
#include "common/report.h"

namespace relief::bench {

struct SuiteResult {
    Value result;
    std::vector<ReportFile> files; ///< the first is the result as JSON
};

/// Runs the suite of that name. Throws Error{usage} for an unknown one.
SuiteResult run_suite(const BenchOptions& options, const Report& report);

/// Throws Error{usage} for given options that the suite does not support.
void refuse_options_of_others(const SuiteText& suite, const BenchOptions& options);

} // namespace relief::bench
