// What a displacement map is and which of the usual mistakes it shows.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "relief/inspect.h"
#include "surface/texels.h"

namespace relief {

namespace {

constexpr std::array<const char*, 3> kChannelNames = {"R", "G", "B"};
constexpr double kBorderTolerance = 0.01; // of the largest displacement

struct MapSurvey {
    std::array<double, 3> low{}, high{}, mean{};
    std::array<double, 3> border_low{}, border_high{};
    bool is_gray = true;           ///< R = G = B in every texel
    double unit_share = 0;         ///< share of texels that are unit vectors when read as a normal map
    bool has_bad_texel = false;    ///< NaN or infinity
    uint32_t bad_x = 0, bad_y = 0; ///< the first of them
    size_t bad_count = 0;
};

bool is_integer_type(SampleType type) {
    return type == SampleType::uint8 || type == SampleType::uint16 || type == SampleType::uint32;
}

const char* get_type_name(SampleType type) {
    switch (type) {
    case SampleType::uint8:
        return "8-bit integer";
    case SampleType::uint16:
        return "16-bit integer";
    case SampleType::uint32:
        return "32-bit integer";
    case SampleType::float16:
        return "16-bit float";
    case SampleType::float32:
        break;
    }
    return "32-bit float";
}

bool is_finite_texel(const std::array<float, 3>& texel) {
    return std::isfinite(texel[0]) && std::isfinite(texel[1]) && std::isfinite(texel[2]);
}

bool is_unit_normal(const std::array<float, 3>& texel) {
    double squared = 0;
    for (const float value : texel) squared += (2.0 * value - 1) * (2.0 * value - 1);
    return std::fabs(std::sqrt(squared) - 1) < 0.05;
}

void note_bad_texel(MapSurvey& survey, uint32_t x, uint32_t y) {
    if (!survey.has_bad_texel) survey.bad_x = x, survey.bad_y = y;
    survey.has_bad_texel = true;
    ++survey.bad_count;
}

MapSurvey survey_map(const Texture& texture) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    MapSurvey survey;
    survey.low.fill(kInfinity), survey.border_low.fill(kInfinity);
    survey.high.fill(-kInfinity), survey.border_high.fill(-kInfinity);
    size_t unit_count = 0;
    for (uint32_t y = 0; y < texture.height; ++y) {
        for (uint32_t x = 0; x < texture.width; ++x) {
            const std::array<float, 3> texel = read_texel(texture, x, y);
            if (!is_finite_texel(texel)) {
                note_bad_texel(survey, x, y);
                continue;
            }
            const bool is_border = x == 0 || y == 0 || x + 1 == texture.width || y + 1 == texture.height;
            for (size_t c = 0; c < 3; ++c) {
                const double value = texel[c];
                survey.low[c] = std::min(survey.low[c], value),
                survey.high[c] = std::max(survey.high[c], value);
                survey.mean[c] += value;
                if (!is_border) continue;
                survey.border_low[c] = std::min(survey.border_low[c], value);
                survey.border_high[c] = std::max(survey.border_high[c], value);
            }
            survey.is_gray &= texel[0] == texel[1] && texel[1] == texel[2];
            unit_count += is_unit_normal(texel);
        }
    }
    const double good = double(size_t(texture.width) * texture.height - survey.bad_count);
    for (double& mean : survey.mean) mean = good > 0 ? mean / good : 0;
    survey.unit_share = good > 0 ? double(unit_count) / good : 0;
    return survey;
}

/// The channel with the largest mean is usually the one along the normal: sculpts rise more than they slide.
std::string guess_normal_channel(const MapSurvey& survey, double midlevel) {
    std::array<double, 3> strength{};
    for (size_t c = 0; c < 3; ++c) strength[c] = std::fabs(survey.mean[c] - midlevel);
    const size_t best = size_t(std::max_element(strength.begin(), strength.end()) - strength.begin());
    const double second = std::max(strength[(best + 1) % 3], strength[(best + 2) % 3]);
    const double ratio = second > 0 ? strength[best] / second : std::numeric_limits<double>::infinity();
    if (!(strength[best] > 0) || ratio < 1.5) return "not clear from the values";
    const char* axes = best == 0 ? "n,t,b or n,b,t" : best == 1 ? "t,n,b" : "t,b,n";
    return fmt::format("{} ({:.1f} x stronger mean), so probably axes {} in tangent space",
                       kChannelNames[best], ratio, axes);
}

void find_type_mistakes(const Texture& texture, std::vector<Finding>& findings) {
    if (texture.source_type == SampleType::uint8)
        findings.push_back(
            {Severity::warning, "W-8BIT",
             "8-bit map: one step is scale / 255, which shows as stairs; export 16 or 32 bit float "
             "EXR"});
    if (texture.source_type == SampleType::uint16 || texture.source_type == SampleType::uint32)
        findings.push_back(
            {Severity::warning, "W-INT16",
             "integer map: it can hold no negative values, so 0.5 is probably its midlevel; say "
             "midlevel and scale, or export float"});
}

void find_channel_mistakes(const Texture& texture, const MapSurvey& survey, std::vector<Finding>& findings) {
    if (texture.channel_count < 3)
        findings.push_back({Severity::warning, "W-1CH",
                            fmt::format("{} channel(s): a height map, not vectors; use type 'height'",
                                        texture.channel_count)});
    else if (survey.is_gray)
        findings.push_back({Severity::warning, "W-GRAY",
                            "R = G = B everywhere: a height map, not vectors; use type 'height'"});
    else if (texture.source_type == SampleType::uint8 && survey.mean[2] > 0.5 && survey.unit_share > 0.9)
        findings.push_back(
            {Severity::warning, "W-NORMALMAP",
             "unit vectors with B up: a normal map, not displacement; bake vector displacement"});
}

void find_border(const Texture& texture, const MapSurvey& survey, double midlevel,
                 std::vector<Finding>& findings) {
    if (texture.channel_count < 3 || survey.is_gray || survey.bad_count > 0) return;
    double largest = 0, offset = 0, spread = 0;
    for (size_t c = 0; c < 3; ++c) {
        largest =
            std::max({largest, std::fabs(survey.low[c] - midlevel), std::fabs(survey.high[c] - midlevel)});
        offset = std::max(offset, std::fabs(0.5 * (survey.border_low[c] + survey.border_high[c]) - midlevel));
        spread = std::max(spread, survey.border_high[c] - survey.border_low[c]);
    }
    if (offset <= kBorderTolerance * largest || spread > kBorderTolerance * largest) return;
    findings.push_back(
        {Severity::warning, "W-BORDER",
         fmt::format("the border is one constant away from {:g}: ({:.4g}, {:.4g}, {:.4g}); say it as "
                     "midlevel, or clear the background in the sculpting tool",
                     midlevel, survey.border_low[0], survey.border_low[1], survey.border_low[2])});
}

} // namespace

