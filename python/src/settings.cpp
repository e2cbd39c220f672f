#include "settings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/suggest.h"
#include "common/whole_names.h"
#include "relief/error.h"
#include "values.h"

namespace nb = nanobind;

namespace relief::python {

namespace {

using Read = void (*)(const Argument& value, RenderSettings& settings);

struct Keyword {
    std::string_view name, setting; ///< as the library's messages call it
    bool is_of_rays;                ///< also of an Intersector
    Read read;
};

void read_size(const Argument& value, RenderSettings& s) {
    const std::vector<Argument> sides = value.elements(2, "two whole numbers, width and height");
    s.image.width = int(sides[0].integer(1, kMaxPictureSize)),
    s.image.height = int(sides[1].integer(1, kMaxPictureSize));
}

void read_crop(const Argument& value, RenderSettings& s) {
    const std::vector<Argument> ends = value.elements(4, "four whole numbers, x0, y0, x1, y1");
    const auto get = [&](size_t k) { return int(ends[k].integer(0, kMaxPictureSize)); };
    s.image.crop = {get(0), get(1), get(2), get(3)};
    if (s.image.crop.x0 >= s.image.crop.x1 || s.image.crop.y0 >= s.image.crop.y1)
        value.refuse("a window with x0 < x1 and y0 < y1");
}

void read_background(const Argument& value, RenderSettings& s) {
    s.image.background = Vec3f{};
    if (!value.is_text())
        s.image.background = value.vector("\"transparent\", or three numbers, linear red, green and blue");
    else if (value.text() != "transparent")
        value.refuse("\"transparent\", or three numbers, linear red, green and blue");
}

void read_level(const Argument& value, RenderSettings& s) {
    if (value.is_text() && value.text() == "auto")
        s.surface.level = kAutoLevel;
    else
        s.surface.level = int(value.integer(0, kMaxLevel));
}

void read_traversal(const Argument& value, RenderSettings& s) {
    std::vector<std::string_view> names;
    for (size_t k = 0; k < kTraversalCount; ++k) names.emplace_back(traversal_name(TraversalKind(k)));
    s.experiment.traversal = TraversalKind(value.word(names));
}

constexpr Keyword kKeywords[] = {
    {"size", "image.width and image.height", false, read_size},
    {"spp", "image.spp", false,
     [](const Argument& v, RenderSettings& s) { s.image.spp = int(v.integer(1, kMaxSamples)); }},
    {"bounces", "image.bounces", false,
     [](const Argument& v, RenderSettings& s) { s.image.bounces = int(v.integer(0, kMaxBounces)); }},
    {"seed", "image.seed", false,
     [](const Argument& v, RenderSettings& s) {
         s.image.seed = uint32_t(v.integer(0, std::numeric_limits<uint32_t>::max()));
     }},
    {"noise", "image.noise", false,
     [](const Argument& v, RenderSettings& s) { s.image.noise = float(v.number(0, 1)); }},
    {"time_limit", "image.time_limit_s", false,
     [](const Argument& v, RenderSettings& s) { s.image.time_limit_s = v.number(0, 1e9); }},
    {"detail_height", "image.detail_height", false,
     [](const Argument& v, RenderSettings& s) {
         s.image.detail_height = int(v.integer(0, kMaxPictureSize));
     }},
    {"clamp_indirect", "image.clamp_indirect", false,
     [](const Argument& v, RenderSettings& s) { s.image.clamp_indirect = float(v.number(0, 1e9)); }},
    {"background", "image.background", false, read_background},
    {"crop", "image.crop", false, read_crop},
    {"first_sample", "image.first_sample", false,
     [](const Argument& v, RenderSettings& s) { s.image.first_sample = int(v.integer(0, 1 << 30)); }},
    {"layers", "image.layers", false,
     [](const Argument& v, RenderSettings& s) { s.image.layers = v.texts(); }},
    {"mode", "surface.mode", true,
     [](const Argument& v, RenderSettings& s) {
         s.surface.mode = SurfaceMode(v.word(std::array<std::string_view, 2>{"direct", "tessellated"}));
     }},
    {"level", "surface.level", true, read_level},
    {"pixel_error", "surface.pixel_error", true,
     [](const Argument& v, RenderSettings& s) { s.surface.pixel_error = float(v.number(1e-3, 1e3)); }},
    {"lod", "surface.lod", true,
     [](const Argument& v, RenderSettings& s) {
         s.surface.lod = LodRule(v.word(std::array<std::string_view, 2>{"field", "ray"}));
     }},
    {"bounce_levels", "surface.bounce_levels", true,
     [](const Argument& v, RenderSettings& s) {
         s.surface.bounce_levels = BounceLevels(v.word(std::array<std::string_view, 2>{"auto", "camera"}));
     }},
    {"leaf", "surface.leaf", true,
     [](const Argument& v, RenderSettings& s) {
         s.surface.leaf = LeafKind(v.word(std::array<std::string_view, 2>{"exact", "box"}));
     }},
    {"cache_mb", "surface.cache_bytes", true,
     [](const Argument& v, RenderSettings& s) {
         s.surface.cache_bytes = size_t(v.integer(0, 1 << 20)) << 20;
     }},
    {"engine", "device.engine", true,
     [](const Argument& v, RenderSettings& s) {
         s.device.engine = EngineKind(v.word(std::array<std::string_view, 2>{"cpu", "vulkan"}));
     }},
    {"device", "device.index", true,
     [](const Argument& v, RenderSettings& s) { s.device.index = int(v.integer(0, 255)); }},
    {"pipeline_cache", "device.pipeline_cache", true,
     [](const Argument& v, RenderSettings& s) { s.device.pipeline_cache = v.path(); }},
    {"threads", "device.threads", true,
     [](const Argument& v, RenderSettings& s) { s.device.threads = int(v.integer(0, kMaxThreads)); }},
    {"isa", "device.isa", true,
     [](const Argument& v, RenderSettings& s) {
         s.device.isa =
             Isa(v.word(std::array<std::string_view, 6>{"best", "avx512", "avx2", "sse4", "neon", "scalar"}));
     }},
    {"structure", "experiment.structure", true,
     [](const Argument& v, RenderSettings& s) {
         s.experiment.structure =
             StructureKind(v.word(std::array<std::string_view, 3>{"bvh", "lbvh", "kdtree"}));
     }},
    {"traversal", "experiment.traversal", true, read_traversal},
    {"method", "experiment.method", true,
     [](const Argument& v, RenderSettings& s) {
         s.experiment.method =
             RenderMethod(v.word(std::array<std::string_view, 3>{"compute", "fragment", "hybrid"}));
     }},
    {"bottom", "experiment.bottom", true,
     [](const Argument& v, RenderSettings& s) {
         s.experiment.bottom = BottomForm(v.word(std::array<std::string_view, 3>{"auto", "fused", "split"}));
     }},
};

/// Of messages alone.
constexpr std::pair<std::string_view, std::string_view> kOtherNames[] = {
    {"image.width", "size"},
    {"image.height", "size"},
    {"vulkan_devices()", "relief.devices()"},
    {"available_isas()", "relief.isas()"}};

const Keyword& find_keyword(const std::string& name, bool is_of_rays) {
    std::vector<std::string_view> known;
    for (const Keyword& keyword : kKeywords) {
        if (is_of_rays && !keyword.is_of_rays) continue;
        if (keyword.name == name) return keyword;
        known.push_back(keyword.name);
    }
    throw Error(ErrorKind::usage,
                {fmt::format("there is no keyword '{}'", name), "", suggest_word(name, known)});
}

void read_keywords(const nb::dict& keywords, bool is_of_rays, RenderSettings& settings) {
    for (const auto& [key, value] : keywords) {
        const std::string name = nb::cast<std::string>(nb::str(key));
        const Keyword& keyword = find_keyword(name, is_of_rays);
        if (!value.is_none()) keyword.read(Argument(name, value), settings);
    }
}

void replace_name(std::string_view name, std::string_view by, std::string& text) {
    for (size_t at = 0; (at = cli::find_whole_name(text, name, at)) != std::string::npos; at += by.size())
        text.replace(at, name.size(), by);
}

} // namespace

RenderSettings read_settings(const nb::dict& keywords, const PictureDefaults& picture) {
    RenderSettings settings;
    ImageSettings& image = settings.image;
    image.width = picture.width.value_or(image.width), image.height = picture.height.value_or(image.height);
    image.spp = picture.spp.value_or(image.spp), image.bounces = picture.bounces.value_or(image.bounces);
    image.seed = picture.seed.value_or(image.seed);
    read_keywords(keywords, false, settings);
    return settings;
}

IntersectorSettings read_ray_settings(const nb::dict& keywords) {
    RenderSettings settings;
    nb::dict others;
    IntersectorSettings rays;
    for (const auto& [key, value] : keywords) {
        if (nb::cast<std::string>(nb::str(key)) != "picture_height")
            others[key] = value;
        else if (!value.is_none())
            rays.picture_height = int(Argument("picture_height", value).integer(1, kMaxPictureSize));
    }
    read_keywords(others, true, settings);
    rays.surface = settings.surface, rays.device = settings.device, rays.experiment = settings.experiment;
    return rays;
}

std::string name_keywords(std::string text) {
    for (const Keyword& keyword : kKeywords) replace_name(keyword.setting, keyword.name, text);
    for (const auto& [name, by] : kOtherNames) replace_name(name, by, text);
    return cli::name_map_keys(std::move(text));
}

} // namespace relief::python
