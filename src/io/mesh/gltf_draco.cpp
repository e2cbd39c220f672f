// KHR_draco_mesh_compression, by Draco.
#include <algorithm>
#include <array>
#include <exception>
#include <new>

#include <fmt/format.h>

#include "io/foreign_files.h"
#include "io/mesh/gltf_compression.h"
#include "io/mesh/gltf_primitive.h"

#ifdef RELIEF_DRACO
#include <draco/compression/decode.h>
#endif

namespace relief {

namespace {

#ifdef RELIEF_DRACO
constexpr bool kHasDraco = true;
#else
constexpr bool kHasDraco = false;
#endif
#ifdef RELIEF_MESHOPT
constexpr bool kHasMeshopt = true;
#else
constexpr bool kHasMeshopt = false;
#endif

} // namespace

bool can_decompress_gltf(std::string_view extension) {
    if (extension == "KHR_draco_mesh_compression") return kHasDraco;
    return kHasMeshopt && (extension == "EXT_meshopt_compression" || extension == "KHR_meshopt_compression");
}

#ifdef RELIEF_DRACO

struct DracoMesh::Implementation {
    std::unique_ptr<draco::Mesh> mesh;
};

DracoMesh::DracoMesh(std::string_view bytes, const JsonNode& place)
    : implementation_(std::make_unique<Implementation>()) {
    draco::DecoderBuffer buffer;
    buffer.Init(bytes.data(), bytes.size());
    draco::Decoder decoder;
    try {
        auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
        if (decoded.ok()) implementation_->mesh = std::move(decoded).value();
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception&) { // no mesh
    }
    if (!implementation_->mesh) place.fail("cannot be decompressed", kDamagedHint);
}

size_t DracoMesh::vertex_count() const { return implementation_->mesh->num_points(); }

std::vector<uint32_t> DracoMesh::list_corners() const {
    const draco::Mesh& mesh = *implementation_->mesh;
    std::vector<uint32_t> corners;
    for (draco::FaceIndex face(0); face < mesh.num_faces(); ++face)
        for (const draco::PointIndex& point : mesh.face(face)) corners.push_back(point.value());
    return corners;
}

std::vector<float> DracoMesh::read_floats(uint32_t id, size_t width, std::optional<float> largest,
                                          const JsonNode& place) const {
    const draco::PointAttribute* attribute = implementation_->mesh->GetAttributeByUniqueId(id);
    constexpr size_t kMostWidth = 4;
    if (!attribute || width > kMostWidth)
        place.fail(fmt::format("has no attribute {} in its compressed data", id), kDamagedHint);
    const float scale = largest && !attribute->normalized() ? 1 / *largest : 1.0f;
    std::vector<float> values;
    values.reserve(width * vertex_count());
    for (uint32_t vertex = 0; vertex < vertex_count(); ++vertex) {
        const draco::AttributeValueIndex index = attribute->mapped_index(draco::PointIndex(vertex));
        std::array<float, kMostWidth> value{};
        if (index.value() >= attribute->size() ||
            !attribute->ConvertValue<float>(index, static_cast<int8_t>(width), value.data()))
            place.fail(fmt::format("has an attribute {} that does not fit", id), kDamagedHint);
        for (size_t k = 0; k < width; ++k)
            values.push_back(largest ? std::max(value[k] * scale, -1.0f) : value[k]);
    }
    return values;
}

#else

struct DracoMesh::Implementation {};

DracoMesh::DracoMesh(std::string_view, const JsonNode& place) {
    const std::optional<ForeignFile> foreign = find_foreign_gltf("KHR_draco_mesh_compression");
    place.fail(foreign->message, foreign->hint);
}

size_t DracoMesh::vertex_count() const { return 0; }

std::vector<uint32_t> DracoMesh::list_corners() const { return {}; }

std::vector<float> DracoMesh::read_floats(uint32_t, size_t, std::optional<float>, const JsonNode&) const {
    return {};
}

#endif

DracoMesh::~DracoMesh() = default;
DracoMesh::DracoMesh(DracoMesh&&) noexcept = default;

} // namespace relief
