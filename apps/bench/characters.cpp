#include "bench/characters.h"

#include <algorithm>
#include <map>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "bench/character_programs.h"
#include "bench/cycles.h"
#include "bench/machine.h"
#include "relief/error.h"
#include "relief/io.h"

namespace relief::bench {

namespace {

using Kind = CharacterProgram::Kind;

constexpr int kCharacterBounces = 4;
constexpr double kCharacterFirstGoal = 1, kCharacterRenderGoal = 0.6, kCharacterMemoryGoal = 0.6,
                 kCrowdMemoryGoal = 0.1;
constexpr double kMaskGoal = 0.02; ///< part of the hit pixels

constexpr const char* kAboutColdTimes =
    "first_sample_s and render_s: one sample, and all samples, each in a process of its own. For programs in "
    "Blender they are the call of the render, with the reading of maps; for the command they are the whole "
    "process, with reading and writing. from_start_s is from the start of the process in both.";
constexpr const char* kAboutSessions =
    "first_s, turned_s, moved_s, changed_s: pictures of one sample, one after another in one process: of the "
    "scene as it is, with the camera turned, the first object moved, and its map changed. Blender keeps its "
    "data (use_persistent_data) and renders final pictures; for the command it is a session of the library.";
constexpr const char* kAboutProcessMemory =
    "resident_peak_bytes: the most that the process of all samples had resident, Blender itself included.";
constexpr const char* kAboutRatios = "ratios: Relief over Cycles, run by run. Goals compare with the Cycles "
                                     "of the newest Blender that is there.";
constexpr const char* kAboutPictures =
    "agreement: with the picture of that Cycles: pixels that are hit, pixels in which only one of the two "
    "hits, mean brightness of Relief over that of Cycles where both hit.";

struct ProgramRuns {
    const CharacterProgram* program = nullptr;
    std::vector<Measures> runs;
};

Value compare_runs(const std::vector<Measures>& relief, const std::vector<Measures>& cycles) {
    const std::pair<const char*, const char*> measures[] = {{"first_sample", "first_sample_s"},
                                                            {"render", "render_s"},
                                                            {"memory", "resident_peak_bytes"},
                                                            {"turned", "turned_s"},
                                                            {"moved", "moved_s"},
                                                            {"changed", "changed_s"}};
    Value ratios;
    for (const auto& [name, measure] : measures) {
        if (!relief.front().contains(measure)) continue;
        std::vector<double> values;
        for (size_t k = 0; k < relief.size(); ++k)
            values.push_back(relief[k].at(measure) / cycles[k].at(measure));
        ratios[name] = summarize(std::move(values));
    }
    return ratios;
}

class CharactersSuite {
  public:
    CharactersSuite(const CharactersOptions& options, const Report& report)
        : options_(options),
          report_(report),
          threads_(options.threads > 0 ? options.threads
                                       : std::max(1, int(std::thread::hardware_concurrency()))),
          found_(find_character_programs(options.relief, options.blenders, options.folder)) {}

    Value run() {
        make_head();
        for (const std::string& name : options_.scenes) {
            report_("making the scene " + name);
            measure(write_character(name, options_.detail, options_.folder / "scenes"));
        }
        for (const CharacterFile& file : options_.files) {
            report_("reading " + file.mesh.string());
            measure(write_character(file, options_.folder / "scenes"));
        }
        return std::move(result_);
    }

  private:
    void make_head() {
        result_ = {{"suite", "characters"}, {"build", describe_build()}, {"machine", describe_machine()}};
        Value sizes = Value::list(), files = Value::list();
        for (const auto& [width, height] : options_.sizes)
            sizes.push_back(fmt::format("{}x{}", width, height));
        for (const CharacterFile& file : options_.files) files.push_back(file.mesh.string());
        result_["settings"] = {{"sizes", sizes},
                               {"threads", threads_},
                               {"runs", options_.runs},
                               {"samples", options_.samples},
                               {"bounces", kCharacterBounces},
                               {"dicing_rate_pixels", 1},
                               {"importance_map", kImportanceMap},
                               {"scenes", options_.scenes},
                               {"files", files}};
        result_["comparable"] =
            Value::list({kAboutColdTimes, kAboutSessions, kAboutProcessMemory, kAboutRatios, kAboutPictures});
        result_["programs"] = Value::list(), result_["skipped"] = Value::list();
        for (const CharacterProgram& program : found_.programs) result_["programs"].push_back(program.name());
        for (const SkippedProgram& skipped : found_.skipped) {
            report_(fmt::format("skipped {}: {}", skipped.name, skipped.reason));
            result_["skipped"].push_back({{"name", skipped.name}, {"reason", skipped.reason}});
        }
        result_["cases"] = Value::list(), result_["goals"] = Value::list();
    }

    void measure(const CharacterInput& input) {
        for (const auto& [width, height] : options_.sizes) {
            CharacterTask task;
            task.width = width, task.height = height;
            task.bounces = kCharacterBounces, task.threads = threads_;
            measure(input, task, fmt::format("{} {}x{}", input.name, width, height));
        }
    }

    void measure(const CharacterInput& input, const CharacterTask& task, const std::string& what) {
        const Value agreement = compare_pictures(input, task, what);
        std::vector<ProgramRuns> all;
        for (const CharacterProgram& program : found_.programs) all.push_back({&program, {}});
        for (int run = 1; run <= options_.runs; ++run)
            for (ProgramRuns& runs : all) {
                report_(fmt::format("{}: run {} of {}", what, run, runs.program->name()));
                runs.runs.push_back(measure_once(*runs.program, input, task));
            }
        Value entry = {{"scene", input.name}, {"width", task.width}, {"height", task.height}};
        for (const ProgramRuns& runs : all)
            entry["programs"][runs.program->name()] = summarize_measures(runs.runs);
        entry["agreement"] = agreement, entry["ratios"] = Value::list();
        add_ratios(what, input.name == "crowd", all, entry);
        result_["cases"].push_back(std::move(entry));
    }

