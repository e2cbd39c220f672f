#include "samples/profile.h"

#include <algorithm>

namespace relief::samples {

ProfileCurve::ProfileCurve(std::vector<Vec2f> points, Ends ends) {
    const Vec2f first = points.front(), second = points[1];
    const Vec2f last = points.back(), before = points[points.size() - 2];
    points_.push_back(ends == Ends::mirrored ? Vec2f{2 * first.x - second.x, second.y}
                                             : first * 2.0f - second);
    points_.insert(points_.end(), points.begin(), points.end());
    points_.push_back(ends == Ends::mirrored ? Vec2f{2 * last.x - before.x, before.y} : last * 2.0f - before);
}

Vec2f ProfileCurve::at(float q) const {
    const int spans = int(points_.size()) - 3;
    const float position = std::clamp(q, 0.0f, 1.0f) * float(spans);
    const int span = std::min(int(position), spans - 1);
    const float f = position - float(span);
    const Vec2f *p = &points_[size_t(span)], a = p[1], b = p[2];
    const Vec2f tangent_a = (p[2] - p[0]) * 0.5f, tangent_b = (p[3] - p[1]) * 0.5f;
    const float f2 = f * f, f3 = f2 * f;
    return a * (2 * f3 - 3 * f2 + 1) + tangent_a * (f3 - 2 * f2 + f) + b * (3 * f2 - 2 * f3) +
           tangent_b * (f3 - f2);
}

} // namespace relief::samples
