#include "render_series.h"

#include <cstdio>
#include <fstream>
#include <iostream>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "aim_options.h"
#include "common/console.h"
#include "common/exit_codes.h"
#include "common/inputs.h"
#include "edit_stream.h"
#include "interrupt.h"
#include "picture_series.h"
#include "relief/aim.h"
#include "relief/error.h"

namespace relief::cli {

namespace {

Camera turn_to(const RenderOptions& options, const Camera& camera, int turn) {
    return turn_camera(camera, 360.0f * float(turn) / float(options.aim.turntable));
}

void print_edit(const EditReport& report) {
    print_error("edit: {} patches in {:.4f} s\n", report.patches, report.seconds);
}

/// Checks all lines of a file before the first render. Texels are read again when needed, because all of them
/// together may exceed memory.
void check_edits(const std::string& path, const std::string& only_displacement, const Session& session,
                 const std::vector<std::string>& files) {
    std::ifstream file(path);
    EditStream edits(file, path, only_displacement);
    std::set<std::filesystem::path> read, written; // sets: there may be thousands
    while (const std::optional<EditLine> line = edits.next())
        edits.with_place([&] {
            session.check(line->edit);
            const std::filesystem::path texels = find_place(line->edit.texels.file);
            read.insert(texels);
            if (written.contains(texels)) refuse_output(line->edit.texels.file);
            if (line->output.empty()) return;
            keep_files(files, line->output);
            const std::filesystem::path output = find_place(line->output);
            written.insert(output);
            if (read.contains(output)) refuse_output(line->output);
        });
}

} // namespace

int render_turns(const RenderOptions& options, const RenderSettings& settings, Scene scene,
                 PendingTimes waiting) {
    const std::vector<std::string> files = list_files(scene);
    for (int k = 0; k < options.aim.turntable; ++k) keep_files(files, name_turn(options.output, k));
    const Camera camera = scene.camera;
    const uint64_t hash = scene.hash;
    PictureSeries series(options);
    series.hold(std::move(scene), settings);
    int exit_code = kExitDone;
    for (int k = 0; k < options.aim.turntable && exit_code == kExitDone; ++k) {
        exit_code =
            series.show({turn_to(options, camera, k), k == 0 ? hash : 0}, 0, name_turn(options.output, k),
                        fmt::format("picture {} of {}", k + 1, options.aim.turntable), waiting);
        waiting = {get_seconds(), 0};
    }
    return exit_code;
}

int render_edits(const RenderOptions& options, const RenderSettings& given, Scene scene,
                 PendingTimes waiting) {
    const RenderSettings settings = reserve_time(options, given, {get_seconds(), 0});
    std::ifstream file;
    if (options.edits != "-") file.open(options.edits);
    std::vector<std::string> files = list_files(scene);
    files.push_back(options.edits);
    const std::string only_displacement =
        scene.displacements.size() == 1 ? scene.displacements[0].name : std::string();
    EditStream edits(options.edits == "-" ? std::cin : file,
                     options.edits == "-" ? "standard input" : options.edits, only_displacement);
    ToldWarnings told;
    Session session(std::move(scene), settings);
    if (options.edits != "-") check_edits(options.edits, only_displacement, session, files);
    const auto show = [&](const std::filesystem::path& output) {
        const auto render_next = [&](RenderObserver* observer) { return session.render(observer); };
        return show_next(options, settings, render_next, output, waiting, told);
    };
    int exit_code = show(options.output);
    bool is_pending = false; // edits not shown in a picture yet
    while (exit_code == kExitDone) {
        await_input();
        if (get_interrupt() != 0) { // it came with the last picture
            print_error("relief: interrupted while it waited for edits\n");
            return kExitSignalBase + get_interrupt();
        }
        const std::optional<EditLine> line = edits.next();
        poll_interrupts();
        if (!line) break;
        if (!is_pending) waiting.start = get_seconds() - line->read_s, waiting.load_s = 0;
        edits.with_place([&] {
            keep_files({line->edit.texels.file}, line->output);
            keep_files(files, line->output);
            const EditReport report = session.edit(line->edit);
            if (options.is_verbose) print_edit(report);
        });
        is_pending = line->output.empty();
        if (!is_pending) exit_code = show(line->output);
    }
    return exit_code;
}

} // namespace relief::cli
