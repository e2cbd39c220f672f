// What the channels of the layer shadow say of alpha: for films, and for merged pictures.
#pragma once

#include <algorithm>

namespace relief {

/// Channels of the layer shadow: how many samples met a shadow catcher; the light of those as it arrived, and
/// without what was in its way.
inline constexpr const char* kShadowChannels[] = {"shadow.C", "shadow.L", "shadow.U"};

/// Alpha of the shadow, from sums or from means: a quotient of sums, which no sample has to know the whole
/// of. Where no light comes from, nothing is taken.
inline double find_shadow_alpha(double caught, double lit, double unlit) {
    return unlit > 0 ? caught * std::clamp(1 - lit / unlit, 0.0, 1.0) : 0;
}

} // namespace relief
