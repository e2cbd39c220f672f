// Points of a mesh that become one, set by set.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

namespace relief {

/// Sets of points that have become one; the lowest number stands for all.
class PointSets {
  public:
    explicit PointSets(std::vector<uint32_t> representatives) : parents_(std::move(representatives)) {}

    uint32_t find(uint32_t point) {
        while (parents_[point] != point) point = parents_[point] = parents_[parents_[point]];
        return point;
    }
    void join(uint32_t a, uint32_t b) {
        a = find(a), b = find(b);
        parents_[std::max(a, b)] = std::min(a, b);
    }

  private:
    std::vector<uint32_t> parents_;
};

} // namespace relief
