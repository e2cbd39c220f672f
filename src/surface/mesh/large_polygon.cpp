#include "surface/mesh/large_polygon.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <utility>

namespace relief {

namespace {

using PlanePoint = Vec2<double>;

/// Reflex corners by cells of a grid, about one corner a cell.
class ReflexGrid {
  public:
    explicit ReflexGrid(std::span<const PlanePoint> polygon) : lower_(polygon[0]), upper_(polygon[0]) {
        for (const PlanePoint& p : polygon) {
            lower_ = {std::min(lower_.x, p.x), std::min(lower_.y, p.y)};
            upper_ = {std::max(upper_.x, p.x), std::max(upper_.y, p.y)};
        }
        side_ = std::max(1, int(std::sqrt(double(polygon.size()))));
        cells_.resize(size_t(side_) * size_t(side_));
    }

    void add(const PlanePoint& p, uint32_t corner) { find_cell(p).push_back(corner), ++count_; }
    void remove(const PlanePoint& p, uint32_t corner) { std::erase(find_cell(p), corner), --count_; }

    /// True where `test` holds for a corner of the triangle's cells. Adds the cells looked at to `work`.
    template <class Test>
    bool any(const std::array<PlanePoint, 3>& triangle, size_t& work, const Test& test) const {
        if (count_ == 0) return false; // what is left is convex
        const auto [low, high] = std::minmax({triangle[0].y, triangle[1].y, triangle[2].y});
        const int last_row = locate(high, lower_.y, upper_.y);
        for (int y = locate(low, lower_.y, upper_.y); y <= last_row; ++y) {
            const auto [x0, x1] = find_columns(triangle, y);
            for (int x = x0; x <= x1; ++x, ++work)
                for (const uint32_t corner : cells_[size_t(y) * size_t(side_) + size_t(x)])
                    if (test(corner)) return true;
        }
        return false;
    }

  private:
    /// Columns that a triangle covers in a row, which is taken a little higher than it is.
    std::pair<int, int> find_columns(const std::array<PlanePoint, 3>& triangle, int row) const {
        const double step = (upper_.y - lower_.y) / side_, slack = 1e-6 * step;
        const double low = lower_.y + row * step - slack, high = lower_.y + (row + 1) * step + slack;
        double left = std::numeric_limits<double>::infinity(), right = -left;
        for (size_t k = 0; k < 3; ++k) {
            const PlanePoint &a = triangle[k], &b = triangle[(k + 1) % 3];
            if (std::max(a.y, b.y) < low || std::min(a.y, b.y) > high) continue;
            for (const double y : {low, high}) {
                const double part =
                    b.y == a.y ? 0
                               : (std::clamp(y, std::min(a.y, b.y), std::max(a.y, b.y)) - a.y) / (b.y - a.y);
                const double x = a.x + (b.x - a.x) * part;
                left = std::min(left, x), right = std::max(right, x);
            }
            if (a.y == b.y) left = std::min(left, b.x), right = std::max(right, b.x);
        }
        if (!(left <= right)) return {0, -1};
        const double margin = 1e-6 * (upper_.x - lower_.x) / side_;
        return {locate(left - margin, lower_.x, upper_.x), locate(right + margin, lower_.x, upper_.x)};
    }

    int locate(double value, double low, double high) const {
        if (!(high > low)) return 0;
        return std::clamp(int((value - low) / (high - low) * side_), 0, side_ - 1);
    }
    std::vector<uint32_t>& find_cell(const PlanePoint& p) {
        return cells_[size_t(locate(p.y, lower_.y, upper_.y)) * size_t(side_) +
                      size_t(locate(p.x, lower_.x, upper_.x))];
    }

    PlanePoint lower_, upper_;
    int side_;
    size_t count_ = 0;
    std::vector<std::vector<uint32_t>> cells_;
};

/// The corners that are left, as a ring.
class EarClipper {
  public:
    explicit EarClipper(std::span<const PlanePoint> polygon)
        : polygon_(polygon),
          grid_(polygon),
          previous_(polygon.size()),
          next_(polygon.size()),
          is_reflex_(polygon.size()),
          stamps_(polygon.size()) {
        const uint32_t size = uint32_t(polygon.size());
        for (uint32_t k = 0; k < size; ++k) previous_[k] = (k + size - 1) % size, next_[k] = (k + 1) % size;
        for (uint32_t k = 0; k < size; ++k) update(k);
    }

    /// A clipped ear changes the state of its two neighbours alone (O'Rourke 1998, Computational Geometry in
    /// C, section 1.6): these wait at the end, so that ears come from all around and stay compact.
    PolygonCut run() {
        uint32_t left = uint32_t(polygon_.size()), corner = 0;
        for (uint32_t k = 0; k < left; ++k) waiting_.push_back({k, 0});
        while (left > 3) {
            if (waiting_.empty()) { // the polygon crosses itself
                corner = clip(corner), --left;
                continue;
            }
            const auto [candidate, stamp] = waiting_.front();
            waiting_.pop_front();
            if (stamp != stamps_[candidate] || !is_ear(candidate)) continue;
            corner = clip(candidate), --left;
        }
        cut_.triangles.push_back({previous_[corner], corner, next_[corner]});
        return std::move(cut_);
    }

  private:
    double turn_at(uint32_t k) const {
        return compute_turn(polygon_[previous_[k]], polygon_[k], polygon_[next_[k]]);
    }

    void update(uint32_t k) {
        const bool is_reflex = !(turn_at(k) > 0);
        if (is_reflex == bool(is_reflex_[k])) return;
        is_reflex_[k] = is_reflex;
        if (is_reflex)
            grid_.add(polygon_[k], k);
        else
            grid_.remove(polygon_[k], k);
    }

    bool is_ear(uint32_t k) {
        if (is_reflex_[k]) return false;
        const PlanePoint &a = polygon_[previous_[k]], &b = polygon_[k], &c = polygon_[next_[k]];
        return !grid_.any({a, b, c}, cut_.work, [&](uint32_t other) {
            ++cut_.work;
            const PlanePoint& p = polygon_[other];
            if (p == a || p == b || p == c) return false;
            return compute_turn(a, b, p) >= 0 && compute_turn(b, c, p) >= 0 && compute_turn(c, a, p) >= 0;
        });
    }

    /// Returns a corner that is left.
    uint32_t clip(uint32_t k) {
        const uint32_t before = previous_[k], after = next_[k];
        cut_.triangles.push_back({before, k, after});
        if (is_reflex_[k]) grid_.remove(polygon_[k], k);
        next_[before] = after, previous_[after] = before;
        ++stamps_[k];
        for (const uint32_t neighbour : {before, after}) {
            update(neighbour);
            waiting_.push_back({neighbour, ++stamps_[neighbour]});
        }
        return after;
    }

    std::span<const PlanePoint> polygon_;
    ReflexGrid grid_;
    std::vector<uint32_t> previous_, next_;
    std::vector<uint8_t> is_reflex_;
    std::vector<uint32_t> stamps_; ///< of the last time that a corner was put to wait
    std::deque<std::pair<uint32_t, uint32_t>> waiting_;
    PolygonCut cut_;
};

} // namespace

PolygonCut cut_large_polygon(std::span<const PlanePoint> polygon) { return EarClipper(polygon).run(); }

} // namespace relief
