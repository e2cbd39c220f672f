// Features strewn over a body without overlap: warts, polyps. Found quickly from any point near the surface.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "samples/lathe.h"
#include "samples/noise.h"

namespace relief::samples {

struct Feature {
    Vec3f centre;
    Vec3f normal;      ///< of the body at the centre
    float radius = 0;  ///< of its disc on the surface
    uint32_t seed = 0; ///< for its own variation
};

/// A feature seen from a point inside its disc.
struct FeatureHit {
    const Feature* feature = nullptr;
    Vec3f outward; ///< unit, in the feature's tangent plane, from its centre to the point; 0 at the centre
    float q = 0;   ///< distance from the centre over the radius, [0, 1)
};

class Scatter {
  public:
    /// Radius wanted at a place, or nothing where no feature may be.
    using RadiusRule = std::function<std::optional<float>(const BodyPoint&, Random&)>;

    /// Throws `tries` darts at the body, keeps those that touch no earlier disc (Cook 1986).
    Scatter(const LatheBody& body, int tries, uint32_t seed, const RadiusRule& rule);

    /// The feature whose disc holds the point (at most one does).
    std::optional<FeatureHit> find(const Vec3f& p) const;

    size_t count() const { return features_.size(); }

  private:
    size_t cell_index(const Vec3f& p) const;

    static constexpr int kCells = 48; ///< of the look-up grid, a side
    Vec3f lower_;
    float cell_size_ = 1;
    std::vector<Feature> features_;
    std::vector<std::vector<uint32_t>> grid_; ///< features whose disc may reach into the cell
};

} // namespace relief::samples
