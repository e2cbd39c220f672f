#include "render_warnings.h"

#include <algorithm>
#include <cstdio>
#include <mutex>
#include <string_view>

#include <utility>

#include <fmt/format.h>

#include "common/console.h"
#include "common/option_names.h"
#include "interrupt.h"
#include "relief/inspect.h"
#include "relief/io.h"

namespace relief::cli {

namespace {

/// `section`.axes = t,n,b becomes "axes": "t,n,b", as in a scene file; `section`.axes alone becomes "axes".
std::string name_keys_of(std::string_view section, std::string text) {
    constexpr std::string_view kEquals = " = ";
    for (size_t at = 0; (at = text.find(section, at)) != std::string::npos;) {
        const size_t begin = at + section.size();
        const size_t key_end =
            std::min(text.find_first_not_of("abcdefghijklmnopqrstuvwxyz_", begin), text.size());
        const std::string key = text.substr(begin, key_end - begin);
        size_t end = key_end;
        std::string written = fmt::format("\"{}\"", key);
        if (text.compare(key_end, kEquals.size(), kEquals) == 0) {
            const size_t value = key_end + kEquals.size();
            end = std::min(text.find_first_of(" ;", value), text.size());
            if (end > value && text[end - 1] == ',') --end;
            const std::string word = text.substr(value, end - value);
            const bool is_number = word.find_first_not_of("0123456789.-+e") == std::string::npos;
            written += is_number ? fmt::format(": {}", word) : fmt::format(": \"{}\"", word);
        }
        text.replace(at, end - at, written);
        at += written.size();
    }
    return text;
}

/// Writes keys as they stand under 'displacements' and 'meshes' of a scene file.
std::string name_keys(std::string text) {
    if (text.find("mesh.weld = ") != std::string::npos) text = name_keys_of("mesh.", std::move(text));
    return name_keys_of("displacement.", std::move(text));
}

/// What is done before the first ray.
std::string describe_preparation(const std::string& step, EngineKind engine) {
    return fmt::format("{}{}preparing{}", step, step.empty() ? "" : ": ",
                       engine == EngineKind::vulkan ? ", and compiling kernels if the device is new" : "");
}

} // namespace

void add_assumption_warnings(Scene& scene, bool is_quiet, bool is_mesh) {
    for (const Finding& finding : find_doubtful_assumptions(scene)) {
        if (finding.severity != Severity::note)
            scene.warnings.push_back(finding.text);
        else if (!is_quiet)
            print_error("relief: note: {}\n", name_setting(finding.text, is_mesh));
    }
}

std::string name_setting(std::string warning, bool is_mesh) {
    return name_options(is_mesh ? std::move(warning) : name_keys(std::move(warning)));
}

void print_warnings(const std::vector<std::string>& warnings, bool is_mesh) {
    for (const std::string& warning : warnings)
        print_error("relief: warning: {}\n", name_setting(warning, is_mesh));
}

std::vector<std::string> ToldWarnings::take_new(const std::vector<std::string>& warnings) {
    std::vector<std::string> fresh;
    for (const std::string& warning : warnings)
        if (told_.insert(warning).second) fresh.push_back(warning);
    return fresh;
}

RenderWatcher::RenderWatcher(const RenderOptions& options, ToldWarnings& told, std::string step)
    : printer_(options.progress),
      options_(options),
      told_(told),
      step_(std::move(step)),
      preparing_(printer_, describe_preparation(step_, options.settings.device.engine)) {}

void RenderWatcher::on_warnings(const std::vector<std::string>& warnings) {
    const std::vector<std::string> fresh = told_.take_new(warnings);
    std::unique_lock<std::mutex> lock;
    if (!fresh.empty()) lock = preparing_.interject();
    if (!options_.progress.is_quiet || options_.is_strict)
        print_warnings(fresh, is_mesh_file(options_.input));
    is_refused_ = options_.is_strict && !warnings.empty();
    if (is_refused_) print_error("relief: nothing is rendered with warnings under --strict\n");
}

void RenderWatcher::on_progress(const Progress& progress) {
    preparing_.stop();
    if (progress.samples_done > 0) keep_picture();
    printer_.print(progress, step_);
}

bool RenderWatcher::is_cancelled() const {
    poll_interrupts();
    return is_refused_ || get_interrupt() != 0;
}

} // namespace relief::cli
