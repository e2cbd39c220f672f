#include "common/option_hints.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "base/suggest.h"
#include "relief/error.h"

namespace relief::cli {

namespace {

/// What a value must look like to be repeated in the hint.
enum class Shape { none, number, size };

/// A name without dashes and what is written in its place. Rows whose option the command lacks are skipped.
struct Synonym {
    std::string_view name, option, text;
    Shape shape = Shape::none;
    std::string_view with_value = {}; ///< "{}" stands for the value
};

constexpr Synonym kSynonyms[] = {
    {"width", "--size", "--size WxH", Shape::number, "--size {}xH"},
    {"w", "--size", "--size WxH", Shape::number, "--size {}xH"},
    {"height", "--size", "--size WxH", Shape::number, "--size Wx{}"},
    {"resolution", "--size", "--size WxH", Shape::size, "--size {}"},
    {"res", "--size", "--size WxH", Shape::size, "--size {}"},
    {"dimensions", "--size", "--size WxH", Shape::size, "--size {}"},
    {"image-size", "--size", "--size WxH", Shape::size, "--size {}"},
    {"s", "--size", "--size WxH", Shape::size, "--size {}"},
    {"quality", "--spp", "--spp N", Shape::number, "--spp {}"},
    {"samples", "--spp", "--spp N", Shape::number, "--spp {}"},
    {"sample", "--spp", "--spp N", Shape::number, "--spp {}"},
    {"num-samples", "--spp", "--spp N", Shape::number, "--spp {}"},
    {"n-samples", "--spp", "--spp N", Shape::number, "--spp {}"},
    {"samples-per-pixel", "--spp", "--spp N", Shape::number, "--spp {}"},
    {"pixel-samples", "--spp", "--spp N", Shape::number, "--spp {}"},
    {"aa", "--spp", "--spp N", Shape::number, "--spp {}"},
    {"sample-range", "--samples", "--samples A:B"},
    {"output", "-o", "-o"},
    {"out", "-o", "-o"},
    {"outfile", "-o", "-o"},
    {"output-file", "-o", "-o"},
    {"output-dir", "-o", "-o"},
    {"save", "-o", "-o"},
    {"write", "-o", "-o"},
    {"folder", "-o", "-o"},
    {"dir", "-o", "-o"},
    {"directory", "-o", "-o"},
    {"format", "-o", "-o FILE, whose extension is the format"},
    {"gpu", "--engine", "--engine vulkan"},
    {"vulkan", "--engine", "--engine vulkan"},
    {"cuda", "--engine", "--engine vulkan"},
    {"optix", "--engine", "--engine vulkan"},
    {"opencl", "--engine", "--engine vulkan"},
    {"metal", "--engine", "--engine vulkan"},
    {"cpu", "--engine", "--engine cpu"},
    {"backend", "--engine", "--engine NAME"},
    {"renderer", "--engine", "--engine NAME"},
    {"verbose", "-v", "-v"},
    {"debug", "-v", "-v"},
    {"quiet", "-q", "-q"},
    {"silent", "-q", "-q"},
    {"no-progress", "--progress", "--progress none"},
    {"jobs", "--threads", "--threads N", Shape::number, "--threads {}"},
    {"j", "--threads", "--threads N", Shape::number, "--threads {}"},
    {"t", "--threads", "--threads N", Shape::number, "--threads {}"},
    {"cores", "--threads", "--threads N", Shape::number, "--threads {}"},
    {"num-threads", "--threads", "--threads N", Shape::number, "--threads {}"},
    {"nthreads", "--threads", "--threads N", Shape::number, "--threads {}"},
    {"simd", "--isa", "--isa NAME"},
    {"depth", "--bounces", "--bounces N", Shape::number, "--bounces {}"},
    {"max-depth", "--bounces", "--bounces N", Shape::number, "--bounces {}"},
    {"ray-depth", "--bounces", "--bounces N", Shape::number, "--bounces {}"},
    {"max-bounces", "--bounces", "--bounces N", Shape::number, "--bounces {}"},
    {"path-length", "--bounces", "--bounces N", Shape::number, "--bounces {}"},
    {"displacement", "--vdm", "--vdm MAP"},
    {"displace", "--vdm", "--vdm MAP"},
    {"displacement-map", "--vdm", "--vdm MAP"},
    {"disp", "--vdm", "--vdm MAP"},
    {"map", "--vdm", "--vdm MAP"},
    {"texture", "--vdm", "--vdm MAP"},
    {"heightmap", "--vdm", "--vdm MAP --type height"},
    {"height-map", "--vdm", "--vdm MAP --type height"},
    {"hdri", "--env", "--env MAP"},
    {"hdr", "--env", "--env MAP"},
    {"environment", "--env", "--env MAP"},
    {"envmap", "--env", "--env MAP"},
    {"env-map", "--env", "--env MAP"},
    {"sky", "--env", "--env MAP"},
    {"ibl", "--env", "--env MAP"},
    {"world", "--env", "--env MAP"},
    {"scale", "--vdm-scale", "--vdm-scale F", Shape::number, "--vdm-scale {}"},
    {"displacement-scale", "--vdm-scale", "--vdm-scale F", Shape::number, "--vdm-scale {}"},
    {"strength", "--vdm-scale", "--vdm-scale F", Shape::number, "--vdm-scale {}"},
    {"amount", "--vdm-scale", "--vdm-scale F", Shape::number, "--vdm-scale {}"},
    {"mid", "--midlevel", "--midlevel F", Shape::number, "--midlevel {}"},
    {"zero", "--midlevel", "--midlevel F", Shape::number, "--midlevel {}"},
    {"bias", "--midlevel", "--midlevel F", Shape::number, "--midlevel {}"},
    {"swizzle", "--axes", "--axes LIST"},
    {"order", "--axes", "--axes LIST"},
    {"program", "--preset", "--preset NAME"},
    {"software", "--preset", "--preset NAME"},
    {"flip", "--flip-v", "--flip-v"},
    {"flip-y", "--flip-v", "--flip-v"},
    {"invert-v", "--flip-v", "--flip-v"},
    {"tiling", "--wrap", "--wrap repeat"},
    {"repeat", "--wrap", "--wrap repeat"},
    {"subdiv", "--subdivision", "--subdivision catmark"},
    {"subdivide", "--subdivision", "--subdivision catmark"},
    {"subd", "--subdivision", "--subdivision catmark"},
    {"smooth", "--subdivision", "--subdivision catmark"},
    {"catmull-clark", "--subdivision", "--subdivision catmark"},
    {"subdiv-level", "--subdivision-level", "--subdivision-level N", Shape::number, "--subdivision-level {}"},
    {"tessellate", "--surface", "--surface tessellated"},
    {"region", "--crop", "--crop x0,y0,x1,y1"},
    {"window", "--crop", "--crop x0,y0,x1,y1"},
    {"border", "--crop", "--crop x0,y0,x1,y1"},
    {"aov", "--layers", "--layers LIST"},
    {"aovs", "--layers", "--layers LIST"},
    {"channels", "--layers", "--layers LIST"},
    {"aov", "--layer", "--layer NAME"},
    {"channel", "--layer", "--layer NAME"},
    {"cache", "--bottom-cache", "--bottom-cache MB", Shape::number, "--bottom-cache {}"},
    {"memory", "--bottom-cache", "--bottom-cache MB", Shape::number, "--bottom-cache {}"},
    {"random-seed", "--seed", "--seed N", Shape::number, "--seed {}"},
    {"report", "--stats", "--stats FILE.json"},
    {"log", "--stats", "--stats FILE.json"},
    {"json", "--stats", "--stats FILE.json"},
    {"camera", "--from", "--from x,y,z --to x,y,z"},
    {"cam", "--from", "--from x,y,z --to x,y,z"},
    {"position", "--from", "--from x,y,z --to x,y,z"},
    {"eye", "--from", "--from x,y,z --to x,y,z"},
    {"look-at", "--from", "--from x,y,z --to x,y,z"},
    {"lookat", "--from", "--from x,y,z --to x,y,z"},
    {"focal-length", "--fov", "--fov DEGREES"},
    {"focal", "--fov", "--fov DEGREES"},
    {"tolerance", "--threshold", "--threshold F", Shape::number, "--threshold {}"},
    {"epsilon", "--threshold", "--threshold F", Shape::number, "--threshold {}"},
    {"max-error", "--threshold", "--threshold F", Shape::number, "--threshold {}"},
    {"max-error", "--pixel-error", "--pixel-error F", Shape::number, "--pixel-error {}"},
    {"half", "--samples", "--samples half"},
    {"fp16", "--samples", "--samples half"},
    {"bits", "--samples", "--samples half, float or uint16"},
    {"bg", "--background", "--background COLOR"},
    {"background-color", "--background", "--background COLOR"},
    {"transparent", "--background", "--background transparent"},
    {"transparency", "--background", "--background transparent"},
    {"alpha", "--background", "--background transparent"},
    {"film-transparent", "--background", "--background transparent"},
    {"sun", "--light", "--light sun:AZ,EL"},
    {"lights", "--light", "--light sun:AZ,EL"},
    {"key-light", "--light", "--light sun:AZ,EL"},
    {"floor", "--ground", "--ground"},
    {"plane", "--ground", "--ground"},
    {"shadow", "--ground", "--ground=shadow"},
    {"shadow-catcher", "--ground", "--ground=shadow"},
    {"ev", "--exposure", "--exposure EV"},
    {"brightness", "--exposure", "--exposure EV"},
    {"gamma", "--tonemap", "--tonemap NAME"},
    {"display", "--tonemap", "--tonemap NAME"},
    {"tone-mapping", "--tonemap", "--tonemap NAME"},
    {"view-transform", "--tonemap", "--tonemap NAME"},
    {"bit-depth", "--png-bits", "--png-bits 8, or 16"},
    {"closer", "--zoom", "--zoom F"},
    {"distance", "--from", "--from x,y,z"},
    {"magnify", "--zoom", "--zoom F", Shape::number, "--zoom {}"},
    {"lens", "--fov", "--fov DEGREES"},
    {"angle", "--view", "--view NAME"},
    {"side", "--view", "--view NAME"},
    {"fit", "--frame-all", "--frame-all"},
    {"center", "--frame-all", "--frame-all"},
    {"rotate", "--turntable", "--turntable N, or --env-rotate D"},
    {"spin", "--turntable", "--turntable N"},
    {"frames", "--turntable", "--turntable N", Shape::number, "--turntable {}"},
    {"animation", "--turntable", "--turntable N"},
    {"env-rotation", "--env-rotate", "--env-rotate D"},
    {"hdri-rotation", "--env-rotate", "--env-rotate D"},
    {"intensity", "--env-strength", "--env-strength F"},
    {"env-intensity", "--env-strength", "--env-strength F"},
    {"adaptive", "--noise", "--noise F"},
    {"noise-threshold", "--noise", "--noise F"},
    {"time", "--time-limit", "--time-limit S"},
    {"timeout", "--time-limit", "--time-limit S"},
    {"denoiser", "--denoise", "--denoise"},
    {"oidn", "--denoise", "--denoise"},
    {"clamp", "--clamp-indirect", "--clamp-indirect F"},
    {"continue", "--resume", "--resume FILE"},
    {"autosave", "--checkpoint", "--checkpoint MIN"},
    {"passes", "--layers", "--layers LIST"},
    {"light-groups", "--layers", "--layers light_default,light_NAME"},
    {"light-group", "--layers", "--layers light_NAME"},
    {"cryptomatte", "--layers", "--layers CryptoObject,CryptoMaterial"},
    {"export-scene", "--save-scene", "--save-scene FILE.json"},
    {"warnings-as-errors", "--strict", "--strict"},
    {"werror", "--strict", "--strict"},
    {"force", "--allow-gaps", "--allow-gaps"},
    {"partial", "--allow-gaps", "--allow-gaps"},
    {"ignore-missing", "--allow-gaps", "--allow-gaps"},
    {"instances", "--instanced", "--instanced"},
    {"usage", "--help", "--help"},
    {"?", "--help", "--help"},
    {"V", "--version", "--version"},
};

/// What no option says.
struct Note {
    std::string_view name, option, text; ///< for commands that have `option`
};

constexpr Note kNotes[] = {
    {"material", "--spp", "materials stand in the scene file, under 'materials'"},
    {"subsurface", "--spp", "there is none yet; materials stand in the scene file, under 'materials'"},
    {"mesh", "--spp", "scenes and meshes stand without an option, in any place"},
    {"input", "--spp", "scenes and meshes stand without an option, in any place"},
    {"i", "--spp", "scenes and meshes stand without an option, in any place"},
    {"scene", "--spp", "scenes and meshes stand without an option, in any place"},
    {"noise", "--passes",
     "tasks of a farm have a fixed number of samples: where they end would depend on the cut"},
    {"time-limit", "--passes",
     "tasks of a farm have a fixed number of samples: what a machine finds time for is no picture of the "
     "job"},
    {"units", "--spp", "lengths are those of the file: --vdm-scale F fits the map to the mesh"},
    {"unit", "--spp", "lengths are those of the file: --vdm-scale F fits the map to the mesh"},
};

constexpr std::string_view kCommands[][2] = {
    {"view", "render"},        {"show", "render"},
    {"trace", "render"},       {"draw", "render"},
    {"open", "render"},        {"info", "inspect"},
    {"check", "inspect"},      {"identify", "inspect"},
    {"validate", "inspect"},   {"stat", "inspect"},
    {"stats", "inspect"},      {"diff", "compare"},
    {"cmp", "compare"},        {"join", "merge"},
    {"combine", "merge"},      {"stitch", "merge"},
    {"benchmark", "bench"},    {"measure", "bench"},
    {"gpus", "devices"},       {"list", "devices"},
    {"export", "convert"},     {"transform", "convert"},
    {"bake", "convert"},       {"sample", "scene"},
    {"example", "scene"},      {"demo", "scene"},
    {"help", "relief --help"}, {"version", "relief --version"},
};

std::string strip_dashes(std::string_view word) {
    return std::string(word.substr(std::min(word.find_first_not_of('-'), word.size())));
}

/// Lower case, with dashes for underscores; one letter stays as it is.
std::string normalize_name(std::string_view word) {
    std::string name = strip_dashes(word);
    if (name.size() == 1) return name;
    for (char& c : name) c = c == '_' ? '-' : char(std::tolower(static_cast<unsigned char>(c)));
    return name;
}

bool has_option(const CLI::App& app, std::string_view option) {
    return app.get_option_no_throw(std::string(option)) != nullptr;
}

bool fits(std::string_view value, Shape shape) {
    const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
    if (value.empty() || !is_digit(value.front()) || !is_digit(value.back())) return false;
    const auto others = std::count_if(value.begin(), value.end(), [&](char c) { return !is_digit(c); });
    if (shape == Shape::number)
        return others == 0 || (others == 1 && value.find('.') != std::string_view::npos);
    return shape == Shape::size && others == 1 && value.find('x') != std::string_view::npos;
}

std::string ask(std::string_view text) { return fmt::format("did you mean '{}'?", text); }

std::string find_synonym(const std::string& name, std::string_view value, const CLI::App& app) {
    for (const Synonym& row : kSynonyms) {
        if (row.name != name || !has_option(app, row.option)) continue;
        if (!fits(value, row.shape)) return ask(row.text);
        std::string text(row.with_value);
        return ask(text.replace(text.find("{}"), 2, value));
    }
    return {};
}

std::string find_note(const std::string& name, const CLI::App& app) {
    for (const Note& note : kNotes)
        if (note.name == name && has_option(app, note.option)) return std::string(note.text);
    return {};
}

std::vector<std::string> list_long_names(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::Option* option : app.get_options())
        for (const std::string& name : option->get_lnames()) names.push_back(name);
    return names;
}

/// The shortest of the names that begin with `name`, where all the others go on from it.
std::string find_extension(const std::string& name, const std::vector<std::string>& names) {
    constexpr size_t kShortest = 3;
    if (name.size() < kShortest) return {};
    std::string shortest;
    for (const std::string& candidate : names)
        if (candidate.starts_with(name) && (shortest.empty() || candidate.size() < shortest.size()))
            shortest = candidate;
    const bool is_clear = std::all_of(names.begin(), names.end(), [&](const std::string& candidate) {
        return !candidate.starts_with(name) || candidate.starts_with(shortest);
    });
    return is_clear ? shortest : std::string();
}

/// A typing mistake or two: more make another word.
std::string find_nearest(const std::string& name, const std::vector<std::string>& names) {
    constexpr size_t kLongest = 64;
    if (name.size() < 3 || name.size() > kLongest) return {};
    const size_t most = name.size() < 5 ? 1 : name.size() < 9 ? 2 : 3;
    std::string nearest;
    size_t smallest = most + 1;
    for (const std::string& candidate : names) {
        const size_t distance = compute_edit_distance(name, candidate);
        const bool is_better = distance < smallest || (distance == smallest && distance <= most &&
                                                       candidate[0] == name[0] && nearest[0] != name[0]);
        if (is_better) smallest = distance, nearest = candidate;
    }
    return nearest;
}

/// "--spp64" where --spp is an option.
std::string find_glued(const std::string& name, const std::vector<std::string>& names) {
    const size_t end = name.find_first_of("0123456789");
    if (end == std::string::npos || end == 0) return {};
    if (std::find(names.begin(), names.end(), name.substr(0, end)) == names.end()) return {};
    return fmt::format("--{} {}", name.substr(0, end), name.substr(end));
}

/// An option of one letter in the other case.
std::string find_letter(const std::string& name, const CLI::App& app) {
    const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
    if (name.size() != 1 || !is_letter(name[0])) return {};
    constexpr char kCaseBit = 0x20;
    const std::string other = {'-', char(name[0] ^ kCaseBit)};
    return has_option(app, other) ? other : std::string();
}

} // namespace

