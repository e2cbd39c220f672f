// The display transform AgX (Sobotka 2022): exact, and about ten times faster by tables of its curves.
#pragma once

#include <array>
#include <cstdint>

#include "relief/types.h"

namespace relief {

/// Maps finite components that are not negative into [0, 1], where they are still linear.
Vec3f tone_map_agx(const Vec3f& linear);

/// The curve of AgX, and the one from its values to sRGB, with linear interpolation between entries.
class AgxTable {
  public:
    AgxTable();

    /// sRGB values of a colour with finite components that are not negative.
    Vec3f show(const Vec3f& linear) const;

  private:
    /// The curve has 256 entries per power of two, from 2^-13 to 2^5.
    static constexpr uint32_t kStepBits = 15; ///< bits of a float within an entry
    static constexpr uint32_t kFirstStep = (127 - 13) << 8, kBentCount = (18 << 8) + 1;
    static constexpr uint32_t kCodeCount = 4096;

    float find_bent(float x) const;
    float find_code(float x) const;

    float least_, most_; ///< ends of the curve
    std::array<float, kBentCount> bent_{};
    std::array<float, kCodeCount + 2> codes_{}; ///< the last entry is there twice
};

/// Made once.
const AgxTable& get_agx_table();

} // namespace relief
