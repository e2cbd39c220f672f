// make_displaced_mesh: the micro-quads of displaced surfaces as a plain mesh with shared vertices.
#include <array>
#include <memory>
#include <numeric>
#include <unordered_map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/machine.h"
#include "base/progress.h"
#include "math/affine.h"
#include "prepare/prepared_scene.h"
#include "relief/convert.h"
#include "relief/error.h"
#include "relief/render.h"
#include "surface/mesh/join_points.h"
#include "surface/patch/patch_samples.h"

namespace relief {

namespace {

/// Of one quad: its corners' two indices, its size, and about one vertex and one uv.
constexpr uint64_t kBytesPerQuad =
    4 * 2 * sizeof(uint32_t) + sizeof(uint32_t) + sizeof(Vec3f) + sizeof(Vec2f);

/// Adds one displaced object to a mesh.
class SurfaceCutter {
  public:
    SurfaceCutter(const Surface& surface, const Affine& world_from_object, int level, Mesh& mesh)
        : surface_(surface),
          world_from_object_(world_from_object),
          is_turned_(compute_determinant(world_from_object) < 0),
          side_(1u << level),
          mesh_(mesh) {
        const auto narrow = uint8_t(level);
        levels_ = {narrow, {narrow, narrow, narrow, narrow}};
    }

    void cut(ProgressCounter& counter) {
        for (uint32_t patch = 0; patch < surface_.patch_count(); ++patch) cut_patch(patch), counter.add(1);
    }

  private:
    void cut_patch(uint32_t patch) {
        const PatchSamples samples(surface_, patch);
        const size_t row_length = side_ + 1;
        std::vector<uint32_t> points(row_length * row_length);
        const auto first_uv = uint32_t(mesh_.uvs.size());
        for (uint32_t j = 0; j <= side_; ++j)
            for (uint32_t i = 0; i <= side_; ++i) {
                points[j * row_length + i] = find_or_add(samples, patch, i, j);
                mesh_.uvs.push_back(get_uv(patch, float(i) / float(side_), float(j) / float(side_)));
            }
        for (uint32_t j = 0; j < side_; ++j)
            for (uint32_t i = 0; i < side_; ++i) {
                const size_t at = j * row_length + i;
                std::array<size_t, 4> corners{at, at + 1, at + row_length + 1, at + row_length};
                if (is_turned_) std::swap(corners[1], corners[3]);
                mesh_.face_sizes.push_back(4);
                for (const size_t corner : corners) {
                    mesh_.position_indices.push_back(points[corner]);
                    mesh_.uv_indices.push_back(first_uv + uint32_t(corner));
                }
            }
    }

    uint32_t add_point(const PatchSamples& samples, uint32_t i, uint32_t j) {
        mesh_.positions.push_back(
            transform_point(world_from_object_, evaluate_vertex(samples, levels_, i, j)));
        return uint32_t(mesh_.positions.size()) - 1;
    }

    uint32_t find_or_add(const PatchSamples& samples, uint32_t patch, uint32_t i, uint32_t j) {
        const Quad quad = surface_.quads[patch];
        const bool is_on_column = i == 0 || i == side_, is_on_row = j == 0 || j == side_;
        if (is_on_column && is_on_row) {
            const uint32_t corner = j == 0 ? (i == 0 ? 0 : 1) : (i == 0 ? 3 : 2);
            const auto [place, is_new] = corners_.try_emplace(surface_.dominant(quad.vertex[corner]), 0);
            if (is_new) place->second = add_point(samples, i, j);
            return place->second;
        }
        if (!is_on_column && !is_on_row) return add_point(samples, i, j);
        const int edge = j == 0 ? 0 : i == side_ ? 1 : j == side_ ? 2 : 3;
        const uint32_t along = edge == 0 ? i : edge == 1 ? j : edge == 2 ? side_ - i : side_ - j;
        return find_or_add_edge(samples, patch, edge)[edge_index(patch, edge, along)];
    }

    /// Number of an inner sample of an edge, counted from the start of its line.
    size_t edge_index(uint32_t patch, int edge, uint32_t along) const {
        return (surface_.edge_line(patch, edge).is_reversed ? side_ - along : along) - 1;
    }

    /// The vertices of an edge, which all patches on it share.
    const std::vector<uint32_t>& find_or_add_edge(const PatchSamples& samples, uint32_t patch, int edge) {
        const Surface::EdgeLine line = surface_.edge_line(patch, edge);
        const uint64_t key = uint64_t(line.first) << 32 | line.second;
        const auto [place, is_new] = edges_.try_emplace(key);
        if (!is_new) return place->second;
        for (uint32_t k = 1; k < side_; ++k) {
            const uint32_t along = line.is_reversed ? side_ - k : k;
            const uint32_t i = edge == 0 ? along : edge == 1 ? side_ : edge == 2 ? side_ - along : 0;
            const uint32_t j = edge == 0 ? 0 : edge == 1 ? along : edge == 2 ? side_ : side_ - along;
            place->second.push_back(add_point(samples, i, j));
        }
        return place->second;
    }

    /// With the offset of the tile, which surfaces take off.
    Vec2f get_uv(uint32_t patch, float u, float v) const {
        const Quad quad = surface_.quads[patch];
        const auto& uvs = surface_.uvs;
        Vec2f uv = (uvs[quad.vertex[0]] * (1 - u) + uvs[quad.vertex[1]] * u) * (1 - v) +
                   (uvs[quad.vertex[3]] * (1 - u) + uvs[quad.vertex[2]] * u) * v;
        const TileIndex tile = surface_.tile(quad.vertex[0]);
        if (surface_.vertex_tiles.empty() || tile == Surface::kNoTile) return uv;
        const int number = surface_.map.tiles[tile].udim - 1001;
        return {uv.x + float(number % 10), uv.y + float(number / 10)};
    }

