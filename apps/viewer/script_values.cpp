// The line `set` of scripts.
#include <algorithm>
#include <array>
#include <initializer_list>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "base/suggest.h"
#include "common/values.h"
#include "relief/error.h"
#include "relief/io.h"
#include "viewer/conventions.h"
#include "viewer/event_script.h"

namespace relief::viewer {

namespace {

[[noreturn]] void refuse_set(std::string message, std::string hint = {}) {
    throw Error(ErrorKind::bad_input, {std::move(message), "set", std::move(hint)});
}

Vec3f read_factors(const Value& value) {
    if (value.kind() != Value::Kind::list) {
        const float all = value.get<float>();
        return {all, all, all};
    }
    if (value.size() != 3) refuse_set("a list has three numbers, one a channel");
    return {value[0].get<float>(), value[1].get<float>(), value[2].get<float>()};
}

size_t find_displacement(const Scene& scene, const std::string& name) {
    for (size_t k = 0; k < scene.displacements.size(); ++k)
        if (scene.displacements[k].name == name || (name.empty() && scene.displacements.size() == 1))
            return k;
    refuse_set(fmt::format("there is no displacement '{}'", name));
}

/// Words of the convention, by the reader of maps.
void set_words(const Value& values, Displacement& map) {
    MapOptions options;
    constexpr const char* kSpaces[] = {"tangent", "object", "world"};
    options.space =
        values.contains("space") ? values["space"].get<std::string>() : kSpaces[size_t(map.space)];
    if (values.contains("axes")) options.axes = values["axes"].get<std::string>();
    if (values.contains("wrap")) options.wrap = values["wrap"].get<std::string>();
    const Displacement meaning = make_map_meaning(options);
    map.space = meaning.space;
    if (options.axes) map.axes = meaning.axes;
    if (options.wrap) map.wrap = meaning.wrap;
}

void set_displacement(const Value& values, Workbench& workbench) {
    Document* const document = workbench.document();
    if (!document) refuse_set("nothing is open");
    const size_t index = find_displacement(document->scene(), values.text_or_empty("displacement"));
    Displacement changed = document->scene().displacements[index];
    set_words(values, changed);
    if (values.contains("preset")) apply_preset(values["preset"].get<std::string>(), changed);
    if (values.contains("scale")) changed.scale = read_factors(values["scale"]);
    if (values.contains("midlevel")) {
        changed.midlevel = read_factors(values["midlevel"]);
        changed.has_midlevel = true;
    }
    if (values.contains("flip_v")) changed.flip_v = values["flip_v"].get<bool>();
    workbench.change_displacement(index, [&](Displacement& map) { map = changed; });
    if (values.contains("preset")) document->note_preset(index, values["preset"].get<std::string>());
}

void set_environment(const Value& values, Workbench& workbench) {
    workbench.change_environment([&](Environment& environment) {
        if (values.contains("rotate_degrees"))
            environment.rotate_degrees = values["rotate_degrees"].get<float>();
        if (values.contains("strength")) environment.strength = values["strength"].get<float>();
    });
}

void set_view(const Value& values, Workbench& workbench, ViewSettings& view) {
    if (values.contains("exposure")) view.exposure = values["exposure"].get<float>();
    if (values.contains("view")) {
        const std::string name = values["view"].get<std::string>();
        const auto found = std::ranges::find(kViewNames, name);
        if (found == std::end(kViewNames)) refuse_set(fmt::format("there is no view '{}'", name));
        view.view = View(found - std::begin(kViewNames));
    }
    if (values.contains("tool")) {
        constexpr std::array<std::pair<std::string_view, std::optional<BrushKind>>, 5> kTools{
            {{"look", std::nullopt},
             {"push", BrushKind::push},
             {"grab", BrushKind::grab},
             {"smooth", BrushKind::smooth},
             {"erase", BrushKind::erase}}};
        const auto brush = cli::parse_word("tool", values["tool"].get<std::string>(), kTools);
        workbench.set_tool(brush ? Tool::paint : Tool::look);
        if (brush) workbench.brush().kind = *brush;
    }
    if (values.contains("radius")) workbench.brush().radius = values["radius"].get<float>();
    if (values.contains("brush_strength")) workbench.brush().strength = values["brush_strength"].get<float>();
}

} // namespace

void apply_values(const Value& values, Workbench& workbench, ViewSettings& view) {
    constexpr std::array<std::string_view, 18> kKeys = {
        "displacement", "preset", "space",          "axes",     "midlevel", "scale",
        "wrap",         "flip_v", "rotate_degrees", "strength", "exposure", "view",
        "tool",         "radius", "brush_strength", "spp",      "frame",    "denoise"};
    for (const Member& member : values.members())
        if (std::ranges::find(kKeys, member.name) == kKeys.end())
            refuse_set(fmt::format("unknown key '{}'", member.name), suggest_word(member.name, kKeys));
    const auto has_any = [&](std::initializer_list<const char*> keys) {
        return std::ranges::any_of(keys, [&](const char* key) { return values.contains(key); });
    };
    if (has_any({"displacement", "preset", "space", "axes", "midlevel", "scale", "wrap", "flip_v"}))
        set_displacement(values, workbench);
    if (has_any({"rotate_degrees", "strength"})) set_environment(values, workbench);
    if (values.contains("frame")) {
        if (!workbench.frame()) refuse_set("nothing in the scene depends on the frame");
        if (!workbench.show_frame(values["frame"].get<int>())) refuse_set(workbench.message());
    }
    if (values.contains("denoise") && !workbench.set_denoised(values["denoise"].get<bool>()))
        throw Error(ErrorKind::device_missing, {workbench.message(), "set", ""});
    if (values.contains("spp")) {
        const int spp = values["spp"].get<int>();
        if (spp < 1 || spp > kMaxSamples) refuse_set("spp is out of range");
        workbench.change_settings([&](RenderSettings& s) { s.image.spp = spp; });
    }
    set_view(values, workbench, view);
}

} // namespace relief::viewer
