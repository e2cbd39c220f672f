#include "prepare/light_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <utility>

#include "formulas/constants.h"

namespace relief {

namespace {

constexpr double kPi = std::numbers::pi;
constexpr size_t kBinCount = 12; ///< places to split at, an axis

/// So much wider are cones than they need to be, in radians: walks add up angles in single precision.
constexpr double kConeMargin = 1e-4;
/// The same of the cosine of how far lights shine: of a narrow cone the cosine says little.
constexpr double kReachMargin = 1e-5;
/// The same of spheres, relative to their size and to their distance from the origin.
constexpr double kRadiusMargin = 1e-5, kPlaceMargin = 1e-6;

Vec3<double> to_doubles(const Vec3f& v) { return {v.x, v.y, v.z}; }
Vec3f to_floats(const Vec3<double>& v) { return {float(v.x), float(v.y), float(v.z)}; }

/// Unit vector a turned by an angle towards b; no turn where both point the same or opposite ways.
Vec3f turn_towards(const Vec3f& a, const Vec3f& b, double angle) {
    const Vec3<double> from = to_doubles(a), to = to_doubles(b);
    const Vec3<double> aside = to - from * dot(from, to);
    const double size = std::sqrt(dot(aside, aside));
    if (!(size > 0)) return a;
    return normalize(to_floats(from * std::cos(angle) + aside * (std::sin(angle) / size)));
}

/// Lights that are together, before they are a node.
struct Group {
    Box box;
    LightCone cone;
    double power = 0;
    uint32_t flags = 0;

    bool is_empty() const { return power == 0; }
    void add(const Box& other_box, const LightCone& other_cone, double other_power, uint32_t other_flags) {
        cone = is_empty() ? other_cone : join_cones(cone, other_cone);
        box.extend(other_box);
        power += other_power;
        flags |= other_flags;
    }
    void add(const LightLeaf& leaf) { add(leaf.box, leaf.cone, double(leaf.power), leaf.flags); }
    void add(const Group& other) {
        if (!other.is_empty()) add(other.box, other.cone, other.power, other.flags);
    }
};

/// Solid angle of the ways into which lights shine, weighed by the cosine beyond those that they face (Conty
/// Estevez and Kulla 2018, section 4.3).
double measure_cone(const LightCone& cone) {
    const double spread = cone.spread, outer = std::min(spread + cone.reach, kPi);
    return 2 * kPi * (1 - std::cos(spread)) +
           kPi / 2 *
               (2 * outer * std::sin(spread) - std::cos(spread - 2 * outer) - 2 * spread * std::sin(spread) +
                std::cos(spread));
}

double measure_size(const Box& box) {
    const Vec3<double> extent = to_doubles(box.extent());
    return dot(extent, extent);
}

/// Of a sphere about the centre of a box that holds it, 0 of a single point.
float find_radius(const Box& box) {
    const double radius = std::sqrt(measure_size(box)) / 2;
    const Vec3f center = box.center();
    const float farthest = std::max({std::fabs(center.x), std::fabs(center.y), std::fabs(center.z)});
    return radius > 0 ? float(radius * (1 + kRadiusMargin) + double(farthest) * kPlaceMargin) : 0.0f;
}

/// What a group costs in draws that bring little. `whole` is a size that keeps lights at one place, or on a
/// line, comparable.
double find_cost(const Group& group, double whole) {
    if (group.is_empty()) return 0;
    return group.power * (measure_cone(group.cone) + 1e-3) * (measure_size(group.box) + 1e-6 * whole);
}

class Builder {
  public:
    explicit Builder(std::vector<LightLeaf>& leaves) {
        if (!leaves.empty()) nodes_.reserve(2 * leaves.size() - 1), add({leaves});
    }
    std::vector<scalar::LightNodeData> take() { return std::move(nodes_); }

  private:
    /// Nodes of these leaves; what they are together.
    Group add(std::span<LightLeaf> leaves) {
        const size_t place = nodes_.size();
        nodes_.emplace_back();
        Group group;
        if (leaves.size() == 1) {
            group.add(leaves.front());
        } else {
            const size_t first_count = split(leaves);
            group = add(leaves.first(first_count));
            group.add(add(leaves.subspan(first_count)));
        }
        write(group, leaves.size() == 1 ? leaves.front().source : scalar::kNone, nodes_[place]);
        nodes_[place].end = uint32_t(nodes_.size());
        return group;
    }

