// Triangle meshes for measuring structures: a bumpy body, a hall of uneven triangles, a knot of very many.
#include "lab/scenes/structure_scenes.h"

#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "math/vec.h"
#include "relief/error.h"
#include "samples/noise.h"

namespace relief {

namespace {

constexpr float kPi = std::numbers::pi_v<float>;

using Place = std::function<Vec3f(float u, float v)>;

/// Grows one mesh out of grids.
class MeshMaker {
  public:
    /// `across` x `along` cells over [0, 1]^2, two triangles each.
    void add_grid(int across, int along, const Place& place) {
        const uint32_t first = uint32_t(mesh_.positions.size()), row = uint32_t(across) + 1;
        for (int j = 0; j <= along; ++j)
            for (int i = 0; i <= across; ++i)
                mesh_.positions.push_back(place(float(i) / float(across), float(j) / float(along)));
        for (uint32_t j = 0; j < uint32_t(along); ++j)
            for (uint32_t i = 0; i < uint32_t(across); ++i) {
                const uint32_t corner = first + j * row + i;
                add_triangle(corner, corner + 1, corner + row + 1);
                add_triangle(corner, corner + row + 1, corner + row);
            }
    }

    /// A flat quad with the corners o, o + u, o + u + v, o + v.
    void add_quad(const Vec3f& o, const Vec3f& u, const Vec3f& v) {
        add_grid(1, 1, [&](float s, float t) { return o + u * s + v * t; });
    }

    Mesh finish(const std::string& name) {
        mesh_.name = name;
        mesh_.face_sizes.assign(mesh_.position_indices.size() / 3, 3);
        return std::move(mesh_);
    }

  private:
    void add_triangle(uint32_t a, uint32_t b, uint32_t c) {
        for (const uint32_t corner : {a, b, c}) mesh_.position_indices.push_back(corner);
    }

    Mesh mesh_;
};

/// A cube blown up to a ball, with the bumps of noise at several scales: 12 cells^2 triangles.
Mesh make_body(int cells) {
    MeshMaker maker;
    const auto place = [](const Vec3f& cube) {
        const Vec3f p = normalize(cube);
        const float bumps =
            0.5f * samples::fractal_noise(p * 1.6f, 3, 11) + 0.03f * samples::fractal_noise(p * 14.0f, 3, 12);
        return p * (1 + bumps);
    };
    const Vec3f axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int side = 0; side < 6; ++side) {
        const float sign = side < 3 ? 1.0f : -1.0f;
        const Vec3f out = axes[side % 3] * sign, u = axes[(side + 1) % 3] * sign, v = axes[(side + 2) % 3];
        maker.add_grid(cells, cells, [&](float s, float t) {
            return place(out + u * std::tan((s - 0.5f) * kPi / 2) + v * std::tan((t - 0.5f) * kPi / 2));
        });
    }
    return maker.finish("body");
}

/// A tube along a (2, 3) torus knot, rough all over: 2 along x around triangles.
Mesh make_knot(int along, int around) {
    MeshMaker maker;
    const auto follow = [](float angle) {
        const float r = 2 + std::cos(3 * angle);
        return Vec3f{r * std::cos(2 * angle), std::sin(3 * angle), r * std::sin(2 * angle)};
    };
    maker.add_grid(around, along, [&](float s, float t) {
        const float angle = 2 * kPi * t, turn = 2 * kPi * s;
        const Vec3f center = follow(angle), ahead = normalize(follow(angle + 1e-3f) - center);
        const Vec3f side = normalize(cross(ahead, Vec3f{0, 1, 0})), up = cross(side, ahead);
        const Vec3f out = side * std::cos(turn) + up * std::sin(turn);
        const float bumps = 0.06f * samples::fractal_noise((center + out * 0.5f) * 3.0f, 5, 21);
        return center + out * (0.5f + bumps);
    });
    return maker.finish("knot");
}

struct HallDetail {
    int column_cells, drape_cells, vase_cells, arch_cells;
};

/// Length 40 along x, width 12 along z, height 10.
class Hall {
  public:
    explicit Hall(const HallDetail& detail) : detail_(detail) {}

