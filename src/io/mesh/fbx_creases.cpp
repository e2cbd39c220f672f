#include "io/mesh/fbx_creases.h"

#include <algorithm>
#include <cmath>

#include "relief/scene.h"

namespace relief {

namespace {

/// Files have 0 to 1, and 1 stands for infinitely sharp.
float scale_sharpness(float value) { return value * kInfiniteSharpness; }

class CreaseReader {
  public:
    CreaseReader(const FbxDocument& document, const FbxRecord& geometry)
        : document_(document), geometry_(geometry) {}

    std::vector<FbxCrease> read() {
        const std::vector<float> edges = read_layer("EdgeCrease"), vertices = read_layer("VertexCrease");
        const auto is_sharp = [](float value) { return std::isfinite(value) && value > 0; };
        if (std::ranges::none_of(edges, is_sharp) && std::ranges::none_of(vertices, is_sharp)) return {};
        points_ = read_floats("Vertices");
        for (size_t k = 0; k < vertices.size(); ++k)
            if (is_sharp(vertices[k])) add(int64_t(k), int64_t(k), vertices[k]);
        const std::vector<int64_t> corners = read_integers("PolygonVertexIndex"),
                                   starts = read_integers("Edges"), nexts = find_nexts(corners);
        for (size_t k = 0; k < std::min(edges.size(), starts.size()); ++k)
            if (is_sharp(edges[k]) && starts[k] >= 0 && size_t(starts[k]) < corners.size())
                add(get_point(corners[size_t(starts[k])]),
                    get_point(corners[size_t(nexts[size_t(starts[k])])]), edges[k]);
        return std::move(creases_);
    }

  private:
    std::vector<float> read_floats(std::string_view name) const {
        const FbxRecord* array = geometry_.find(name);
        return array ? document_.read_floats(*array) : std::vector<float>();
    }

    std::vector<int64_t> read_integers(std::string_view name) const {
        const FbxRecord* array = geometry_.find(name);
        return array ? document_.read_integers(*array) : std::vector<int64_t>();
    }

    std::vector<float> read_layer(const std::string& kind) const {
        const FbxRecord* layer = geometry_.find("LayerElement" + kind);
        const FbxRecord* array = layer ? layer->find(kind) : nullptr;
        return array ? document_.read_floats(*array) : std::vector<float>();
    }

    /// The last corner of a polygon is marked: its bits are turned over.
    static int64_t get_point(int64_t corner) { return corner < 0 ? ~corner : corner; }

    /// Finds for each corner the next one around its polygon.
    static std::vector<int64_t> find_nexts(const std::vector<int64_t>& corners) {
        std::vector<int64_t> nexts(corners.size());
        int64_t first = 0;
        for (size_t k = 0; k < corners.size(); ++k) {
            const bool is_last = corners[k] < 0 || k + 1 == corners.size();
            nexts[k] = is_last ? first : int64_t(k) + 1;
            if (is_last) first = int64_t(k) + 1;
        }
        return nexts;
    }

    void add(int64_t first, int64_t second, float value) {
        const auto count = int64_t(points_.size() / 3);
        if (first < 0 || second < 0 || first >= count || second >= count) return;
        const auto get = [&](int64_t point) {
            const float* at = points_.data() + 3 * point;
            return Vec3f{at[0], at[1], at[2]};
        };
        creases_.push_back({get(first), get(second), scale_sharpness(value)});
    }

    const FbxDocument& document_;
    const FbxRecord& geometry_;
    std::vector<float> points_;
    std::vector<FbxCrease> creases_;
};

} // namespace

std::vector<FbxCrease> read_fbx_creases(const FbxDocument& document, const FbxRecord& geometry) {
    return CreaseReader(document, geometry).read();
}

} // namespace relief
