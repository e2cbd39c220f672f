// From linear Rec.709 colours to what a display shows.
#pragma once

#include <optional>
#include <string_view>

#include "relief/image.h"
#include "relief/types.h"

namespace relief {

/// `agx` (Sobotka 2022): log curve on inset primaries; strong colours keep their hue and fade to white.
/// `filmic` (Hill 2015, a fit of ACES): a curve a channel, strong colours shift. `standard`: clipped at 1.
enum class DisplayTransform { agx, filmic, standard };

/// Names of all transforms, in the order of the enumeration.
inline constexpr std::string_view kDisplayTransforms[] = {"agx", "filmic", "standard"};

/// How a picture is shown: its header entries `relief:display`, `relief:exposure` (EV, or `auto`) and
/// `relief:background` (`transparent`, or `#rrggbb` in sRGB).
struct DisplaySettings {
    DisplayTransform transform = DisplayTransform::agx;
    float factor = 1; ///< of linear colours, 2^EV
    bool is_transparent = false;
    std::optional<Vec3f> background; ///< as shown, sRGB values in [0, 1]
};

/// Reads the header entries; what is missing or malformed has its default.
DisplaySettings read_display_settings(const Image& image);

/// sRGB values in [0, 1] of a linear colour. Negative and NaN components count as 0, infinite ones as 1.
Vec3f show_colour(const Vec3f& linear, const DisplaySettings& settings);

/// EV at which the geometric mean of the luminances, of pixels that hit something if there are any, becomes
/// middle grey (0.18); within [-16, 16], 0 for a black picture.
float find_exposure(const Image& image);

} // namespace relief