    Mesh make() {
        maker_.add_quad({-20, 0, -6}, {0, 0, 12}, {40, 0, 0});
        maker_.add_quad({-20, 0, -6}, {40, 0, 0}, {0, 10, 0});
        maker_.add_quad({-20, 0, 6}, {0, 10, 0}, {40, 0, 0});
        maker_.add_quad({-20, 0, -6}, {0, 10, 0}, {0, 0, 12});
        maker_.add_quad({20, 0, -6}, {0, 0, 12}, {0, 10, 0});
        for (int k = 0; k < kBays; ++k) add_bay(-18 + 36 * float(k) / float(kBays - 1));
        return maker_.finish("hall");
    }

  private:
    static constexpr int kBays = 10;

    void add_bay(float x) {
        for (const float z : {-3.5f, 3.5f}) {
            add_column(x, z);
            add_arch(x, z);
        }
        add_drape(x + 1.8f, x < 0 ? -3.5f : 3.5f, uint32_t(40 + x));
        add_vase(x + 1.2f, x < 0 ? 4.6f : -4.6f);
    }

    void add_column(float x, float z) {
        const int cells = detail_.column_cells;
        maker_.add_grid(cells, cells, [&](float s, float t) {
            const float turn = 2 * kPi * s;
            const float flutes = 1 + 0.05f * std::cos(16 * turn);
            const float swell = 0.42f - 0.08f * t + 0.2f * std::exp(-30 * t) + 0.2f * std::exp(-30 * (1 - t));
            return Vec3f{x + swell * flutes * std::cos(turn), 6 * t, z - swell * flutes * std::sin(turn)};
        });
    }

    /// From column to column: half a ring.
    void add_arch(float x, float z) {
        const int cells = detail_.arch_cells;
        maker_.add_grid(cells, cells, [&](float s, float t) {
            const float turn = 2 * kPi * s, rise = kPi * t, radius = 2 + 0.3f * std::cos(turn);
            return Vec3f{x + 2 - radius * std::cos(rise), 6 + radius * std::sin(rise),
                         z + 0.3f * std::sin(turn)};
        });
    }

    void add_drape(float x, float z, uint32_t seed) {
        const int cells = detail_.drape_cells;
        maker_.add_grid(cells, cells, [&](float s, float t) {
            const float folds = 0.25f * std::sin(2 * kPi * (5 * s + 0.4f * t)) * (0.3f + t);
            const float ruffle = 0.08f * samples::fractal_noise({6 * s, 6 * t, 0}, 4, seed);
            return Vec3f{x + 2.6f * s - 1.3f, 8 - 5 * t, z + folds + ruffle};
        });
    }

    /// Small, and as fine as all else.
    void add_vase(float x, float z) {
        const int cells = detail_.vase_cells;
        maker_.add_grid(cells, cells, [&](float s, float t) {
            const float turn = 2 * kPi * s, radius = 0.1f + 0.08f * std::sin(2 * kPi * t);
            return Vec3f{x + radius * std::cos(turn), 0.5f * t, z - radius * std::sin(turn)};
        });
    }

    const HallDetail detail_;
    MeshMaker maker_;
};

Scene make_scene(Mesh mesh, const Camera& camera) {
    Scene scene;
    scene.meshes.push_back(std::move(mesh));
    scene.objects.push_back({.name = scene.meshes[0].name});
    Light sun;
    sun.direction = {-0.5f, -0.8f, -0.35f};
    sun.angle_degrees = 0;
    sun.strength = 3;
    scene.lights.push_back(sun);
    scene.camera = camera;
    return scene;
}

Camera look(const Vec3f& from, const Vec3f& to, float fov_degrees) {
    return {.from = from, .to = to, .fov_degrees = fov_degrees};
}

} // namespace

std::vector<std::string> structure_scene_names() { return {"body", "hall", "knot"}; }

Scene make_structure_scene(const std::string& name, MeshDetail detail) {
    const bool is_full = detail == MeshDetail::full;
    if (name == "body")
        return make_scene(make_body(is_full ? 76 : 9), look({1.6f, 1.4f, 3.4f}, {0, 0, 0}, 40));
    // No roof: the sun falls in.
    if (name == "hall")
        return make_scene(Hall(is_full ? HallDetail{46, 76, 46, 30} : HallDetail{6, 10, 6, 4}).make(),
                          look({-18.5f, 2.5f, 0.4f}, {0, 3, 0}, 65));
    if (name == "knot")
        return make_scene(is_full ? make_knot(4096, 256) : make_knot(256, 32),
                          look({3, 6, 7}, {0, 0, 0}, 40));
    throw Error(ErrorKind::usage, {fmt::format("unknown scene '{}'", name), "", "known: body, hall, knot"});
}

} // namespace relief