    const Surface& surface_;
    const Affine& world_from_object_;
    bool is_turned_; ///< mirrored: faces are turned so that they still face outwards
    uint32_t side_;
    PatchLevels levels_;
    Mesh& mesh_;
    std::unordered_map<uint32_t, uint32_t> corners_;            ///< by dominant vertex
    std::unordered_map<uint64_t, std::vector<uint32_t>> edges_; ///< by the ends of their lines
};

/// Adds the points of a plain mesh, joined where its weld says so. Returns their numbers from the first one.
std::vector<uint32_t> add_plain_points(const Mesh& source, const Affine& world_from_object, Mesh& mesh) {
    std::vector<uint32_t> numbers(source.positions.size());
    std::iota(numbers.begin(), numbers.end(), 0u);
    const std::vector<uint32_t> joined = source.weld ? join_points(source).representatives : numbers;
    const size_t first = mesh.positions.size();
    for (uint32_t point = 0; point < numbers.size(); ++point) {
        if (joined[point] == point) {
            numbers[point] = uint32_t(mesh.positions.size() - first);
            mesh.positions.push_back(transform_point(world_from_object, source.positions[point]));
        } else {
            numbers[point] = numbers[joined[point]]; // which is a lower number
        }
    }
    return numbers;
}

/// A plain mesh as it is, moved to its place. Without uvs its corners lie at (0, 0).
void add_plain(const Mesh& source, const Object& object, Mesh& mesh) {
    const auto first = uint32_t(mesh.positions.size()), first_uv = uint32_t(mesh.uvs.size());
    const bool is_turned = compute_determinant(object.world_from_object) < 0,
               has_uvs = !source.uv_indices.empty();
    const std::vector<uint32_t> points = add_plain_points(source, object.world_from_object, mesh);
    if (has_uvs)
        mesh.uvs.insert(mesh.uvs.end(), source.uvs.begin(), source.uvs.end());
    else
        mesh.uvs.push_back({});
    size_t begin = 0;
    for (const uint32_t size : source.face_sizes) {
        mesh.face_sizes.push_back(size);
        for (uint32_t k = 0; k < size; ++k) {
            const size_t corner = begin + (is_turned ? size - 1 - k : k);
            mesh.position_indices.push_back(first + points[source.position_indices[corner]]);
            const uint32_t uv = has_uvs ? source.uv_indices[corner] : 0;
            mesh.uv_indices.push_back(uv == kNoIndex ? kNoIndex : first_uv + uv);
        }
        begin += size;
    }
}

/// The faces of a subdivided mesh that is not displaced.
Mesh make_smooth_mesh(const Mesh& source) {
    const Surface surface = make_surface(source, nullptr, {});
    Mesh mesh;
    mesh.positions = surface.positions, mesh.uvs = surface.uvs;
    for (const Quad quad : surface.quads) {
        mesh.face_sizes.push_back(quad.is_triangle() ? 3 : 4);
        mesh.position_indices.insert(mesh.position_indices.end(), quad.vertex.begin(),
                                     quad.vertex.begin() + mesh.face_sizes.back());
    }
    if (!mesh.uvs.empty()) mesh.uv_indices = mesh.position_indices;
    return mesh;
}

void check_room(uint64_t patches, int level) {
    const uint64_t quads = patches << (2 * level);
    const uint64_t bytes = quads * kBytesPerQuad;
    if (quads < (uint64_t(1) << 30) && bytes < available_memory_bytes()) return;
    throw Error(ErrorKind::out_of_memory, {fmt::format("{} patches at level {} are {} quads and {} bytes",
                                                       patches, level, quads, bytes),
                                           "", "a lower surface.level needs a quarter of it, each"});
}

} // namespace

Mesh make_displaced_mesh(const Scene& scene, int level, const ProgressFunction& on_progress) {
    if (level < 0 || level > kMaxLevel)
        throw Error(ErrorKind::usage, {fmt::format("level {} is not in [0, {}]", level, kMaxLevel), "", ""});
    RenderSettings settings;
    settings.surface.level = level;
    const std::shared_ptr<const PreparedScene> prepared = prepare_scene(scene, settings);
    Mesh mesh;
    mesh.name = "displaced";
    uint64_t patches = 0;
    for (const Instance& instance : prepared->instances) {
        const Surface& surface = prepared->surfaces[instance.surface];
        patches += surface.has_displacement ? surface.patch_count() : 0;
    }
    ProgressCounter counter(on_progress, patches);
    for (size_t number = 0; number < scene.objects.size(); ++number) {
        const Object& object = scene.objects[number];
        const Mesh& source = scene.meshes[object.mesh];
        if (object.displacement == kNoIndex) {
            const bool is_smooth = source.subdivision.scheme != SubdivisionScheme::none;
            add_plain(is_smooth ? make_smooth_mesh(source) : source, object, mesh);
            continue;
        }
        // Not the object's own transform: the surface may be measured from elsewhere.
        const Instance& instance = prepared->instances[number];
        const Surface& surface = prepared->surfaces[instance.surface];
        check_room(surface.patch_count() + (uint64_t(mesh.face_sizes.size()) >> (2 * level)), level);
        SurfaceCutter(surface, instance.world_from_object, level, mesh).cut(counter);
    }
    return mesh;
}

} // namespace relief
