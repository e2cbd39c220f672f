#include "io/scene/frame_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <utility>

#include "base/parallel.h"
#include "io/scene/surface_samples.h"
#include "math/affine.h"

namespace relief {

namespace {

constexpr double kSamples = 262144; ///< of displaced surfaces in one scene
constexpr size_t kFewCopies = 16;   ///< of one shape; of more, the corners of its box stand for it

/// A mesh with its map and the objects that show it.
struct Shape {
    const Mesh* mesh;
    const Displacement* map;
    std::vector<const Object*> objects;
};

std::vector<Shape> list_shapes(const Scene& scene) {
    std::map<std::pair<uint32_t, uint32_t>, Shape> shapes;
    for (const Object& object : scene.objects) {
        Shape& shape = shapes[{object.mesh, object.displacement}];
        shape.mesh = &scene.meshes[object.mesh];
        shape.map = object.displacement == kNoIndex ? nullptr : &scene.displacements[object.displacement];
        shape.objects.push_back(&object);
    }
    std::vector<Shape> result;
    for (auto& [key, shape] : shapes) result.push_back(std::move(shape));
    return result;
}

std::array<Vec3f, 8> get_corners(const Box& box) {
    std::array<Vec3f, 8> corners;
    for (size_t k = 0; k < 8; ++k)
        corners[k] = {k & 1 ? box.upper.x : box.lower.x, k & 2 ? box.upper.y : box.lower.y,
                      k & 4 ? box.upper.z : box.lower.z};
    return corners;
}

/// Calls `visit` with the corners of all faces in the world.
template <class Visit> void visit_bare(const std::vector<Shape>& shapes, const Visit& visit) {
    for (const Shape& shape : shapes) {
        const Mesh& mesh = *shape.mesh;
        Box box;
        if (shape.objects.size() > kFewCopies)
            for (const uint32_t index : mesh.position_indices) box.extend(mesh.positions[index]);
        for (const Object* object : shape.objects) {
            const Affine& matrix = object->world_from_object;
            if (shape.objects.size() > kFewCopies)
                for (const Vec3f& corner : get_corners(box)) visit(transform_point(matrix, corner));
            else
                for (const uint32_t index : mesh.position_indices)
                    visit(transform_point(matrix, mesh.positions[index]));
        }
    }
}

/// Extends by all samples after `matrix`. Extents hold largest values, so the order of threads does not
/// matter.
template <class Extent>
void extend_by_samples(const DisplacedSamples& samples, const Affine& matrix, Extent& extent) {
    constexpr size_t kRows = 512; ///< that a thread takes at once
    std::vector<Extent> parts(samples.row_count() / kRows + 1, extent);
    parallel_for("samples of surfaces", samples.row_count(), kRows, [&](size_t begin, size_t end) {
        Extent part = extent;
        std::vector<Vec3f> points;
        for (size_t row = begin; row < end; ++row) {
            points.clear();
            samples.append_row(row, points);
            for (const Vec3f& p : points) part.extend(transform_point(matrix, p));
        }
        parts[begin / kRows] = part;
    });
    for (const Extent& part : parts) extent.extend(part);
}

/// Extends by samples of all displaced objects in the world.
template <class Extent> void extend_by_displaced(const std::vector<Shape>& shapes, Extent& extent) {
    const double share = kSamples / double(shapes.size());
    for (const Shape& shape : shapes) {
        if (!shape.map) continue;
        if (shape.objects.size() <= kFewCopies) {
            for (const Object* object : shape.objects) {
                const Affine& matrix = object->world_from_object;
                const Affine inverse = invert(matrix).value_or(Affine{});
                extend_by_samples(
                    DisplacedSamples(*shape.mesh, *shape.map, inverse, share / double(shape.objects.size())),
                    matrix, extent);
            }
            continue;
        }
        Box box;
        extend_by_samples(DisplacedSamples(*shape.mesh, *shape.map, Affine{}, share), Affine{}, box);
        for (const Object* object : shape.objects)
            for (const Vec3f& corner : get_corners(box))
                extent.extend(transform_point(object->world_from_object, corner));
    }
}

Box measure_bare(const std::vector<Shape>& shapes) {
    Box box;
    visit_bare(shapes, [&](const Vec3f& p) { box.extend(p); });
    return box;
}

Vec3f make_direction(float azimuth_degrees, float elevation_degrees) {
    constexpr float kRadians = std::numbers::pi_v<float> / 180;
    const float azimuth = azimuth_degrees * kRadians, elevation = elevation_degrees * kRadians;
    return {std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
            std::cos(azimuth) * std::cos(elevation)};
}

/// Azimuth of the side that a body faces, degrees: of four-legged shapes the end of the head.
float find_front(const std::vector<Shape>& shapes, const Box& box) {
    constexpr double kClear = 0.1; ///< least correlation of height and depth
    const Vec3f size = box.extent();
    if (size.z <= size.x) return 0;
    double yy = 0, yz = 0, zz = 0;
    const Vec3f middle = box.center();
    visit_bare(shapes, [&](const Vec3f& p) {
        const double y = double(p.y) - double(middle.y), z = double(p.z) - double(middle.z);
        yy += y * y, yz += y * z, zz += z * z;
    });
    return yz < -kClear * std::sqrt(yy * zz) ? 180.0f : 0.0f;
}

/// The camera's axes, and how far points reach along them. A point at x, y, z along right, up and view is in
/// the picture of a camera at distance d on the axis when |x| and |y| are at most their tangent times (d -
/// z): so what matters of a set of points is the largest value of `tangent z` plus x, -x, y and -y.
struct Reach {
    Vec3f right, up, view;
    float tangent_x = 0, tangent_y = 0;
    bool is_turned = false; ///< points count as the circles that they make about the axis through the centre
    Vec3f centre, axis;
    std::array<float, 4> sides;

