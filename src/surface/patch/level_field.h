// Levels from the size on the screen: one level an edge, so that neighbours agree wherever they meet.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "surface/patch/line_points.h"
#include "surface/patch/surface.h"

namespace relief {

struct LevelFieldConfig {
    int fixed_level = -1;      ///< >= 0: this level everywhere
    float pixel_error = 1;     ///< cell size aimed at, pixels
    Vec3f camera{};            ///< world space
    float pixel_angle = 1e-3f; ///< size of a pixel at distance 1, scene units
};

/// One a patch; empty without displacement.
std::vector<PatchLines> measure_lines(const Surface& surface, const Affine& world_from_object);

/// Levels of all patches of one object, packed into one word a patch. Thread safe but for `update`.
class LevelField {
  public:
    /// The level of an edge depends on the edge alone (line, displaced length, transform, view; no map
    /// filter): the finest such that a cell is at most `pixel_error` pixels at the nearest point, at most one
    /// cell a texel (eight where the filter is smooth) and at most kMaxLevel. Undisplaced surfaces have level
    /// 0.
    static LevelField compute(const Surface& surface, const Affine& world_from_object,
                              const LevelFieldConfig& config);
    /// The same from the points of all patches, for surfaces that many objects show.
    static LevelField compute(const Surface& surface, std::span<const LinePoints> points,
                              const Affine& world_from_object, const LevelFieldConfig& config);

    /// The same from lines that were measured before, so that another view takes little time.
    static LevelField choose(const Surface& surface, std::span<const PatchLines> lines,
                             const LevelFieldConfig& config);

    /// Recomputes the levels of marked patches (a byte each) after a change of their displacement.
    void update(const Surface& surface, const Affine& world_from_object, const LevelFieldConfig& config,
                std::span<const uint8_t> is_changed);

    PatchLevels at(uint32_t patch) const { return unpack_levels(packed_at(patch)); }
    /// As pack_levels makes them.
    uint32_t packed_at(uint32_t patch) const { return packed_.empty() ? fixed_ : packed_[patch]; }
    /// All patches have the same levels.
    bool is_uniform() const { return packed_.empty(); }
    int max_level() const { return max_level_; }
    size_t byte_count() const { return packed_.size() * sizeof(uint32_t); }
    friend bool operator==(const LevelField&, const LevelField&) = default;

  private:
    template <class Find>
    static LevelField fill(const Surface& surface, const LevelFieldConfig& config, const Find& find_lines);
    void find_max_level();

    std::vector<uint32_t> packed_; ///< one a patch; empty: `fixed_` everywhere
    uint32_t fixed_ = 0;
    int max_level_ = 0;
};

} // namespace relief
