// Where rays have been, to within a voxel.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "math/box.h"

namespace relief::cpu {

/// Equal voxels over a box, with one more all around for rounding.
class VoxelGrid {
  public:
    /// Nearly cubes, at least one; with those around at most `most_voxels`, from 27 on. `bounds`: finite.
    VoxelGrid(const Box& bounds, size_t most_voxels);

    size_t voxel_count() const { return size_t(size_[0] + 2) * size_t(size_[1] + 2) * size_t(size_[2] + 2); }

  private:
    friend class Footprint;

    Box bounds_;
    std::array<int, 3> size_{1, 1, 1}; ///< without what is around
    std::array<double, 3> origin_{}, voxels_per_length_{};
};

/// A set of voxels of one grid, which outlives it. Used by one thread at a time.
class Footprint {
  public:
    explicit Footprint(const VoxelGrid& grid);

    /// The voxels that a ray is in on [0, t_end] (Amanatides and Woo 1987); what is outside of the grid's
    /// bounds is left out. Rounding may take a place close to a voxel's face for the other side.
    void add_ray(const Vec3f& origin, const Vec3f& direction, float t_end);

    /// The voxels that a box touches, and those so close that rounding might put a ray there. False, with
    /// nothing added, where it leaves the grid's bounds.
    bool add_box(const Box& box);

    void clear();
    /// `words` are those of `other` that hold anything.
    bool meets(const Footprint& other, std::span<const uint32_t> words) const;
    std::vector<uint32_t> find_used_words() const;
    size_t byte_count() const { return words_.size() * sizeof(uint64_t); }

  private:
    /// Distances to and between faces across each axis, voxel strides, first voxel, distance of the end.
    struct Line {
        std::array<float, 3> next, delta;
        std::array<int, 3> stride;
        int voxel;
        float end;
    };

    void mark_line(const Line& line);
    void add(size_t voxel) { words_[voxel / 64] |= uint64_t(1) << (voxel % 64); }
    std::array<int, 3> find_strides() const;

    const VoxelGrid* grid_ = nullptr;
    std::vector<uint64_t> words_;
};

} // namespace relief::cpu
