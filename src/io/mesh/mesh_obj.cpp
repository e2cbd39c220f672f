#include "io/mesh/mesh_obj.h"

#include <algorithm>
#include <istream>
#include <streambuf>

#include <fmt/format.h>
#include <tiny_obj_loader.h>

#include "io/mesh/obj_numbers.h"
#include "io/mesh/obj_tags.h"
#include "relief/error.h"

namespace relief {

namespace {

/// Text as a stream without a copy; tells how far it was read.
class TextBuffer : public std::streambuf {
  public:
    explicit TextBuffer(std::string_view text) {
        char* begin = const_cast<char*>(text.data()); // streambuf wants it so; nothing writes
        setg(begin, begin, begin + text.size());
    }
    /// Number of the line that was read last, from 1.
    size_t line() const {
        const auto lines = size_t(std::count(eback(), gptr(), '\n'));
        return lines + (gptr() > eback() && gptr()[-1] != '\n' ? 1 : 0);
    }
};

/// Takes what tinyobjloader finds, line by line, and resolves indices relative to what stands above.
class ObjBuilder {
  public:
    ObjBuilder(const TextBuffer& buffer, const std::string& name) : buffer_(buffer), name_(name) {}

    void add_position(const Vec3f& p) { mesh_.positions.push_back(p); }
    void add_uv(const Vec2f& uv) { mesh_.uvs.push_back(uv); }
    void add_normal(const Vec3f& n) { mesh_.normals.push_back(n); }

    void add_face(const tinyobj::index_t* corners, int count) {
        ++face_;
        if (count < 3) return;
        for (int i = 0; i < count; ++i) {
            const tinyobj::index_t& corner = corners[i];
            mesh_.position_indices.push_back(
                resolve(corner.vertex_index, mesh_.positions.size(), "position"));
            if (corner.texcoord_index != 0)
                mesh_.uv_indices.push_back(resolve(corner.texcoord_index, mesh_.uvs.size(), "uv"));
            if (corner.normal_index != 0)
                mesh_.normal_indices.push_back(resolve(corner.normal_index, mesh_.normals.size(), "normal"));
        }
        mesh_.face_sizes.push_back(uint32_t(count));
        const size_t uv_count = mesh_.uv_indices.size();
        if (uv_count != 0 && uv_count != mesh_.position_indices.size())
            fail("some corners have a uv and some have none", "give every face uvs, or none");
    }

    Mesh finish() {
        check_range(mesh_.position_indices, mesh_.positions.size(), "position");
        check_range(mesh_.uv_indices, mesh_.uvs.size(), "uv");
        check_range(mesh_.normal_indices, mesh_.normals.size(), "normal");
        if (mesh_.uv_indices.empty()) mesh_.uvs.clear();
        if (mesh_.normal_indices.size() != mesh_.position_indices.size())
            mesh_.normal_indices.clear(), mesh_.normals.clear();
        return std::move(mesh_);
    }

  private:
    [[noreturn]] void fail(const std::string& message, const std::string& hint) const {
        throw Error(ErrorKind::bad_input,
                    {message, fmt::format("{}, line {}, face {}", name_, buffer_.line(), face_), hint});
    }

    uint32_t resolve(int index, size_t count, const char* what) const {
        const int64_t resolved = index > 0 ? int64_t(index) - 1 : int64_t(count) + index;
        if (index == 0 || resolved < 0)
            fail(fmt::format("{} index {} is out of range", what, index),
                 "indices count from 1, or back from -1");
        return uint32_t(resolved);
    }

    /// Positive indices may refer to lines further down, so the upper end is checked when all is read.
    void check_range(const std::vector<uint32_t>& indices, size_t count, const char* what) const {
        size_t face = 0, corner = 0;
        for (const uint32_t index : indices) {
            if (index >= count) {
                throw Error(ErrorKind::bad_input, {fmt::format("{} index {} is out of range: there are {}",
                                                               what, uint64_t(index) + 1, count),
                                                   fmt::format("{}, face {}", name_, face + 1),
                                                   "the file is damaged: export it again"});
            }
            if (face < mesh_.face_sizes.size() && ++corner == mesh_.face_sizes[face]) ++face, corner = 0;
        }
    }

    const TextBuffer& buffer_;
    const std::string& name_;
    Mesh mesh_;
    size_t face_ = 0;
};

} // namespace

Mesh parse_obj(std::string_view text, const std::string& name) {
    check_obj_numbers(text, name);
    TextBuffer buffer(text);
    std::istream stream(&buffer);
    ObjBuilder builder(buffer, name);
    using tinyobj::real_t;
    tinyobj::callback_t callback;
    callback.vertex_cb = [](void* user, real_t x, real_t y, real_t z, real_t) {
        static_cast<ObjBuilder*>(user)->add_position({x, y, z});
    };
    callback.texcoord_cb = [](void* user, real_t u, real_t v, real_t) {
        static_cast<ObjBuilder*>(user)->add_uv({u, v});
    };
    callback.normal_cb = [](void* user, real_t x, real_t y, real_t z) {
        static_cast<ObjBuilder*>(user)->add_normal({x, y, z});
    };
    callback.index_cb = [](void* user, tinyobj::index_t* corners, int count) {
        static_cast<ObjBuilder*>(user)->add_face(corners, count);
    };
    std::string warning, message;
    if (!tinyobj::LoadObjWithCallback(stream, callback, &builder, nullptr, &warning, &message))
        throw Error(ErrorKind::bad_input, {message, fmt::format("{}, line {}", name, buffer.line()), ""});
    Mesh mesh = builder.finish();
    mesh.creases = parse_obj_creases(text, mesh.positions.size(), name);
    return mesh;
}

} // namespace relief
