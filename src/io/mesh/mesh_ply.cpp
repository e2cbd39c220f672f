#include "io/mesh/mesh_ply.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "io/mesh/ply_cursor.h"
#include "io/mesh/ply_header.h"
#include "io/mesh/welder.h"
#include "relief/error.h"

namespace relief {

namespace {

using NameList = std::array<std::string_view, 4>;

class PlyBuilder {
  public:
    PlyBuilder(std::string_view bytes, const std::string& name, PlyLines lines)
        : name_(name), header_(parse_ply_header(bytes, name)), cursor_(bytes, name, header_, lines) {}

    Mesh build() {
        const PlyElement *vertices = find_element("vertex"), *faces = find_element("face");
        if (!vertices || !faces) refuse_unknown_words(header_, name_);
        if (!vertices || !faces)
            fail("the mesh has no faces", "export the polygons as well: a cloud of points has no surface");
        vertex_count_ = vertices->count;
        for (const PlyElement& element : header_.elements) {
            if (&element == vertices)
                read_vertices(element);
            else if (&element == faces)
                read_faces(element);
            else
                skip(element);
            if (std::max(vertices, faces) == &element) break; // nothing behind it is wanted
        }
        cursor_.finish();
        return weld();
    }

    bool is_text() const { return header_.format == PlyFormat::ascii; }

    /// Whether elements of the text end before their lines do.
    bool ends_in_lines() const { return cursor_.ends_in_lines(); }

    /// Whether behind the elements read by lines as many lines are left as elements.
    bool has_all_lines() const {
        uint64_t left = 0;
        bool is_behind = false;
        const PlyElement* last = std::max(find_element("vertex"), find_element("face"));
        for (const PlyElement& element : header_.elements) {
            if (is_behind && !element.properties.empty()) left += element.count;
            is_behind = is_behind || &element == last;
        }
        return cursor_.count_lines() == left;
    }

    void add_warnings(std::vector<std::string>& warnings) const {
        if (const PlyUnknownWords& unknown = header_.unknown; unknown.count > 0)
            warnings.push_back(fmt::format("{}: {} lines of the header begin with unknown words and are not "
                                           "read, the first of them line {}: '{}'",
                                           name_, unknown.count, unknown.first_line, unknown.first_word));
        if (cursor_.long_line_count() > 0)
            warnings.push_back(
                fmt::format("{}: {} lines hold more numbers than the header declares, the first "
                            "of them line {}: the numbers at their ends are left out",
                            name_, cursor_.long_line_count(), cursor_.find_first_long_line()));
        if (misfit_uvs_ > 0)
            warnings.push_back(fmt::format("{}: {} faces have other numbers of texture coordinates than of "
                                           "corners, and are read without uvs",
                                           name_, misfit_uvs_));
    }

  private:
    [[noreturn]] void fail(const std::string& message, const std::string& hint) const {
        throw Error(ErrorKind::bad_input, {message, name_, hint});
    }

    const PlyElement* find_element(std::string_view name) const {
        for (const PlyElement& element : header_.elements)
            if (element.name == name) return &element;
        return nullptr;
    }

    /// The place among the properties of the first of these names that is a number; none: their count.
    static size_t find_number(const PlyElement& element, const NameList& names) {
        for (const std::string_view name : names)
            for (size_t i = 0; i < element.properties.size(); ++i)
                if (element.properties[i].name == name && !element.properties[i].count_type) return i;
        return element.properties.size();
    }

    static size_t find_list(const PlyElement& element, const NameList& names) {
        for (size_t i = 0; i < element.properties.size(); ++i)
            if (element.properties[i].count_type &&
                std::find(names.begin(), names.end(), element.properties[i].name) != names.end())
                return i;
        return element.properties.size();
    }

    void skip(const PlyElement& element) {
        if (element.properties.empty()) return; // takes no bytes, whatever its count
        for (uint64_t i = 0; i < element.count; ++i) {
            cursor_.enter(element.name, i);
            for (const PlyProperty& property : element.properties) cursor_.skip(property);
        }
    }

    void read_vertices(const PlyElement& element) {
        constexpr std::array<NameList, 8> kNames = {{{"x"},
                                                     {"y"},
                                                     {"z"},
                                                     {"nx"},
                                                     {"ny"},
                                                     {"nz"},
                                                     {"s", "u", "texture_u", "texture_s"},
                                                     {"t", "v", "texture_v", "texture_t"}}};
        const size_t none = element.properties.size();
        std::array<size_t, 8> places;
        for (size_t k = 0; k < places.size(); ++k) places[k] = find_number(element, kNames[k]);
        const auto has = [&](size_t begin, size_t end) {
            return std::find(places.begin() + begin, places.begin() + end, none) == places.begin() + end;
        };
        if (!has(0, 3)) fail("the vertices have no x, y and z", kDamagedPlyHint);
        if (element.count >= kNoIndex) fail("has too many vertices", "split the mesh");
        const bool has_normals = has(3, 6), has_uvs = has(6, 8);
        std::vector<float> values(none + 1);
        for (uint64_t i = 0; i < element.count; ++i) {
            cursor_.enter(element.name, i);
            for (size_t p = 0; p < none; ++p) {
                if (element.properties[p].count_type)
                    cursor_.skip(element.properties[p]);
                else
                    values[p] = float(cursor_.read(element.properties[p].type));
            }
            positions_.push_back({values[places[0]], values[places[1]], values[places[2]]});
            if (has_normals) normals_.push_back({values[places[3]], values[places[4]], values[places[5]]});
            if (has_uvs) uvs_.push_back({values[places[6]], values[places[7]]});
        }
    }

