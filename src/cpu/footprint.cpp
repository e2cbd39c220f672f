#include "cpu/footprint.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace relief::cpu {

namespace {

/// Margin of boxes in voxels, far above the rounding errors of a ray's path through the grid.
constexpr double kMargin = 0.02;
constexpr float kNever = std::numeric_limits<float>::infinity();

struct Interval {
    double begin, end;
};

/// The part of a ray between planes 0 and `size` of one axis, with 1 / speed.
Interval clip(const Interval& part, double place, double reciprocal, double size) {
    if (std::isinf(reciprocal)) return place < 0 || place > size ? Interval{1, 0} : part;
    const double a = -place * reciprocal, b = (size - place) * reciprocal;
    return {std::max(part.begin, std::min(a, b)), std::min(part.end, std::max(a, b))};
}

} // namespace

VoxelGrid::VoxelGrid(const Box& bounds, size_t most_voxels) : bounds_(bounds) {
    std::array<double, 3> extent;
    double largest = 0;
    for (int axis = 0; axis < 3; ++axis) {
        origin_[axis] = get_component(bounds.lower, axis);
        extent[axis] = double(get_component(bounds.upper, axis)) - origin_[axis];
        largest = std::max(largest, extent[axis]);
    }
    // Flat boxes have fewer voxels than cubes of their length: ever smaller ones while there is room.
    for (double voxel = largest; voxel > 0; voxel *= 0.9) {
        std::array<int, 3> size;
        for (int axis = 0; axis < 3; ++axis) size[axis] = std::max(1, int(extent[axis] / voxel));
        if (size_t(size[0] + 2) * size_t(size[1] + 2) * size_t(size[2] + 2) > most_voxels) break;
        size_ = size;
    }
    for (int axis = 0; axis < 3; ++axis)
        voxels_per_length_[axis] = extent[axis] > 0 ? size_[axis] / extent[axis] : 0;
}

Footprint::Footprint(const VoxelGrid& grid) : grid_(&grid), words_((grid.voxel_count() + 63) / 64) {}

void Footprint::clear() { std::fill(words_.begin(), words_.end(), 0); }

bool Footprint::meets(const Footprint& other, std::span<const uint32_t> words) const {
    return std::any_of(words.begin(), words.end(),
                       [&](uint32_t word) { return (words_[word] & other.words_[word]) != 0; });
}

std::vector<uint32_t> Footprint::find_used_words() const {
    std::vector<uint32_t> used;
    for (size_t k = 0; k < words_.size(); ++k)
        if (words_[k] != 0) used.push_back(uint32_t(k));
    return used;
}

std::array<int, 3> Footprint::find_strides() const {
    const int row = grid_->size_[0] + 2;
    return {1, row, row * (grid_->size_[1] + 2)};
}

void Footprint::add_ray(const Vec3f& origin, const Vec3f& direction, float t_end) {
    double place[3], speed[3], reciprocal[3], fastest = 0; // in voxels
    Interval part{0, t_end};
    for (int axis = 0; axis < 3; ++axis) {
        const double scale = grid_->voxels_per_length_[axis];
        place[axis] = (get_component(origin, axis) - grid_->origin_[axis]) * scale;
        speed[axis] = get_component(direction, axis) * scale;
        reciprocal[axis] = 1 / speed[axis];
        fastest = std::max(fastest, std::fabs(speed[axis]));
        part = clip(part, place[axis], reciprocal[axis], grid_->size_[axis]);
    }
    if (!(part.begin <= part.end)) return;
    if (fastest == 0) part.end = part.begin; // it stays where it is
    // From here on distances along the ray count from its entry, in voxels of its fastest axis.
    const float end = float((part.end - part.begin) * fastest);
    std::array<int, 3> stride = find_strides();
    std::array<float, 3> next, delta;
    int voxel = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const bool is_falling = speed[axis] < 0;
        const float entry = float(place[axis] + part.begin * speed[axis]);
        const int slot = std::clamp(int(entry), 0, grid_->size_[axis] - 1);
        voxel += (slot + 1) * stride[axis];
        const bool is_still = std::isinf(reciprocal[axis]);
        delta[axis] = is_still ? kNever : float(fastest * std::fabs(reciprocal[axis]));
        next[axis] =
            is_still ? kNever : (is_falling ? entry - float(slot) : float(slot + 1) - entry) * delta[axis];
        if (is_falling) stride[axis] = -stride[axis];
    }
    mark_line({next, delta, stride, voxel, end});
}

/// No branch but the end of the line: which axis is next is unpredictable.
void Footprint::mark_line(const Line& line) {
    float next_x = line.next[0], next_y = line.next[1], next_z = line.next[2];
    const float delta_x = line.delta[0], delta_y = line.delta[1], delta_z = line.delta[2];
    const int stride_x = line.stride[0], stride_y = line.stride[1], stride_z = line.stride[2];
    uint64_t* const words = words_.data();
    for (int voxel = line.voxel;;) {
        words[size_t(voxel) / 64] |= uint64_t(1) << (size_t(voxel) % 64);
        const float nearest = std::min(next_x, std::min(next_y, next_z));
        if (!(nearest <= line.end)) return;
        const bool is_x = next_x == nearest, is_y = next_y == nearest, is_z = next_z == nearest;
        voxel += (is_x ? stride_x : 0) + (is_y ? stride_y : 0) + (is_z ? stride_z : 0);
        next_x += is_x ? delta_x : 0.0f, next_y += is_y ? delta_y : 0.0f, next_z += is_z ? delta_z : 0.0f;
    }
}

bool Footprint::add_box(const Box& box) {
    if (box.is_empty()) return true;
    if (!grid_->bounds_.contains(box)) return false;
    const std::array<int, 3> stride = find_strides();
    int first[3], last[3];
    for (int axis = 0; axis < 3; ++axis) {
        const double scale = grid_->voxels_per_length_[axis], origin = grid_->origin_[axis];
        // One on for the voxels around, of which a ray may have got into the nearest by rounding.
        first[axis] = int(std::floor((get_component(box.lower, axis) - origin) * scale - kMargin)) + 1;
        last[axis] = int(std::floor((get_component(box.upper, axis) - origin) * scale + kMargin)) + 1;
        last[axis] = std::min(last[axis], grid_->size_[axis] + 1);
    }
    for (int z = first[2]; z <= last[2]; ++z)
        for (int y = first[1]; y <= last[1]; ++y)
            for (int x = first[0]; x <= last[0]; ++x)
                add(size_t(x) + size_t(y) * size_t(stride[1]) + size_t(z) * size_t(stride[2]));
    return true;
}

} // namespace relief::cpu
