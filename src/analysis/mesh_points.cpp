#include "analysis/mesh_points.h"

#include <array>
#include <bit>
#include <unordered_map>

namespace relief {

namespace {

template <size_t kSize> using Key = std::array<uint32_t, kSize>;

template <size_t kSize> struct KeyHash {
    size_t operator()(const Key<kSize>& key) const {
        uint64_t hash = 0x9e3779b97f4a7c15ull;
        for (const uint32_t word : key) {
            hash = (hash ^ word) * 0xbf58476d1ce4e5b9ull;
            hash ^= hash >> 29;
        }
        return size_t(hash);
    }
};

/// Bits that are the same for equal numbers: -0 counts as 0.
uint32_t to_bits(float value) { return std::bit_cast<uint32_t>(value + 0.0f); }

template <size_t kSize, class MakeKey>
std::vector<uint32_t> number_corners(const Mesh& mesh, const MakeKey& make_key) {
    std::unordered_map<Key<kSize>, uint32_t, KeyHash<kSize>> numbers;
    std::vector<uint32_t> result;
    result.reserve(mesh.position_indices.size());
    for (size_t corner = 0; corner < mesh.position_indices.size(); ++corner)
        result.push_back(numbers.try_emplace(make_key(corner), uint32_t(numbers.size())).first->second);
    return result;
}

} // namespace

std::vector<uint32_t> number_points(const Mesh& mesh, const JoinedPoints& joined) {
    return number_corners<1>(
        mesh, [&](size_t corner) { return Key<1>{joined.representatives[mesh.position_indices[corner]]}; });
}

std::vector<uint32_t> number_uv_points(const Mesh& mesh) {
    const std::vector<uint32_t> points = number_points(mesh, join_points(mesh));
    return number_corners<3>(mesh, [&](size_t corner) {
        const Vec2f& uv = mesh.uvs[mesh.uv_indices[corner]];
        return Key<3>{points[corner], to_bits(uv.x), to_bits(uv.y)};
    });
}

} // namespace relief
