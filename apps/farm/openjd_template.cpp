// farm submit --to openjd: a template that programs of Open Job Description run.
#include <algorithm>

#include <fmt/format.h>

#include "common/console.h"
#include "common/exit_codes.h"
#include "common/report.h"
#include "farm/batch.h"
#include "farm/submit.h"
#include "relief/io.h"

namespace relief::cli {

namespace {

constexpr size_t kMostElements = 1024; ///< values of a task parameter, by its specification

Value make_action(const std::string& command, Value arguments) {
    Value action = {{"command", command},
                    {"args", std::move(arguments)},
                    {"cancelation", {{"mode", "NOTIFY_THEN_TERMINATE"}, {"notifyPeriodInSeconds", 30}}}};
    return {{"actions", {{"onRun", std::move(action)}}}};
}

Value make_render_step(const Batch& batch) {
    const Value element = {
        {"name", "Element"}, {"type", "INT"}, {"range", fmt::format("0-{}", batch.element_count - 1)}};
    return {
        {"name", "Render"},
        {"parameterSpace", {{"taskParameterDefinitions", Value::list({element})}}},
        {"script", make_action((batch.folder / "run.sh").string(), Value::list({"{{Task.Param.Element}}"}))}};
}

Value make_merge_step(const FarmJob& job) {
    const Value after = {{"dependsOn", "Render"}};
    return {{"name", "Merge"},
            {"dependencies", Value::list({after})},
            {"script", make_action(get_program(), Value::list({"farm", "merge", job.folder.string()}))}};
}

} // namespace

int write_openjd_template(const FarmJob& job, const std::vector<uint32_t>& tasks,
                          const SubmitOptions& options) {
    const Batch batch = write_batch(job, tasks, kMostElements, std::max<size_t>(1, options.group),
                                    std::max(1, options.threads));
    Value steps = Value::list({make_render_step(batch)});
    if (options.merge == MergeStep::with) steps.push_back(make_merge_step(job));
    const Value json = {{"specificationVersion", "jobtemplate-2023-09"},
                        {"name", "Relief " + job.scene.stem().string()},
                        {"steps", std::move(steps)}};
    const std::filesystem::path file = batch.folder / "openjd.json";
    write_text_file(file, write_json(json, 2));
    print_output("wrote {}\n", file.string());
    print_output("openjd run {}{} runs it\n", quote_word(file.string()),
                 options.merge == MergeStep::with ? " --run-dependencies --step Merge" : " --step Render");
    return kExitDone;
}

} // namespace relief::cli
