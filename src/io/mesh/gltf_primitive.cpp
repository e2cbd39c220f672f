#include "io/mesh/gltf_primitive.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "io/count_things.h"
#include "io/mesh/gltf_compression.h"
#include "relief/error.h"

namespace relief {

namespace {

enum Mode { kLastLineMode = 3, kTriangles = 4, kStrip = 5, kFan = 6 };

using Triangle = std::array<uint32_t, 3>;

/// Triangles of a list of vertices (specification, 3.7.2.1) without the empty ones that join strips.
std::vector<Triangle> make_triangles(const std::vector<uint32_t>& indices, int64_t mode) {
    std::vector<Triangle> triangles;
    const size_t step = mode == kTriangles ? 3 : 1;
    for (size_t i = 0; i + 2 < indices.size(); i += step) {
        const size_t odd = mode == kStrip ? i % 2 : 0;
        const Triangle triangle{indices[mode == kFan ? 0 : i], indices[i + 1 + odd], indices[i + 2 - odd]};
        const bool joins = mode == kStrip && (triangle[0] == triangle[1] || triangle[1] == triangle[2] ||
                                              triangle[2] == triangle[0]);
        if (!joins) triangles.push_back(triangle);
    }
    return triangles;
}

void add_triangles(GltfPrimitive& part, const std::vector<Triangle>& triangles) {
    for (const Triangle& triangle : triangles) {
        part.corners.insert(part.corners.end(), triangle.begin(), triangle.end());
        part.face_sizes.push_back(3);
    }
}

/// Undoes FB_ngon_encoding: a polygon is a fan of consecutive triangles about its first corner.
void add_polygons(GltfPrimitive& part, const std::vector<Triangle>& triangles) {
    const Triangle* last = nullptr;
    for (const Triangle& triangle : triangles) {
        if (last && (*last)[0] == triangle[0] && (*last)[2] == triangle[1]) {
            part.corners.push_back(triangle[2]);
            ++part.face_sizes.back();
        } else {
            part.corners.insert(part.corners.end(), triangle.begin(), triangle.end());
            part.face_sizes.push_back(3);
        }
        last = &triangle;
    }
}

/// The values of a part by Draco, where it has them and this build can read them.
class DracoPart {
  public:
    DracoPart(GltfFile& file, const JsonNode& primitive) : file_(file) {
        const auto extensions = primitive.find("extensions");
        extension_ = extensions ? extensions->find(kName) : std::nullopt;
        if (!extension_ || !can_decompress_gltf(kName)) return;
        mesh_.emplace(file.read_view(extension_->get("bufferView")), *extension_);
    }

    std::optional<std::vector<uint32_t>> list_corners() const {
        if (!mesh_) return std::nullopt;
        return mesh_->list_corners();
    }

    /// Returns the values of an attribute, or nothing where it is not among the compressed ones. `accessor`
    /// gives the meaning of its integers.
    std::optional<std::span<const float>> read(const std::string& key, size_t width,
                                               const JsonNode& accessor) const {
        if (!mesh_) return std::nullopt;
        const auto id = extension_->get("attributes").find(key);
        if (!id) return std::nullopt;
        return file_.keep(mesh_->read_floats(uint32_t(id->as_integer(0, UINT32_MAX)), width,
                                             file_.find_largest(accessor), *extension_));
    }

  private:
    static constexpr const char* kName = "KHR_draco_mesh_compression";
    GltfFile& file_;
    std::optional<JsonNode> extension_;
    std::optional<DracoMesh> mesh_;
};

/// Returns nothing, and adds to the losses, where `read` throws that an attribute cannot be read.
template <class Read>
std::span<const float> read_if_possible(const Read& read, const std::string& attribute,
                                        const JsonNode& primitive, GltfLosses& losses) {
    try {
        return read();
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::bad_input) throw;
        losses.add(attribute, primitive, error);
        return {};
    }
}

void read_faces(GltfFile& file, const JsonNode& primitive, const DracoPart& draco, int64_t mode,
                GltfPrimitive& part) {
    const size_t vertex_count = part.positions.size() / 3;
    std::vector<uint32_t> indices;
    if (std::optional<std::vector<uint32_t>> corners = draco.list_corners()) {
        indices = std::move(*corners), mode = kTriangles; // strips, too, are stored as triangles
    } else if (const auto index = primitive.find("indices")) {
        indices = file.read_indices(*index);
    } else {
        indices.resize(vertex_count);
        std::iota(indices.begin(), indices.end(), 0u);
    }
    for (size_t i = 0; i < indices.size(); ++i)
        if (indices[i] >= vertex_count)
            primitive.fail(fmt::format("index {} is {}, out of range: there are {} vertices", i, indices[i],
                                       vertex_count),
                           kDamagedHint);
    if (mode == kTriangles && indices.size() % 3 != 0)
        primitive.fail(fmt::format("{} indices do not make triangles", indices.size()), kDamagedHint);
    const std::vector<Triangle> triangles = make_triangles(indices, mode);
    const auto extensions = primitive.find("extensions");
    if (mode == kTriangles && extensions && extensions->find("FB_ngon_encoding"))
        add_polygons(part, triangles);
    else
        add_triangles(part, triangles);
}

size_t count_uv_sets(const JsonNode& attributes) {
    size_t count = 0;
    while (attributes.find(fmt::format("TEXCOORD_{}", count))) ++count;
    return count;
}

/// 3 numbers of each vertex grow by `weight` times those of a target.
void add_target(std::vector<float>& values, size_t width, std::span<const float> target, float weight) {
    for (size_t k = 0; k < target.size(); ++k) values[k / 3 * width + k % 3] += weight * target[k];
}

} // namespace

