// From linear Rec.709 colours to what a display shows.
#pragma once

#include <memory>
#include <optional>
#include <string_view>

#include "relief/image.h"
#include "relief/types.h"

namespace relief {

class ColorTransform;

/// `agx` (Sobotka 2022): log curve on inset primaries; strong colours keep their hue and fade to white.
/// `aces`: the output transform of ACES 1.0 for SDR video, by OpenColorIO; middle grey shows darker. `filmic`
/// (Hill 2015, a fit of ACES that keeps middle grey): strong colours shift. `standard`: clipped at 1. `raw`:
/// clipped, and not encoded for a display.
enum class DisplayTransform { agx, aces, filmic, standard, raw };

/// Names of all transforms, in the order of the enumeration.
inline constexpr std::string_view kDisplayTransforms[] = {"agx", "aces", "filmic", "standard", "raw"};

/// How a picture is shown: its header entries `relief:display`, `relief:exposure` (EV, or `auto`),
/// `relief:background` (`transparent`, or `#rrggbb` in sRGB) and `relief:png_bits` (8 or 16).
struct DisplaySettings {
    DisplayTransform transform = DisplayTransform::agx;
    float factor = 1; ///< of linear colours, 2^EV
    bool is_transparent = false;
    std::optional<Vec3f> background;            ///< as shown, sRGB values in [0, 1]
    int bits = 8;                               ///< of a value in a PNG file
    std::shared_ptr<const ColorTransform> aces; ///< of that transform alone
};

/// Reads the header entries; what is missing or malformed has its default. Throws Error{failed} where the
/// libraries of `aces` cannot be loaded.
DisplaySettings read_display_settings(const Image& image);

/// sRGB values in [0, 1] of a linear colour, of `raw` linear ones. Negative and NaN components count as 0,
/// infinite ones as 1.
Vec3f show_color(const Vec3f& linear, const DisplaySettings& settings);

/// Estimates the result of show_color() in less time for AgX: each value is at most kEstimateTolerance away.
Vec3f estimate_color(const Vec3f& linear, const DisplaySettings& settings);
inline constexpr float kEstimateTolerance = 5e-6f;

/// EV at which the geometric mean of the luminances, of pixels that hit something if there are any, becomes
/// middle grey (0.18); within [-16, 16], 0 for a black picture.
float find_exposure(const Image& image);

} // namespace relief