    Measures measure_once(const CharacterProgram& program, const CharacterInput& input,
                          CharacterTask task) const {
        task.samples = 1;
        const Measures first = program.render(input, task);
        Measures all = program.run_session(input, task);
        task.samples = options_.samples;
        all.merge(program.render(input, task));
        all["first_sample_s"] = first.at("render_s");
        all["first_sample_from_start_s"] = first.at("from_start_s");
        return all;
    }

    const CharacterProgram* find_cycles() const {
        const auto found = std::ranges::find(found_.programs, Kind::cycles, &CharacterProgram::kind);
        return found == found_.programs.end() ? nullptr : &*found;
    }

    /// Also serves as warm-up.
    Value compare_pictures(const CharacterInput& input, CharacterTask task, const std::string& what) {
        task.samples = options_.samples;
        std::map<const CharacterProgram*, std::filesystem::path> pictures;
        for (size_t k = 0; k < found_.programs.size(); ++k) {
            report_(fmt::format("{}: picture of {}", what, found_.programs[k].name()));
            task.picture =
                options_.folder / fmt::format("{}_{}x{}_{}.exr", input.name, task.width, task.height, k);
            found_.programs[k].render(input, task);
            pictures[&found_.programs[k]] = task.picture;
        }
        Value agreement = Value::list();
        const CharacterProgram* cycles = find_cycles();
        for (const CharacterProgram& program : found_.programs) {
            if (!cycles || &program == cycles) continue;
            Value entry = {{"program", program.name()}, {"with", cycles->name()}};
            entry.update(
                compare_with_cycles(read_image(pictures.at(&program)), read_image(pictures.at(cycles))));
            if (program.kind() != Kind::cycles) add_picture_goal(what, entry);
            agreement.push_back(std::move(entry));
        }
        return agreement;
    }

    void add_picture_goal(const std::string& what, const Value& agreement) {
        const double hits = agreement["hit_pixels"].get<double>();
        const double share = hits > 0 ? agreement["masks_differ"].get<double>() / hits : 1;
        result_["goals"].push_back(
            {{"name", fmt::format("{}: silhouette of {}", what, agreement["program"].get<std::string>())},
             {"goal", kMaskGoal},
             {"reached", share},
             {"unit", "of the pixels differ from Cycles"},
             {"met", share <= kMaskGoal}});
    }

    void add_ratios(const std::string& what, bool is_crowd, const std::vector<ProgramRuns>& all,
                    Value& entry) {
        const CharacterProgram* newest = find_cycles();
        for (const ProgramRuns& relief : all)
            for (const ProgramRuns& cycles : all) {
                if (relief.program->kind() == Kind::cycles || cycles.program->kind() != Kind::cycles)
                    continue;
                const Value ratios = compare_runs(relief.runs, cycles.runs);
                Value row = {{"program", relief.program->name()}, {"to", cycles.program->name()}};
                row.update(ratios);
                if (cycles.program == newest)
                    add_character_goals(
                        fmt::format("{}: {} to {}", what, relief.program->name(), cycles.program->name()),
                        is_crowd, ratios, result_["goals"]);
                entry["ratios"].push_back(std::move(row));
            }
    }

    const CharactersOptions& options_;
    const Report& report_;
    int threads_;
    CharacterPrograms found_;
    Value result_;
};

} // namespace

CharactersOptions make_quick_options(CharactersOptions options) {
    options.detail = CharacterDetail::reduced;
    options.sizes = {{24, 32}};
    options.samples = 2;
    options.runs = 1;
    return options;
}

void add_character_goals(const std::string& name, bool is_crowd, const Value& ratios, Value& goals) {
    const struct {
        const char *ratio, *words;
        double goal;
    } wanted[] = {{"first_sample", "first sample", kCharacterFirstGoal},
                  {"render", "all samples", kCharacterRenderGoal},
                  {"memory", "peak resident memory", is_crowd ? kCrowdMemoryGoal : kCharacterMemoryGoal}};
    for (const auto& [ratio, words, goal] : wanted) {
        const double reached = ratios[ratio]["median"].get<double>();
        goals.push_back({{"name", fmt::format("{}: {}", name, words)},
                         {"goal", goal},
                         {"reached", reached},
                         {"unit", "of Cycles'"},
                         {"met", reached <= goal}});
    }
}

Value run_characters(const CharactersOptions& options, const Report& report) {
    return CharactersSuite(options, report).run();
}

Table make_characters_table(const Value& result) {
    Table table{{"scene", "width", "height", "program", "to", "measure", "median", "lowest", "highest"}, {}};
    const auto add = [&](const Value& entry, const Value& program, const Value& to, const std::string& name,
                         const Value& summary) {
        table.rows.push_back({entry["scene"], entry["width"], entry["height"], program, to, name,
                              summary["median"], summary["lowest"], summary["highest"]});
    };
    for (const Value& entry : result["cases"]) {
        for (const auto& [program, measures] : entry["programs"].members())
            for (const auto& [name, summary] : measures.members())
                add(entry, Value(program), {}, name, summary);
        for (const Value& row : entry["ratios"])
            for (const auto& [name, summary] : row.members())
                if (name != "program" && name != "to")
                    add(entry, row["program"], row["to"], name + "_ratio", summary);
    }
    return table;
}

} // namespace relief::bench
