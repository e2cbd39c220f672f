#include "prepare/surface_recipe.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "math/box.h"
#include "math/vec_double.h"

namespace relief {

namespace {

/// Part of a cell's size that the base may be away from the limit surface.
constexpr double kPartOfCell = 0.1;
/// A camera nearer than this part of an object's diagonal sees its faces at very different distances.
constexpr double kNear = 0.25;

/// Boxes about the corners of faces, with as much again on each side: the limit surface of a face depends on
/// its neighbours. Wrong indices are passed over: make_surface() refuses them.
std::vector<Box> find_face_boxes(const Mesh& mesh) {
    std::vector<Box> boxes;
    boxes.reserve(mesh.face_sizes.size());
    size_t corner = 0;
    for (const uint32_t size : mesh.face_sizes) {
        Box box;
        for (size_t k = corner; k < std::min(corner + size, mesh.position_indices.size()); ++k)
            if (mesh.position_indices[k] < mesh.positions.size())
                box.extend(mesh.positions[mesh.position_indices[k]]);
        corner += size;
        const float margin = length(box.extent());
        box.lower = box.lower - Vec3f{margin, margin, margin},
        box.upper = box.upper + Vec3f{margin, margin, margin};
        boxes.push_back(box);
    }
    return boxes;
}

/// Largest factor of lengths under a linear map: the root of the largest eigenvalue of A^T A, by powers
/// (von Mises and Pollaczek-Geiringer 1929) and a little more.
double find_largest_stretch(const Affine& map) {
    Vec3d way{1, 0.9, 0.8};
    double stretch = 0;
    for (int step = 0; step < 40; ++step) {
        way = normalize_double(way);
        const auto& rows = map.rows;
        const Vec3d image{dot(to_double(rows[0]), way), dot(to_double(rows[1]), way),
                          dot(to_double(rows[2]), way)};
        stretch = std::max(stretch, compute_length(image));
        way = to_double(rows[0]) * image.x + to_double(rows[1]) * image.y + to_double(rows[2]) * image.z;
    }
    return stretch * 1.001;
}

/// The camera as a mesh at one of its places sees it.
struct MeshView {
    Vec3d camera;
    double factor; ///< tolerance per distance, both in units of the mesh

    MeshView(const Affine& place, const LevelFieldConfig& config) {
        const Affine mesh_from_world = *invert(place);
        camera = to_double(transform_point(mesh_from_world, config.camera));
        factor = kPartOfCell * double(config.pixel_error) * double(config.pixel_angle) /
                 (find_largest_stretch(place) * find_largest_stretch(mesh_from_world));
    }

    /// Returns the distance of the camera from a box that is larger by `around` on each side.
    double find_distance(const Box& box, double around) const {
        double sum = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const double at = axis == 0 ? camera.x : axis == 1 ? camera.y : camera.z;
            const double off = std::max({double(get_component(box.lower, axis)) - around - at,
                                         at - around - double(get_component(box.upper, axis)), 0.0});
            sum += off * off;
        }
        return std::sqrt(sum);
    }
};

} // namespace

BaseTolerance choose_base_tolerance(const Mesh& mesh, std::span<const Affine> places, double reach,
                                    const LevelFieldConfig& config) {
    Box box;
    for (const Vec3f& p : mesh.positions) box.extend(p);
    std::vector<MeshView> views;
    for (const Affine& place : places) views.emplace_back(place, config);
    const auto find_smallest = [&](const Box& part) {
        double smallest = std::numeric_limits<double>::infinity();
        for (const MeshView& view : views)
            smallest = std::min(smallest, view.factor * view.find_distance(part, reach));
        return find_tolerance_exponent(smallest);
    };
    const double diagonal = double(length(box.extent())), near = kNear * diagonal;
    const bool is_near = std::ranges::any_of(
        views, [&](const MeshView& view) { return view.find_distance(box, reach) < near; });
    if (!is_near) {
        // From the ball about the box, so that a camera which goes around the mesh changes nothing.
        double smallest = std::numeric_limits<double>::infinity();
        for (const MeshView& view : views) {
            const double distance = compute_length(view.camera - to_double(box.center()));
            const double nearest =
                std::max(distance - diagonal / 2 - reach, view.find_distance(box, reach) / 2);
            smallest = std::min(smallest, view.factor * nearest);
        }
        return {find_tolerance_exponent(smallest), {}};
    }
    BaseTolerance tolerance;
    for (const Box& face : find_face_boxes(mesh)) tolerance.of_faces.push_back(int8_t(find_smallest(face)));
    return tolerance;
}

} // namespace relief
