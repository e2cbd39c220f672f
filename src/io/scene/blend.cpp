#include "io/scene/blend.h"

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/parallel.h"
#include "image/texel_layout.h"
#include "math/vec.h"
#include "relief/error.h"

namespace relief {

namespace {

/// Of two neighbouring files.
[[noreturn]] void refuse(const std::string& a, const std::string& b, const std::string& difference,
                         const char* hint) {
    throw Error(ErrorKind::bad_input,
                {fmt::format("nothing lies between this and {}: {}", b, difference), a, hint});
}

bool is_floating(const Texture& texture) {
    return texture.source_type == SampleType::float16 || texture.source_type == SampleType::float32;
}

void check_alike(const Texture& a, const Texture& b) {
    constexpr const char* kHint = "write all files of a sequence in one form, or close the shutter";
    if (a.width != b.width || a.height != b.height)
        refuse(a.file, b.file,
               fmt::format("{} x {} and {} x {} pixels", a.width, a.height, b.width, b.height), kHint);
    if (a.channel_count != b.channel_count)
        refuse(a.file, b.file, fmt::format("{} and {} channels", a.channel_count, b.channel_count), kHint);
    if (a.stride != b.stride)
        refuse(a.file, b.file, fmt::format("{} and {} values a texel", a.stride, b.stride), kHint);
    if (a.source_type != b.source_type && !(is_floating(a) && is_floating(b)))
        refuse(a.file, b.file, "samples of two kinds", kHint);
}

float blend(float a, float b, float weight) { return (1 - weight) * a + weight * b; }
Vec2f blend(const Vec2f& a, const Vec2f& b, float w) { return {blend(a.x, b.x, w), blend(a.y, b.y, w)}; }
Vec3f blend(const Vec3f& a, const Vec3f& b, float w) {
    return {blend(a.x, b.x, w), blend(a.y, b.y, w), blend(a.z, b.z, w)};
}

constexpr const char* kMeshHint =
    "export all files of a sequence from one mesh, faces and their order unchanged, or close the shutter";

template <class List> void require_same(const Mesh& a, const Mesh& b, const char* what, List Mesh::*member) {
    const List &first = a.*member, &second = b.*member;
    if (first.size() != second.size())
        refuse(a.source, b.source, fmt::format("{} and {} {}", first.size(), second.size(), what), kMeshHint);
    const auto place = std::ranges::mismatch(first, second).in1;
    if (place != first.end())
        refuse(a.source, b.source, fmt::format("{} differ at {}", what, place - first.begin()), kMeshHint);
}

template <class List>
void require_same_count(const Mesh& a, const Mesh& b, const char* what, List Mesh::*member) {
    const size_t first = (a.*member).size(), second = (b.*member).size();
    if (first != second)
        refuse(a.source, b.source, fmt::format("{} and {} {}", first, second, what), kMeshHint);
}

void require_same_sets(const Mesh& a, const Mesh& b) {
    const auto is_same = [](const UvSet& x, const UvSet& y) {
        return x.number == y.number && x.uvs.size() == y.uvs.size() && x.indices == y.indices;
    };
    if (!std::ranges::equal(a.further_uvs, b.further_uvs, is_same))
        refuse(a.source, b.source, "other uvs in the sets that textures lie on", kMeshHint);
}

template <class Value>
void blend_list(std::vector<Value>& values, const std::vector<Value>& others, float weight) {
    for (size_t k = 0; k < values.size(); ++k) values[k] = blend(values[k], others[k], weight);
}

/// Normals with one index each in both meshes, or as many as there are corners.
void blend_normals(Mesh& mesh, const Mesh& b, float weight) {
    if (mesh.normal_indices == b.normal_indices && mesh.normals.size() == b.normals.size())
        return blend_list(mesh.normals, b.normals, weight);
    std::vector<Vec3f> normals;
    for (size_t k = 0; k < mesh.normal_indices.size(); ++k) {
        normals.push_back(
            blend(mesh.normals[mesh.normal_indices[k]], b.normals[b.normal_indices[k]], weight));
        mesh.normal_indices[k] = uint32_t(k);
    }
    mesh.normals = std::move(normals);
}

} // namespace

std::shared_ptr<const Texture> blend_textures(const Texture& a, const Texture& b, double weight) {
    check_alike(a, b);
    auto result = std::make_shared<Texture>();
    result->width = a.width, result->height = a.height, result->channel_count = a.channel_count;
    result->file = a.file, result->colour_tag = a.colour_tag;
    const bool has_halves = a.floats.empty() && b.floats.empty();
    result->source_type = is_floating(a) && !has_halves ? SampleType::float32 : a.source_type;
    result->stride = a.stride;
    const size_t count = result->value_count();
    if (has_halves)
        result->halves.resize(count);
    else
        result->floats.resize(count);
    const auto w = float(weight);
    constexpr size_t kGrain = 1 << 16;
    parallel_for("blend textures", count, kGrain, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
            store_value(*result, i, blend(load_value(a, i), load_value(b, i), w));
        }
    });
    return result;
}

Mesh blend_meshes(const Mesh& a, const Mesh& b, double weight) {
    require_same_count(a, b, "points", &Mesh::positions);
    require_same(a, b, "sizes of faces", &Mesh::face_sizes);
    require_same(a, b, "corners of faces", &Mesh::position_indices);
    require_same_count(a, b, "uvs", &Mesh::uvs);
    require_same(a, b, "uvs of corners", &Mesh::uv_indices);
    require_same_sets(a, b);
    require_same_count(a, b, "normals of corners", &Mesh::normal_indices);
    require_same_count(a, b, "tangents", &Mesh::tangents);
    const auto w = float(weight);
    Mesh mesh = a;
    blend_list(mesh.positions, b.positions, w);
    blend_list(mesh.uvs, b.uvs, w);
    for (size_t k = 0; k < mesh.further_uvs.size(); ++k)
        blend_list(mesh.further_uvs[k].uvs, b.further_uvs[k].uvs, w);
    blend_normals(mesh, b, w);
    for (size_t k = 0; k < mesh.tangents.size(); ++k)
        for (size_t c = 0; c < 3; ++c) mesh.tangents[k][c] = blend(mesh.tangents[k][c], b.tangents[k][c], w);
    return mesh;
}

} // namespace relief
