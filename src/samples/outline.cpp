#include "samples/outline.h"

#include <algorithm>

#include "samples/profile.h"

namespace relief::samples {

Outline::Outline(const std::vector<Vec2f>& points, Kind kind) : kind_(kind) {
    constexpr int kPiecesASpan = 7;
    std::vector<Vec2f> control = points;
    // A closed curve is run with a few points before and behind it, so that it closes smoothly.
    const size_t extra = kind == Kind::closed ? 2 : 0;
    if (kind == Kind::closed) {
        control.insert(control.begin(), points.end() - 2, points.end());
        control.insert(control.end(), points.begin(), points.begin() + 3);
    }
    const ProfileCurve curve(control, ProfileCurve::Ends::free);
    const size_t spans = control.size() - 1, used = kind == Kind::closed ? points.size() : spans;
    for (size_t i = 0; i <= used * kPiecesASpan; ++i)
        pieces_.push_back(curve.at((float(extra) + float(i) / kPiecesASpan) / float(spans)));
}

OutlineHit Outline::find(const Vec2f& p) const {
    OutlineHit hit;
    float best = 1e30f;
    bool is_inside = false;
    for (size_t i = 0; i + 1 < pieces_.size(); ++i) {
        const Vec2f a = pieces_[i], ab = pieces_[i + 1] - a, ap = p - a;
        const float f = std::clamp((ap.x * ab.x + ap.y * ab.y) / (ab.x * ab.x + ab.y * ab.y), 0.0f, 1.0f);
        const Vec2f offset = ap - ab * f;
        const float squared = offset.x * offset.x + offset.y * offset.y;
        const Vec2f b = pieces_[i + 1];
        if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + ab.x * (p.y - a.y) / ab.y) is_inside = !is_inside;
        if (squared >= best) continue;
        best = squared;
        const float distance = std::max(std::sqrt(squared), 1e-9f);
        const bool is_left = ab.x * ap.y - ab.y * ap.x > 0;
        hit.distance = is_left ? distance : -distance;
        hit.inward = offset * (1 / hit.distance);
    }
    if (kind_ == Kind::closed && (hit.distance > 0) != is_inside) {
        hit.distance = -hit.distance;
        hit.inward = hit.inward * -1.0f;
    }
    return hit;
}

} // namespace relief::samples