    static void write(const Group& group, uint32_t source, scalar::LightNodeData& node) {
        node.center = group.box.center();
        node.radius = find_radius(group.box);
        node.axis = group.cone.axis;
        const double spread = std::min(group.cone.spread + kConeMargin, kPi);
        node.spread_cosine = spread == kPi ? -1.0f : float(std::cos(spread));
        node.spread_sine = spread == kPi ? 0.0f : float(std::sin(spread));
        node.reach_cosine = float(std::cos(group.cone.reach) - kReachMargin);
        node.power = float(group.power);
        node.source = source;
        node.flags = group.flags;
    }

    /// Puts the leaves of the first child in front; their number, neither 0 nor that of all.
    static size_t split(std::span<LightLeaf> leaves) {
        Box centers, whole;
        for (const LightLeaf& leaf : leaves) centers.extend(leaf.box.center()), whole.extend(leaf.box);
        const Vec3f extent = centers.extent();
        const float longest = std::max({extent.x, extent.y, extent.z});
        double best = std::numeric_limits<double>::infinity();
        int best_axis = 0;
        size_t best_bin = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const float length = get_component(extent, axis);
            if (!(length > 0)) continue;
            const Bins bins(leaves, centers, axis);
            for (size_t k = 1; k < kBinCount; ++k) {
                // Thin boxes are rather split along their length.
                const double cost = bins.find_split_cost(k, measure_size(whole)) * double(longest / length);
                if (cost < best) best = cost, best_axis = axis, best_bin = k;
            }
        }
        const auto is_first = [&](const LightLeaf& leaf) {
            return find_bin(leaf, centers, best_axis) < best_bin;
        };
        const auto middle = std::partition(leaves.begin(), leaves.end(), is_first);
        const size_t count = size_t(middle - leaves.begin());
        // All in one place.
        return count == 0 || count == leaves.size() ? leaves.size() / 2 : count;
    }

    static size_t find_bin(const LightLeaf& leaf, const Box& centers, int axis) {
        const float low = get_component(centers.lower, axis), length = get_component(centers.extent(), axis);
        const float place = (get_component(leaf.box.center(), axis) - low) / length * float(kBinCount);
        return place > 0 ? std::min(size_t(place), kBinCount - 1) : 0;
    }

    struct Bins {
        std::array<Group, kBinCount> groups;
        Bins(std::span<const LightLeaf> leaves, const Box& centers, int axis) {
            for (const LightLeaf& leaf : leaves) groups[find_bin(leaf, centers, axis)].add(leaf);
        }
        /// Infinite where one side is empty.
        double find_split_cost(size_t first_of_second, double whole) const {
            Group first, second;
            for (size_t k = 0; k < kBinCount; ++k) (k < first_of_second ? first : second).add(groups[k]);
            if (first.is_empty() || second.is_empty()) return std::numeric_limits<double>::infinity();
            return find_cost(first, whole) + find_cost(second, whole);
        }
    };

    std::vector<scalar::LightNodeData> nodes_;
};

} // namespace

LightCone join_cones(const LightCone& a, const LightCone& b) {
    if (b.spread > a.spread) return join_cones(b, a);
    const double reach = std::max(a.reach, b.reach);
    if (a.spread >= kPi) return {a.axis, kPi, reach};
    const Vec3<double> p = to_doubles(a.axis), q = to_doubles(b.axis);
    const Vec3<double> aside = cross(p, q);
    const double between = std::atan2(std::sqrt(dot(aside, aside)), dot(p, q));
    if (std::min(between + b.spread, kPi) <= a.spread) return {a.axis, a.spread, reach};
    const double spread = (a.spread + between + b.spread) / 2;
    // Opposite ways have no plane to turn in.
    if (spread >= kPi || between > kPi - 1e-6) return {a.axis, kPi, reach};
    return {turn_towards(a.axis, b.axis, spread - a.spread), spread, reach};
}

std::vector<scalar::LightNodeData> make_light_tree(std::vector<LightLeaf> leaves) {
    return Builder(leaves).take();
}

} // namespace relief