std::string suggest_option(std::string_view word, std::string_view value, const CLI::App& app) {
    const std::string name = normalize_name(word);
    const std::vector<std::string> names = list_long_names(app);
    if (std::find(names.begin(), names.end(), name) != names.end()) return ask("--" + name);
    if (std::string hint = find_synonym(name, value, app); !hint.empty()) return hint;
    if (std::string hint = find_note(name, app); !hint.empty()) return hint;
    if (const std::string letter = find_letter(name, app); !letter.empty()) return ask(letter);
    if (const std::string glued = find_glued(name, names); !glued.empty()) return ask(glued);
    if (const std::string longer = find_extension(name, names); !longer.empty()) return ask("--" + longer);
    const std::string nearest = find_nearest(name, names);
    return nearest.empty() ? std::string() : ask("--" + nearest);
}

std::string suggest_command(std::string_view word, std::span<const std::string_view> commands) {
    const std::string name = normalize_name(word);
    const std::vector<std::string> names(commands.begin(), commands.end());
    const auto is_command = [&](std::string_view known) {
        return std::find(commands.begin(), commands.end(), known) != commands.end();
    };
    if (is_command(name)) return ask(name);
    for (const auto& [slip, command] : kCommands)
        if (slip == name && (is_command(command) || command.find(' ') != std::string_view::npos))
            return ask(command);
    const size_t dot = word.find_last_of('.');
    constexpr std::array<std::string_view, 6> kRendered = {"json", "obj", "ply", "gltf", "glb", "fbx"};
    if (dot != std::string_view::npos &&
        std::find(kRendered.begin(), kRendered.end(), word.substr(dot + 1)) != kRendered.end())
        return ask(fmt::format("relief render {}", word));
    if (const std::string longer = find_extension(name, names); !longer.empty()) return ask(longer);
    const std::string nearest = find_nearest(name, names);
    return nearest.empty() ? std::string() : ask(nearest);
}

void refuse_single_dashes(const CLI::App& app, int argument_count, const char* const* arguments) {
    const CLI::App* command = &app;
    for (const CLI::App* subcommand : app.get_subcommands([](const CLI::App*) { return true; }))
        if (argument_count > 1 && subcommand->get_name() == arguments[1]) command = subcommand;
    for (int k = 1; k < argument_count; ++k) {
        const std::string_view argument = arguments[k];
        const bool is_long = argument.size() > 2 && argument[0] == '-' && argument[1] != '-';
        if (!is_long) continue;
        const std::string word(argument.substr(0, argument.find('=')));
        const std::string name = normalize_name(word);
        const std::string_view value = k + 1 < argument_count ? arguments[k + 1] : "";
        std::string hint;
        if (name.size() > 1 && has_option(*command, "--" + name))
            hint = ask("--" + name);
        else if (name.size() > 2)
            hint = find_synonym(name, value, *command);
        if (!hint.empty())
            throw Error(ErrorKind::usage, {fmt::format("unknown option '{}'", word), "", std::move(hint)});
    }
}

} // namespace relief::cli