    void clear() { sides.fill(-std::numeric_limits<float>::infinity()); }
    void extend(const Vec3f& p) {
        if (is_turned)
            extend_by_ring(p);
        else
            extend_by_point(p);
    }
    void extend(const Reach& other) {
        for (size_t k = 0; k < sides.size(); ++k) sides[k] = std::max(sides[k], other.sides[k]);
    }

  private:
    void extend_by_point(const Vec3f& p) {
        const float x = dot(p, right), y = dot(p, up), z = dot(p, view);
        sides[0] = std::max(sides[0], tangent_x * z + x), sides[1] = std::max(sides[1], tangent_x * z - x);
        sides[2] = std::max(sides[2], tangent_y * z + y), sides[3] = std::max(sides[3], tangent_y * z - y);
    }
    void extend_by_ring(const Vec3f& p) {
        const float height = dot(p - centre, axis);
        const float radius = length(p - centre - axis * height);
        const Vec3f toward = normalize(view - axis * dot(view, axis));
        for (const Vec3f& side : {right, right * -1.0f, toward, toward * -1.0f})
            extend_by_point(centre + axis * height + side * radius);
    }
};

Reach make_reach(const Camera& camera, const Vec3f& view, float aspect) {
    constexpr float kFill = 0.85f;
    Reach reach;
    reach.clear();
    reach.tangent_y = kFill * std::tan(camera.fov_degrees * std::numbers::pi_v<float> / 360);
    reach.tangent_x = reach.tangent_y * std::min(aspect, 1.0f);
    reach.view = view;
    reach.right = normalize(cross(camera.up, view));
    reach.up = cross(view, reach.right);
    return reach;
}

/// Rounds what the displacement adds to the reach of the bare mesh to fifteenths of the mesh's size, which
/// the margin has room for: so coding errors rarely move the camera.
void coarsen(Reach& reach, const std::array<float, 4>& bare) {
    const float step = std::max(bare[0] + bare[1], bare[2] + bare[3]) / 15;
    if (!(step > 0)) return;
    for (size_t k = 0; k < 4; ++k) {
        const float steps = std::round((reach.sides[k] - bare[k]) / step);
        reach.sides[k] = bare[k] + std::max(steps, 0.0f) * step;
    }
}

Vec3f find_body_view(const std::vector<Shape>& shapes) {
    const Box box = measure_bare(shapes);
    Vec3f normal;
    for (const Shape& shape : shapes)
        normal += transform_vector(shape.objects.front()->world_from_object, sum_area_vectors(*shape.mesh));
    const Vec3f size = box.extent();
    const float largest = std::max({size.x, size.y, size.z});
    constexpr float kFlat = 0.05f;
    if (size.y < kFlat * largest) return make_direction(25, normal.y < 0 ? -40.0f : 40.0f);
    if (size.x < kFlat * largest) return make_direction(normal.x < 0 ? -65.0f : 115.0f, 18);
    if (size.z < kFlat * largest) return make_direction(normal.z < 0 ? 205.0f : 25.0f, 18);
    return make_direction(find_front(shapes, box) + 30, 22);
}

} // namespace

Box measure_scene(const Scene& scene) {
    const std::vector<Shape> shapes = list_shapes(scene);
    Box box = measure_bare(shapes);
    extend_by_displaced(shapes, box);
    return box;
}

Vec3f choose_view(const Scene& scene, View view) {
    const std::vector<Shape> shapes = list_shapes(scene);
    if (view == View::automatic) return find_body_view(shapes);
    if (view == View::top) return {0, 1, 0};
    const Box box = measure_bare(shapes);
    const float front = scene.objects.size() == 1 ? find_front(shapes, box) : 0;
    switch (view) {
    case View::back:
        return make_direction(front + 180, 0);
    case View::right:
        return make_direction(front + 90, 0);
    case View::left:
        return make_direction(front - 90, 0);
    case View::three_quarter:
        return make_direction(front + 30, 22);
    default:
        return make_direction(front, 0);
    }
}

Camera frame_scene(const Scene& scene, Camera camera, const Vec3f& view, float aspect, Framing framing) {
    if (length(cross(camera.up, view)) < 1e-3f) camera.up = {0, 0, -1};
    const std::vector<Shape> shapes = list_shapes(scene);
    Reach reach = make_reach(camera, view, aspect);
    const Box box = measure_bare(shapes);
    reach.is_turned = framing == Framing::turn, reach.centre = box.center(),
    reach.axis = normalize(camera.up);
    visit_bare(shapes, [&](const Vec3f& p) { reach.extend(p); });
    const std::array<float, 4> bare = reach.sides;
    extend_by_displaced(shapes, reach);
    coarsen(reach, bare);
    const auto& [right, left, top, bottom] = reach.sides;
    const float distance =
        std::max((right + left) / (2 * reach.tangent_x), (top + bottom) / (2 * reach.tangent_y));
    const float middle = dot(box.center(), reach.view);
    camera.focus_distance = distance > middle ? distance - middle : 1;
    camera.to = reach.right * ((right - left) / 2) + reach.up * ((top - bottom) / 2) + reach.view * middle;
    camera.from = camera.to + reach.view * camera.focus_distance;
    return camera;
}

} // namespace relief
