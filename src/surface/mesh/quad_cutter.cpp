#include "surface/mesh/quad_cutter.h"

#include <algorithm>

namespace relief {

namespace {

constexpr std::array<Vec2<double>, 4> kSquare = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};

template <class Value> Value blend(const std::array<Value, 4>& c, const Vec2<double>& at) {
    return (c[0] * (1 - at.x) + c[1] * at.x) * (1 - at.y) + (c[3] * (1 - at.x) + c[2] * at.x) * at.y;
}

} // namespace

QuadCutter::QuadCutter(const RefinedMesh& source, std::vector<SideCut> cuts)
    : source_(source), cuts_(std::move(cuts)), first_pieces_(cuts_.size(), kNoIndex) {
    result_.point_count = source.point_count;
    result_.is_regular = source.is_regular;
    result_.limit_normals = source.limit_normals;
    result_.is_sharp = source.is_sharp;
    result_.is_bent.assign(source.is_sharp.size(), false);
    result_.further_uvs.resize(source.further_uvs.size());
}

uint32_t QuadCutter::add_point() {
    result_.is_regular.push_back(true);
    result_.limit_normals.push_back({});
    return result_.point_count++;
}

uint32_t QuadCutter::add_edge(bool is_sharp) {
    result_.is_sharp.push_back(is_sharp);
    result_.is_bent.push_back(false);
    return uint32_t(result_.is_sharp.size() - 1);
}

uint32_t QuadCutter::find_point(const Corner& corner) {
    const auto [place, is_new] = points_.try_emplace({corner.x, corner.y}, kNoIndex);
    if (is_new) place->second = add_point();
    return place->second;
}

uint32_t QuadCutter::find_edge(uint32_t a, uint32_t b) {
    const auto [place, is_new] = edges_.try_emplace({std::min(a, b), std::max(a, b)}, kNoIndex);
    if (is_new) place->second = add_edge(false);
    return place->second;
}

/// Points and pieces of side k of the view, made by the first quad that comes to it.
void QuadCutter::register_side(uint32_t k) {
    const uint32_t edge = source_.edges[view_.quad][(k + view_.turn) % 4];
    const uint32_t first = source_.points[view_.quad][(k + view_.turn) % 4];
    const uint32_t second = source_.points[view_.quad][(k + view_.turn + 1) % 4];
    const SideCut& cut = cuts_[edge];
    if (first_pieces_[edge] == kNoIndex) {
        first_pieces_[edge] = uint32_t(pieces_.size());
        for (int d = 0; d < cut.count(); ++d)
            pieces_.push_back({add_point(), add_edge(source_.is_sharp[edge])});
    }
    const bool is_from_second = cut.from == second;
    const Corner &from = kSquare[is_from_second ? (k + 1) % 4 : k],
                 &to = kSquare[is_from_second ? k : (k + 1) % 4];
    uint32_t previous = is_from_second ? first : second;
    double s = 1;
    for (int number = 0; number < cut.count(); ++number) {
        const CutEdge& piece = pieces_[first_pieces_[edge] + uint32_t(number)];
        s = cut.next(s, number);
        const Corner at = from * (1 - s) + to * s;
        points_[{at.x, at.y}] = piece.point;
        edges_[{std::min(previous, piece.point), std::max(previous, piece.point)}] = piece.edge;
        previous = piece.point;
    }
    const uint32_t last = is_from_second ? second : first;
    edges_[{std::min(previous, last), std::max(previous, last)}] = edge;
}

void QuadCutter::begin(const QuadView& view) {
    view_ = view;
    points_.clear(), edges_.clear();
    for (uint32_t k = 0; k < 4; ++k)
        points_[{kSquare[k].x, kSquare[k].y}] = source_.points[view.quad][(k + view.turn) % 4];
    for (uint32_t k = 0; k < 4; ++k) register_side(k);
}

void QuadCutter::add_whole(uint32_t quad) {
    result_.points.push_back(source_.points[quad]), result_.edges.push_back(source_.edges[quad]);
    result_.places.push_back(source_.places[quad]);
    if (!source_.uvs.empty()) result_.uvs.push_back(source_.uvs[quad]);
    for (size_t n = 0; n < source_.further_uvs.size(); ++n)
        result_.further_uvs[n].push_back(source_.further_uvs[n][quad]);
}

void QuadCutter::add_box(const Corner& lower, const Corner& upper) {
    add({{lower, {upper.x, lower.y}, upper, {lower.x, upper.y}}});
}

/// From the turned square to the parameters of the face.
QuadCutter::Corner QuadCutter::blend_place(const Corner& corner) const {
    const std::array<Corner, 4>& own = source_.places[view_.quad].corners;
    std::array<Corner, 4> turned;
    for (uint32_t k = 0; k < 4; ++k) turned[k] = own[(k + view_.turn) % 4];
    return blend(turned, corner);
}

/// `uvs`: of the quad at work.
std::array<Vec2f, 4> QuadCutter::blend_uvs(const std::array<Vec2f, 4>& uvs,
                                           const std::array<Corner, 4>& corners) const {
    std::array<Corner, 4> turned;
    for (uint32_t k = 0; k < 4; ++k) {
        const Vec2f& uv = uvs[(k + view_.turn) % 4];
        turned[k] = {uv.x, uv.y};
    }
    std::array<Vec2f, 4> result;
    for (size_t k = 0; k < 4; ++k) {
        const Corner uv = blend(turned, corners[k]);
        result[k] = {float(uv.x), float(uv.y)};
    }
    return result;
}

void QuadCutter::add_uvs(const std::array<Corner, 4>& corners) {
    if (!source_.uvs.empty()) result_.uvs.push_back(blend_uvs(source_.uvs[view_.quad], corners));
    for (size_t n = 0; n < source_.further_uvs.size(); ++n)
        result_.further_uvs[n].push_back(blend_uvs(source_.further_uvs[n][view_.quad], corners));
}

void QuadCutter::add(const std::array<Corner, 4>& corners) {
    std::array<Corner, 4> square = corners;
    if (view_.is_mirrored) {
        for (Corner& corner : square) std::swap(corner.x, corner.y);
        std::reverse(square.begin(), square.end());
    }
    const QuadPlace& place = source_.places[view_.quad];
    QuadPlace added{place.face, place.part, {}};
    std::array<uint32_t, 4> points{}, edges{};
    for (size_t k = 0; k < 4; ++k) {
        points[k] = find_point(square[k]);
        added.corners[k] = blend_place(square[k]);
    }
    for (size_t k = 0; k < 4; ++k) edges[k] = find_edge(points[k], points[(k + 1) % 4]);
    result_.points.push_back(points), result_.edges.push_back(edges);
    result_.places.push_back(added);
    add_uvs(square);
}

void QuadCutter::bend(const Corner& a, const Corner& b) {
    const auto find = [&](Corner corner) {
        if (view_.is_mirrored) std::swap(corner.x, corner.y);
        return find_point(corner);
    };
    result_.is_bent[find_edge(find(a), find(b))] = true;
}

RefinedMesh QuadCutter::finish() {
    result_.first_quads.assign(result_.is_sharp.size(), kNoIndex);
    for (uint32_t quad = result_.quad_count(); quad-- > 0;)
        for (const uint32_t edge : result_.edges[quad]) result_.first_quads[edge] = quad;
    return std::move(result_);
}

} // namespace relief
