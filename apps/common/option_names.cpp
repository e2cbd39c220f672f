#include "common/option_names.h"

#include <array>
#include <string_view>

#include "common/whole_names.h"

namespace relief::cli {

namespace {

struct OptionName {
    std::string_view setting, option;
};

/// An entry that contains another one precedes it.
constexpr std::array<OptionName, 39> kOptions{{
    {"image.width and image.height", "--size"},
    {"image.spp", "--spp"},
    {"image.bounces", "--bounces"},
    {"image.clamp_indirect", "--clamp-indirect"},
    {"image.noise", "--noise"},
    {"image.background", "--background"},
    {"image.time_limit_s", "--time-limit"},
    {"image.seed", "--seed"},
    {"image.crop", "--crop"},
    {"image.first_sample", "--samples"},
    {"image.layers", "--layers"},
    {"surface.mode", "--surface"},
    {"surface.level", "--level"},
    {"surface.pixel_error", "--pixel-error"},
    {"surface.lod", "--lod"},
    {"surface.bounce_levels", "--bounce-levels"},
    {"surface.leaf", "--leaf"},
    {"surface.cache_bytes", "--bottom-cache"},
    {"device.engine", "--engine"},
    {"device.index", "--device"},
    {"device.threads", "--threads"},
    {"device.isa", "--isa"},
    {"experiment.structure", "--structure"},
    {"experiment.traversal", "--traversal"},
    {"experiment.method", "--method"},
    {"experiment.bottom", "--bottom"},
    {"displacement.scale", "--vdm-scale"},
    {"displacement.filter", "--filter"},
    {"displacement.type", "--type"},
    {"displacement.space", "--space"},
    {"displacement.axes", "--axes"},
    {"displacement.midlevel", "--midlevel"},
    {"displacement.encoding", "--encoding"},
    {"displacement.wrap", "--wrap"},
    {"mesh.weld", "--weld"},
    {"image.width", "--size"},
    {"image.height", "--size"},
    {"vulkan_devices()", "`relief devices`"},
    {"available_isas()", "`relief devices`"},
}};

void replace_name(std::string& text, const OptionName& name) {
    constexpr std::string_view kEquals = " = ";
    for (size_t at = 0; (at = find_whole_name(text, name.setting, at)) != std::string::npos;) {
        const size_t end = at + name.setting.size();
        const bool has_value = std::string_view(text).substr(end).starts_with(kEquals);
        std::string option(name.option);
        if (has_value) option += ' ';
        text.replace(at, name.setting.size() + (has_value ? kEquals.size() : 0), option);
        at += option.size();
    }
}

} // namespace

std::string name_options(std::string text) {
    for (const OptionName& name : kOptions) replace_name(text, name);
    return text;
}

} // namespace relief::cli
