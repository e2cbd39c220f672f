#include "surface/mesh/face_splitter.h"

#include <algorithm>
#include <array>
#include <utility>

#include "relief/scene.h"

namespace relief {

namespace {

using Place = Vec2<double>;

Place middle(const Place& a, const Place& b) { return (a + b) * 0.5; }

class FaceSplitter {
  public:
    FaceSplitter(const Cage& cage, const std::vector<uint8_t>& is_split, const FindUv& find_uv)
        : cage_(cage), is_split_(is_split), find_uv_(find_uv), new_edges_(is_split.size(), kNoIndex) {
        result_.point_count = cage.point_count;
        result_.has_uvs = cage.has_uvs;
        result_.uvs.resize(cage.uvs.size());
        result_.is_regular = cage.is_regular, result_.is_straight = cage.is_straight;
        result_.limit_normals = cage.limit_normals;
        result_.starts.push_back(0);
    }

    Cage run() {
        for (uint32_t face = 0; face < cage_.face_count(); ++face) split(face);
        return std::move(result_);
    }

  private:
    /// A corner of a new quad.
    struct Node {
        uint32_t point = 0;
        Place place;
        std::vector<Vec2f> uvs; ///< per set
    };

    /// A split edge: its ends, its middle and, per set, the uvs there of the first face that has it.
    struct SplitEdge {
        uint32_t first, second, middle;
        uint32_t first_half, second_half;
        std::vector<std::array<Vec2f, 3>> uvs; ///< at first, second and middle
    };

    void split(uint32_t face) {
        const uint32_t size = cage_.face_size(face);
        if (size != 4) return split_polygon(face);
        std::array<bool, 4> has{};
        for (uint32_t k = 0; k < 4; ++k) has[k] = is_split_[cage_.edges[cage_.starts[face] + k]] != 0;
        const int count = has[0] + has[1] + has[2] + has[3];
        if (count == 0) return copy(face);
        const QuadPlace& place = cage_.places[face];
        std::array<Node, 4> corner, side;
        for (uint32_t k = 0; k < 4; ++k) {
            corner[k] = take_corner(face, k, place.corners[k]);
            if (has[k])
                side[k] = take_middle(face, k, place, middle(place.corners[k], place.corners[(k + 1) % 4]));
        }
        if (count == 2 && (has[0] == has[2])) {
            const uint32_t k = has[0] ? 0 : 1;
            add(face, place, {corner[k], side[k], side[k + 2], corner[(k + 3) % 4]}, k);
            return add(face, place, {side[k], corner[k + 1], corner[(k + 2) % 4], side[k + 2]}, k);
        }
        const Node inside = make_node(place, middle(middle(place.corners[0], place.corners[2]),
                                                    middle(place.corners[1], place.corners[3])));
        if (count == 4) {
            for (uint32_t k = 0; k < 4; ++k)
                add(face, place, {corner[k], side[k], inside, side[(k + 3) % 4]}, k);
            return;
        }
        // Two neighbours: around corner k.
        uint32_t k = 0;
        while (!has[k] || !has[(k + 3) % 4]) ++k;
        const uint32_t next = (k + 1) % 4, across = (k + 2) % 4, before = (k + 3) % 4;
        add(face, place, {corner[k], side[k], inside, side[before]}, k);
        add(face, place, {side[k], corner[next], corner[across], inside}, k);
        add(face, place, {inside, corner[across], corner[before], side[before]}, next);
    }

    void copy(uint32_t face) {
        const uint32_t start = cage_.starts[face];
        for (uint32_t corner = start; corner < start + 4; ++corner) {
            result_.points.push_back(cage_.points[corner]);
            const uint32_t edge = cage_.edges[corner];
            if (new_edges_[edge] == kNoIndex) new_edges_[edge] = add_edge(edge);
            result_.edges.push_back(new_edges_[edge]);
            for (size_t set = 0; set < cage_.uvs.size(); ++set)
                result_.uvs[set].push_back(cage_.uvs[set][corner]);
        }
        result_.places.push_back(cage_.places[face]);
        result_.is_accurate.push_back(cage_.is_accurate[face]), result_.fits.push_back(cage_.fits[face]);
        result_.starts.push_back(uint32_t(result_.points.size()));
    }

