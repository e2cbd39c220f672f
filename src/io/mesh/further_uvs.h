// Fills Mesh::further_uvs corner by corner.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "io/mesh/welder.h"
#include "relief/io.h"

namespace relief {

class FurtherUvs {
  public:
    explicit FurtherUvs(const MeshReadOptions& options) {
        for (const int number : options.further_uv_sets)
            if (number != options.uv_set && std::ranges::find(numbers_, number) == numbers_.end())
                numbers_.push_back(number);
        sets_.resize(numbers_.size());
        for (size_t n = 0; n < sets_.size(); ++n) sets_[n].number = numbers_[n];
        for (UvSet& set : sets_) welders_.emplace_back(set.uvs);
    }
    FurtherUvs(const FurtherUvs&) = delete;
    FurtherUvs& operator=(const FurtherUvs&) = delete;

    /// Of the sets that are wanted, each once.
    std::span<const int> numbers() const { return numbers_; }

    /// The next corner, in set numbers()[n].
    void add_corner(size_t n, const Vec2f& uv) { sets_[n].indices.push_back(welders_[n].add(uv)); }
    void add_corner_without(size_t n) { sets_[n].indices.push_back(kNoIndex); }

    /// Those that some face has.
    std::vector<UvSet> take() {
        std::erase_if(sets_, [](const UvSet& set) { return set.uvs.empty(); });
        return std::move(sets_);
    }

  private:
    std::vector<int> numbers_;
    std::vector<UvSet> sets_;
    std::vector<UvWelder> welders_; ///< of the sets
};

} // namespace relief