void GltfLosses::add(const std::string& attribute, const JsonNode& primitive, const Error& error) {
    const std::string part = primitive.path();
    Loss& loss = losses_[attribute];
    if (loss.parts > 0 && loss.last == part) return; // another morph target
    if (loss.parts++ == 0) loss.first = part, loss.where = error.where(), loss.message = error.message();
    loss.last = part;
}

std::vector<std::string> GltfLosses::list_warnings(const std::string& file) const {
    std::vector<std::string> warnings;
    for (const auto& [attribute, loss] : losses_) {
        const bool names_file = loss.where.starts_with(file + ": ");
        warnings.push_back(fmt::format(
            "{}: {} of {} cannot be read and is left out; the first is {} ({}: {}): export it again", file,
            attribute, count_things(loss.parts, "part"), loss.first,
            names_file ? loss.where.substr(file.size() + 2) : loss.where, loss.message));
    }
    return warnings;
}

void read_gltf_targets(GltfFile& file, const JsonNode& primitive, GltfPrimitive& part, GltfLosses& losses) {
    const auto targets = primitive.find("targets");
    if (!targets) return;
    for (const JsonNode& target : targets->elements()) {
        const auto read = [&](const char* key, std::span<const float> base) {
            const auto index = target.find(key);
            if (!index || base.empty()) return std::span<const float>();
            const std::span<const float> values = file.read_floats(*index, 3);
            if (values.size() != part.positions.size())
                index->fail(
                    fmt::format("{} values for {} vertices", values.size() / 3, part.positions.size() / 3),
                    kDamagedHint);
            return values;
        };
        const auto try_to_read = [&](const char* key, std::span<const float> base) {
            return read_if_possible([&] { return read(key, base); }, fmt::format("{} of morph targets", key),
                                    primitive, losses);
        };
        part.targets.push_back({read("POSITION", part.positions), try_to_read("NORMAL", part.normals),
                                try_to_read("TANGENT", part.tangents)});
    }
}

MorphedPrimitive::MorphedPrimitive(const GltfPrimitive& part, const std::vector<float>& weights)
    : part_(part) {
    const size_t count = std::min(weights.size(), part.targets.size());
    if (std::all_of(weights.begin(), weights.begin() + ptrdiff_t(count), [](float w) { return w == 0; }))
        return;
    positions_.assign(part.positions.begin(), part.positions.end());
    normals_.assign(part.normals.begin(), part.normals.end());
    tangents_.assign(part.tangents.begin(), part.tangents.end());
    for (size_t k = 0; k < count; ++k) {
        add_target(positions_, 3, part.targets[k].positions, weights[k]);
        add_target(normals_, 3, part.targets[k].normals, weights[k]);
        add_target(tangents_, 4, part.targets[k].tangents, weights[k]);
    }
    part_.positions = positions_, part_.normals = normals_, part_.tangents = tangents_;
}

GltfPrimitive read_gltf_primitive(GltfFile& file, const JsonNode& primitive, int uv_set,
                                  std::span<const int> further_sets, GltfLosses& losses) {
    GltfPrimitive part;
    const auto mode_node = primitive.find("mode");
    const int64_t mode = mode_node ? mode_node->as_integer(0, kFan) : kTriangles;
    if (mode <= kLastLineMode) return part;
    const JsonNode attributes = primitive.get("attributes");
    const DracoPart draco(file, primitive);
    const auto load = [&](const std::string& key, size_t width) {
        const JsonNode index = attributes.get(key);
        const auto values = draco.read(key, width, index);
        return values ? *values : file.read_floats(index, width);
    };
    part.positions = load("POSITION", 3);
    const size_t vertex_count = part.positions.size() / 3;
    const auto read = [&](const std::string& key, size_t width) {
        const auto index = attributes.find(key);
        if (!index) return std::span<const float>();
        return read_if_possible(
            [&] {
                const std::span<const float> values = load(key, width);
                if (values.size() != vertex_count * width)
                    index->fail(
                        fmt::format("has {} values for {} vertices", values.size() / width, vertex_count),
                        kDamagedHint);
                return values;
            },
            key, primitive, losses);
    };
    part.normals = read("NORMAL", 3);
    part.tangents = read("TANGENT", 4);
    part.uvs = read(fmt::format("TEXCOORD_{}", uv_set), 2);
    for (const int set : further_sets) part.further_uvs.push_back(read(fmt::format("TEXCOORD_{}", set), 2));
    part.uv_set_count = count_uv_sets(attributes);
    read_faces(file, primitive, draco, mode, part);
    return part;
}

} // namespace relief