    /// Into one quad per corner: from it to the middle of its edge, of the face and of the edge before.
    void split_polygon(uint32_t face) {
        const uint32_t size = cage_.face_size(face);
        const Node inside = make_node({cage_.places[face].face, 0, {}}, {1, 1});
        result_.is_regular[inside.point] = false;
        std::vector<Node> side(size);
        for (uint32_t k = 0; k < size; ++k)
            side[k] = take_middle(face, k, {cage_.places[face].face, k, {}}, {1, 0});
        for (uint32_t k = 0; k < size; ++k) {
            const QuadPlace part{cage_.places[face].face, k, {}};
            Node begin = side[k], end = side[(k + size - 1) % size];
            begin.place = {1, 0}, end.place = {0, 1};
            add(face, part, {take_corner(face, k, {0, 0}), begin, inside, end});
        }
    }

    Node take_corner(uint32_t face, uint32_t k, const Place& place) const {
        Node node{cage_.points[cage_.starts[face] + k], place, {}};
        for (const std::vector<Vec2f>& set : cage_.uvs) node.uvs.push_back(set[cage_.starts[face] + k]);
        return node;
    }

    Node make_node(const QuadPlace& face, const Place& at) {
        Node node{result_.point_count++, at, {}};
        result_.is_regular.push_back(true), result_.is_straight.push_back(false);
        result_.limit_normals.push_back({});
        for (uint32_t set = 0; set < cage_.uvs.size(); ++set) node.uvs.push_back(find_uv_(set, face, at));
        return node;
    }

    /// The middle of edge k of a face, made by the first face that comes to it.
    Node take_middle(uint32_t face, uint32_t k, const QuadPlace& place, const Place& at) {
        const uint32_t start = cage_.starts[face], next = (k + 1) % cage_.face_size(face);
        const uint32_t edge = cage_.edges[start + k];
        const uint32_t first = cage_.points[start + k], second = cage_.points[start + next];
        if (new_edges_[edge] == kNoIndex) {
            const Node node = make_node(place, at);
            SplitEdge made{first, second, node.point, add_edge(edge), add_edge(edge), {}};
            for (size_t set = 0; set < cage_.uvs.size(); ++set)
                made.uvs.push_back({cage_.uvs[set][start + k], cage_.uvs[set][start + next], node.uvs[set]});
            new_edges_[edge] = uint32_t(split_edges_.size());
            split_edges_.push_back(std::move(made));
            return node;
        }
        const SplitEdge& made = split_edges_[new_edges_[edge]];
        Node node{made.middle, at, {}};
        const bool is_reversed = made.first != first;
        for (uint32_t set = 0; set < cage_.uvs.size(); ++set) {
            const Vec2f &own_first = cage_.uvs[set][start + k], &own_second = cage_.uvs[set][start + next];
            const std::array<Vec2f, 3>& uvs = made.uvs[set];
            const bool is_seam =
                !(own_first == uvs[is_reversed ? 1 : 0] && own_second == uvs[is_reversed ? 0 : 1]);
            node.uvs.push_back(is_seam ? find_uv_(set, place, at) : uvs[2]);
        }
        return node;
    }

    uint32_t add_edge(uint32_t source) {
        result_.is_sharp.push_back(source != kNoIndex && cage_.is_sharp[source]);
        result_.semi_sharpness.push_back(source == kNoIndex ? 0.0f : cage_.semi_sharpness[source]);
        const bool is_kept = source != kNoIndex && !is_split_[source];
        result_.side_fits.push_back(is_kept ? cage_.side_fits[source] : kNoIndex);
        return uint32_t(result_.is_sharp.size() - 1);
    }