    void read_faces(const PlyElement& element) {
        const size_t index_place = find_list(element, {"vertex_indices", "vertex_index"});
        const size_t uv_place = find_list(element, {"texcoord"});
        if (index_place == element.properties.size())
            fail("the faces have no list 'vertex_indices'", kDamagedPlyHint);
        std::vector<uint32_t> corners;
        std::vector<float> uvs;
        for (uint64_t i = 0; i < element.count; ++i) {
            cursor_.enter(element.name, i);
            corners.clear(), uvs.clear();
            for (size_t p = 0; p < element.properties.size(); ++p) {
                const PlyProperty& property = element.properties[p];
                if (p == index_place)
                    for (uint64_t left = cursor_.read_count(property); left > 0; --left)
                        corners.push_back(
                            uint32_t(cursor_.read_whole(property.type, vertex_count_, "vertex index")));
                else if (p == uv_place)
                    for (uint64_t left = cursor_.read_count(property); left > 0; --left)
                        uvs.push_back(float(cursor_.read(property.type)));
                else
                    cursor_.skip(property);
            }
            add_face(corners, uvs);
        }
    }

    void add_face(const std::vector<uint32_t>& corners, const std::vector<float>& uvs) {
        if (corners.size() < 3) return;
        const bool has_uvs = uvs.size() == 2 * corners.size();
        if (!has_uvs && !uvs.empty()) ++misfit_uvs_;
        mesh_.face_sizes.push_back(uint32_t(corners.size()));
        corners_.insert(corners_.end(), corners.begin(), corners.end());
        has_face_uvs_.push_back(has_uvs);
        for (size_t k = 0; has_uvs && k < uvs.size(); k += 2) corner_uvs_.push_back({uvs[k], uvs[k + 1]});
    }

    /// Welds the values of the vertices; the corners get the index of theirs.
    template <class Value, size_t N>
    void weld(const std::vector<Value>& of_vertices, std::vector<Value>& values,
              std::vector<uint32_t>& indices) {
        if (of_vertices.empty()) return;
        Welder<Value, N> welder(values);
        std::vector<uint32_t> welded;
        for (const Value& value : of_vertices) welded.push_back(welder.add(value));
        for (const uint32_t vertex : corners_) indices.push_back(welded[vertex]);
    }

    Mesh weld() {
        weld<Vec3f, 3>(positions_, mesh_.positions, mesh_.position_indices);
        weld<Vec3f, 3>(normals_, mesh_.normals, mesh_.normal_indices);
        if (corner_uvs_.empty()) {
            weld<Vec2f, 2>(uvs_, mesh_.uvs, mesh_.uv_indices);
        } else {
            weld_corner_uvs();
        }
        return std::move(mesh_);
    }

    /// Faces with an empty list have no uvs.
    void weld_corner_uvs() {
        UvWelder uvs(mesh_.uvs);
        auto uv = corner_uvs_.begin();
        for (size_t face = 0; face < mesh_.face_sizes.size(); ++face)
            for (uint32_t k = 0; k < mesh_.face_sizes[face]; ++k)
                mesh_.uv_indices.push_back(has_face_uvs_[face] ? uvs.add(*uv++) : kNoIndex);
    }

    const std::string& name_;
    PlyHeader header_;
    PlyCursor cursor_;
    Mesh mesh_;
    uint64_t vertex_count_ = 0;
    std::vector<Vec3f> positions_, normals_;
    std::vector<Vec2f> uvs_, corner_uvs_;
    std::vector<bool> has_face_uvs_;
    size_t misfit_uvs_ = 0;         ///< faces whose list of uvs is of another length than their corners
    std::vector<uint32_t> corners_; ///< of the vertices as they stand in the file
};

/// Some writers add numbers to their lines that they do not declare. Nothing where the elements do not fit
/// the lines either.
std::optional<Mesh> read_by_lines(std::string_view bytes, const std::string& name,
                                  std::vector<std::string>* warnings) {
    try {
        PlyBuilder builder(bytes, name, PlyLines::by_lines);
        Mesh mesh = builder.build();
        if (!builder.has_all_lines()) return {};
        if (warnings) builder.add_warnings(*warnings);
        return mesh;
    } catch (const Error&) {
        return {};
    }
}

} // namespace

Mesh parse_ply(std::string_view bytes, const std::string& name, std::vector<std::string>* warnings) {
    PlyBuilder builder(bytes, name, PlyLines::ignored);
    std::optional<Mesh> mesh;
    try {
        mesh = builder.build();
    } catch (const Error&) {
        if (builder.is_text()) mesh = read_by_lines(bytes, name, warnings);
        if (!mesh) throw;
        return std::move(*mesh);
    }
    if (builder.is_text() && builder.ends_in_lines())
        if (std::optional<Mesh> by_lines = read_by_lines(bytes, name, warnings)) return std::move(*by_lines);
    if (warnings) builder.add_warnings(*warnings);
    return std::move(*mesh);
}

} // namespace relief
