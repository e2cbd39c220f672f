#include "answers.h"

#include <string>
#include <utility>
#include <vector>

#include <nanobind/stl/string.h>

#include "cli/statistics_report.h"
#include "common/report.h"
#include "exit_gate.h"
#include "pictures.h"
#include "settings.h"

namespace nb = nanobind;

namespace relief::python {

nb::object make_answer(JobReport&& report, const RenderSettings& settings) {
    RenderResult& result = report.result;
    const std::string statistics = write_json(cli::describe_statistics(result, settings), 0);
    nb::list warnings;
    for (const std::string& warning : result.statistics.warnings) warnings.append(name_keywords(warning));
    const bool has_picture = result.whole_samples > 0;
    return nb::make_tuple(has_picture ? make_picture(std::move(result.image)) : nb::none(), statistics,
                          warnings, result.is_complete, result.whole_samples, report.failure);
}

nb::object render_session(Session& session, const RenderSettings& settings, RenderCallbacks callbacks) {
    callbacks.samples_total = settings.image.spp;
    const GateVisit visit;
    const auto work = [&](RenderObserver& observer) { return session.render(&observer); };
    return make_answer(run_job(work, callbacks), settings);
}

} // namespace relief::python