    /// Corners in order. The first of `corners` becomes corner `turn` of the new quad, so that the directions
    /// of u and v stay those of the face.
    void add(uint32_t face, const QuadPlace& place, const std::array<Node, 4>& corners, uint32_t turn = 0) {
        QuadPlace added{place.face, place.part, {}};
        std::array<uint32_t, 4> points{};
        for (uint32_t k = 0; k < 4; ++k) {
            const Node& node = corners[(k + 4 - turn) % 4];
            points[k] = node.point, added.corners[k] = node.place;
            for (size_t set = 0; set < cage_.uvs.size(); ++set) result_.uvs[set].push_back(node.uvs[set]);
        }
        for (uint32_t k = 0; k < 4; ++k) {
            result_.points.push_back(points[k]);
            result_.edges.push_back(find_edge(face, points[k], points[(k + 1) % 4]));
        }
        result_.places.push_back(added);
        result_.is_accurate.push_back(0), result_.fits.push_back(kNoIndex);
        result_.starts.push_back(uint32_t(result_.points.size()));
    }

    /// The new edge between two points: a side of the face, half of one, or one inside the face.
    uint32_t find_edge(uint32_t face, uint32_t a, uint32_t b) {
        if (face != inside_of_) inside_of_ = face, inside_edges_.clear();
        const uint32_t start = cage_.starts[face], size = cage_.face_size(face);
        for (uint32_t k = 0; k < size; ++k) {
            const uint32_t edge = cage_.edges[start + k];
            const uint32_t p = cage_.points[start + k], q = cage_.points[start + (k + 1) % size];
            if (!is_split_[edge]) {
                if ((a == p && b == q) || (a == q && b == p)) {
                    if (new_edges_[edge] == kNoIndex) new_edges_[edge] = add_edge(edge);
                    return new_edges_[edge];
                }
                continue;
            }
            const SplitEdge& split = split_edges_[new_edges_[edge]];
            if (a != split.middle && b != split.middle) continue;
            const uint32_t end = a == split.middle ? b : a;
            if (end == split.first) return split.first_half;
            if (end == split.second) return split.second_half;
        }
        const std::pair<uint32_t, uint32_t> ends = std::minmax(a, b);
        for (const auto& [known, edge] : inside_edges_)
            if (known == ends) return edge;
        inside_edges_.push_back({ends, add_edge(kNoIndex)});
        return inside_edges_.back().second;
    }

    const Cage& cage_;
    const std::vector<uint8_t>& is_split_;
    const FindUv& find_uv_;
    Cage result_;
    std::vector<uint32_t> new_edges_; ///< per edge: its new number, or its place in split_edges_
    std::vector<SplitEdge> split_edges_;
    uint32_t inside_of_ = kNoIndex;
    std::vector<std::pair<std::pair<uint32_t, uint32_t>, uint32_t>> inside_edges_; ///< of that face
};

} // namespace

uint64_t count_pieces(const Cage& cage, const std::vector<uint8_t>& is_split) {
    uint64_t sum = 0;
    for (uint32_t face = 0; face < cage.face_count(); ++face) {
        const uint32_t size = cage.face_size(face), start = cage.starts[face];
        int count = 0;
        for (uint32_t k = 0; k < size; ++k) count += is_split[cage.edges[start + k]] != 0;
        const bool is_opposite =
            count == 2 && (is_split[cage.edges[start]] == is_split[cage.edges[start + 2]]);
        sum += size != 4 ? size : count == 4 ? 4 : count == 0 ? 1 : is_opposite ? 2 : 3;
    }
    return sum;
}

Cage split_faces(const Cage& cage, const std::vector<uint8_t>& is_split, const FindUv& find_uv) {
    return FaceSplitter(cage, is_split, find_uv).run();
}

} // namespace relief