Inspection inspect_texture(const Texture& texture) {
    const MapSurvey survey = survey_map(texture);
    const double midlevel = is_integer_type(texture.source_type) ? 0.5 : 0;
    Inspection result;
    result.facts = {{"size", fmt::format("{} x {} texels", texture.width, texture.height)},
                    {"channels", fmt::format("{}", texture.channel_count)},
                    {"type", get_type_name(texture.source_type)},
                    {"memory", fmt::format("{} bytes", texture.byte_count())}};
    for (size_t c = 0; c < std::min<size_t>(3, texture.channel_count); ++c)
        result.facts.push_back({kChannelNames[c], fmt::format("{:.6g} to {:.6g}, mean {:.6g}", survey.low[c],
                                                              survey.high[c], survey.mean[c])});
    if (texture.channel_count >= 3 && !survey.is_gray)
        result.facts.push_back({"normal_channel", guess_normal_channel(survey, midlevel)});
    if (survey.bad_count > 0)
        result.findings.push_back(
            {Severity::error, "E-NAN",
             fmt::format("NaN or infinity in {} texel(s), the first at column {}, row {}; bake "
                         "the map again or repair it",
                         survey.bad_count, survey.bad_x, survey.bad_y)});
    find_type_mistakes(texture, result.findings);
    find_channel_mistakes(texture, survey, result.findings);
    find_border(texture, survey, midlevel, result.findings);
    return result;
}

} // namespace relief
