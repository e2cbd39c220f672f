#include "io/mesh/mesh_writer.h"

#include <bit>
#include <iterator>
#include <vector>

#include <fmt/format.h>

#include "base/progress.h"
#include "io/file_system.h"
#include "io/mesh/mesh_obj.h"
#include "relief/error.h"
#include "relief/io.h"

namespace relief {

namespace {

void append_uint32(std::string& bytes, uint32_t value) {
    for (int shift = 0; shift < 32; shift += 8) bytes += char(value >> shift & 0xff);
}

void append_float(std::string& bytes, float value) { append_uint32(bytes, std::bit_cast<uint32_t>(value)); }

/// The uv of each vertex; empty where the mesh has none, a face has none, or a vertex has several.
std::vector<Vec2f> find_vertex_uvs(const Mesh& mesh) {
    std::vector<Vec2f> uvs(mesh.positions.size());
    std::vector<uint8_t> is_set(mesh.positions.size());
    for (size_t corner = 0; corner < mesh.uv_indices.size(); ++corner) {
        if (mesh.uv_indices[corner] == kNoIndex) return {};
        const uint32_t vertex = mesh.position_indices[corner];
        const Vec2f& uv = mesh.uvs[mesh.uv_indices[corner]];
        if (is_set[vertex] != 0 && !(uvs[vertex] == uv)) return {};
        uvs[vertex] = uv, is_set[vertex] = 1;
    }
    return mesh.uv_indices.empty() ? std::vector<Vec2f>() : uvs;
}

std::string make_ply_header(const Mesh& mesh, const char* vertex_uvs, const char* corner_uvs) {
    return fmt::format("ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\n"
                       "property float y\nproperty float z\n{}element face {}\n"
                       "property list uint uint vertex_indices\n{}end_header\n",
                       mesh.positions.size(), vertex_uvs, mesh.face_sizes.size(), corner_uvs);
}

/// Of a million faces a second nobody looks at each.
class FaceCounter {
  public:
    FaceCounter(const Mesh& mesh, const ProgressFunction& on_progress)
        : counter_(on_progress, mesh.face_sizes.size() / kFaces) {}
    void count_face() {
        if (++faces_ % kFaces == 0) counter_.add(1);
    }

  private:
    static constexpr size_t kFaces = 4096;
    ProgressCounter counter_;
    size_t faces_ = 0;
};

} // namespace

std::string format_obj(const Mesh& mesh, const ProgressFunction& on_progress) {
    FaceCounter counter(mesh, on_progress);
    std::string text;
    const auto out = std::back_inserter(text);
    for (const Vec3f& p : mesh.positions) fmt::format_to(out, "v {:.9g} {:.9g} {:.9g}\n", p.x, p.y, p.z);
    const bool has_uvs = !mesh.uv_indices.empty(), has_normals = !mesh.normal_indices.empty();
    if (has_uvs)
        for (const Vec2f& uv : mesh.uvs) fmt::format_to(out, "vt {:.9g} {:.9g}\n", uv.x, uv.y);
    if (has_normals)
        for (const Vec3f& n : mesh.normals) fmt::format_to(out, "vn {:.9g} {:.9g} {:.9g}\n", n.x, n.y, n.z);
    size_t corner = 0;
    for (const uint32_t size : mesh.face_sizes) {
        text += 'f';
        for (uint32_t k = 0; k < size; ++k, ++corner) {
            fmt::format_to(out, " {}", mesh.position_indices[corner] + 1);
            const bool has_uv = has_uvs && mesh.uv_indices[corner] != kNoIndex;
            if (has_uv) fmt::format_to(out, "/{}", mesh.uv_indices[corner] + 1);
            if (has_normals) fmt::format_to(out, "{}/{}", has_uv ? "" : "/", mesh.normal_indices[corner] + 1);
        }
        text += '\n';
        counter.count_face();
    }
    return text + format_obj_creases(mesh.creases);
}

std::string format_ply(const Mesh& mesh, const ProgressFunction& on_progress) {
    FaceCounter counter(mesh, on_progress);
    const std::vector<Vec2f> uvs = find_vertex_uvs(mesh);
    const bool has_corner_uvs = uvs.empty() && !mesh.uv_indices.empty();
    std::string bytes = make_ply_header(mesh, uvs.empty() ? "" : "property float s\nproperty float t\n",
                                        has_corner_uvs ? "property list uint float texcoord\n" : "");
    for (size_t vertex = 0; vertex < mesh.positions.size(); ++vertex) {
        const Vec3f& p = mesh.positions[vertex];
        append_float(bytes, p.x), append_float(bytes, p.y), append_float(bytes, p.z);
        if (!uvs.empty()) append_float(bytes, uvs[vertex].x), append_float(bytes, uvs[vertex].y);
    }
    size_t first = 0;
    for (const uint32_t size : mesh.face_sizes) {
        append_uint32(bytes, size);
        for (uint32_t k = 0; k < size; ++k) append_uint32(bytes, mesh.position_indices[first + k]);
        const bool has_uvs = has_corner_uvs && mesh.uv_indices[first] != kNoIndex;
        if (has_corner_uvs) append_uint32(bytes, has_uvs ? 2 * size : 0);
        for (uint32_t k = 0; has_uvs && k < size; ++k) {
            const Vec2f& uv = mesh.uvs[mesh.uv_indices[first + k]];
            append_float(bytes, uv.x), append_float(bytes, uv.y);
        }
        first += size;
        counter.count_face();
    }
    return bytes;
}

void write_mesh(const Mesh& mesh, const std::filesystem::path& file, const ProgressFunction& on_progress) {
    validate_mesh(mesh);
    const std::string extension = get_lower_extension(file);
    const ProgressFunction formatting = make_part(on_progress, 0, 0.9);
    if (extension == ".obj")
        write_text_file(file, format_obj(mesh, formatting));
    else if (extension == ".ply")
        write_text_file(file, format_ply(mesh, formatting));
    else
        throw Error(ErrorKind::usage, {fmt::format("cannot write meshes of kind '{}'", extension),
                                       file.string(), "known: .obj, .ply"});
    if (on_progress) on_progress(1);
}

} // namespace relief
