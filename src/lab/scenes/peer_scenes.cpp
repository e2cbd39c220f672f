// Stones for measurements: a cube blown up to a ball, six charts of one map, ridges that lean over.
#include "lab/scenes/peer_scenes.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "math/vec.h"
#include "relief/error.h"
#include "samples/bake.h"
#include "samples/noise.h"
#include "samples/stage.h"

namespace relief {

namespace {

using namespace samples;

constexpr int kMapSize = 1024, kChartsAcross = 3, kChartsDown = 2;
constexpr int kCellsPerSide = 10; ///< quads along an edge of the cube

constexpr int kChartWidth = kMapSize / kChartsAcross, kChartHeight = kMapSize / kChartsDown;
/// Texels from edge to edge of a side of the cube: so many a quad that every corner lies on a texel's middle.
constexpr int kSpanAcross = (kChartWidth - 1) / kCellsPerSide * kCellsPerSide;
constexpr int kSpanDown = (kChartHeight - 1) / kCellsPerSide * kCellsPerSide;

/// Point of the unit ball at (s, t) in [0, 1]^2 of a cube's side; from outside s runs right and t up.
Vec3f place_on_ball(int side, float s, float t) {
    const float a = std::tan((2 * s - 1) * std::numbers::pi_v<float> / 4);
    const float b = std::tan((2 * t - 1) * std::numbers::pi_v<float> / 4);
    const Vec3f points[6] = {{1, b, -a}, {-1, b, a}, {a, 1, -b}, {a, -1, b}, {a, b, 1}, {-a, b, -1}};
    return normalize(points[side]);
}

/// Where (s, t) of a side lies in the map.
Vec2f place_in_map(int side, float s, float t) {
    const float x = float(side % kChartsAcross * kChartWidth) + s * kSpanAcross + 0.5f;
    const float y = float(side / kChartsAcross * kChartHeight) + t * kSpanDown + 0.5f;
    return {x / kMapSize, y / kMapSize};
}

/// How far the ball's point `n` moves: outward by ridges, and sideways the more the higher they are.
Vec3f compute_displacement(const Vec3f& n) {
    const float ridge = std::clamp(2 * (ridged_noise(n * 3.0f, 5, 11) - 0.35f), 0.0f, 1.0f);
    Vec3f sideways = Vec3f{noise(n * 9.0f, 12), noise(n * 9.0f, 13), noise(n * 9.0f, 14)} +
                     cross(Vec3f{0.3f, 1, 0.2f}, n) * 0.6f;
    sideways = sideways - n * dot(sideways, n);
    const Vec3f grain{noise(n * 70.0f, 15), noise(n * 70.0f, 16), noise(n * 70.0f, 17)};
    return n * (0.20f * ridge) + sideways * (0.22f * ridge * ridge) + grain * 0.01f;
}

std::shared_ptr<const Texture> make_map() {
    const auto sample = [](Vec2f uv) {
        const float x = uv.x * kMapSize - 0.5f, y = uv.y * kMapSize - 0.5f;
        const int column = std::min(int(x) / kChartWidth, kChartsAcross - 1), row = int(y) / kChartHeight;
        const float s = (x - float(column * kChartWidth)) / kSpanAcross;
        const float t = (y - float(row * kChartHeight)) / kSpanDown;
        const Vec3f n = place_on_ball(row * kChartsAcross + column, std::min(s, 1.0f), std::min(t, 1.0f));
        return MapSample{compute_displacement(n), {}};
    };
    return bake_maps("rock", kMapSize, Texels::floats, sample).displacement;
}

/// Corners on the edges of the cube are shared; their uvs are not.
class RockMaker {
  public:
    void add(const Vec3f& centre, float radius) {
        const size_t first = mesh_.positions.size();
        for (int side = 0; side < 6; ++side)
            for (int j = 0; j < kCellsPerSide; ++j)
                for (int i = 0; i < kCellsPerSide; ++i) {
                    for (const auto& [a, b] : {std::pair{i, j}, {i + 1, j}, {i + 1, j + 1}, {i, j + 1}})
                        add_corner(first, centre, radius, side, a, b);
                    mesh_.face_sizes.push_back(4);
                }
    }

    Mesh finish(const std::string& name) {
        mesh_.name = name;
        return std::move(mesh_);
    }

  private:
    void add_corner(size_t first, const Vec3f& centre, float radius, int side, int i, int j) {
        const float s = float(i) / kCellsPerSide, t = float(j) / kCellsPerSide;
        const Vec3f p = centre + place_on_ball(side, s, t) * radius;
        size_t vertex = first;
        // A tenth of the least distance between two corners: rounding differs from side to side.
        while (vertex < mesh_.positions.size() &&
               length(mesh_.positions[vertex] - p) > 0.1f * radius / kCellsPerSide)
            ++vertex;
        if (vertex == mesh_.positions.size()) mesh_.positions.push_back(p);
        mesh_.position_indices.push_back(uint32_t(vertex));
        mesh_.uv_indices.push_back(uint32_t(mesh_.uvs.size()));
        mesh_.uvs.push_back(place_in_map(side, s, t));
    }

    Mesh mesh_;
};

struct Layout {
    const char* name;
    int count;
    float radius;
    Vec3f from, to;
};

constexpr Layout kLayouts[] = {{"rock", 1, 1.0f, {1.2f, 1.0f, 3.6f}, {}},
                               {"rocks", 10, 0.52f, {0.8f, 0.6f, 5.2f}, {}},
                               {"rock_close", 1, 1.0f, {0.9f, 0.7f, 1.75f}, {0, 0.2f, 0.2f}}};

const Layout& find_layout(const std::string& name) {
    for (const Layout& layout : kLayouts)
        if (name == layout.name) return layout;
    throw Error(ErrorKind::usage,
                {fmt::format("unknown scene '{}'", name), "", "rock, rocks and rock_close are there"});
}

/// Two rows of five, each shifted a little; an only rock stays at the origin.
Vec3f place_rock(int index, int count, Random& random) {
    if (count == 1) return {0, 0, 0};
    const float x = float(index % 5 - 2) * 1.05f + random.range(-0.15f, 0.15f);
    const float y = (float(index / 5) - 0.5f) * 1.15f + random.range(-0.15f, 0.15f);
    return {x, y, random.range(-0.6f, 0.6f)};
}

} // namespace

std::vector<std::string> peer_scene_names() { return {"rock", "rocks", "rock_close"}; }

Scene make_peer_scene(const std::string& name, float roughness, PeerWorld world) {
    const Layout& layout = find_layout(name);
    Scene scene;
    Displacement displacement;
    displacement.name = "rock", displacement.space = DisplacementSpace::object;
    displacement.scale = Vec3f{1, 1, 1} * (layout.radius * roughness);
    displacement.tiles.push_back({1001, make_map()});
    scene.displacements.push_back(displacement);
    Material white;
    white.name = "white", white.roughness = 1, white.ior = 1;
    scene.materials.push_back(white);
    RockMaker maker;
    Random random(77);
    for (int k = 0; k < layout.count; ++k) maker.add(place_rock(k, layout.count, random), layout.radius);
    scene.meshes.push_back(maker.finish(name));
    scene.objects.push_back({name, 0, 0, 0, {}});
    scene.camera.from = layout.from, scene.camera.to = layout.to, scene.camera.fov_degrees = 40;
    Environment environment;
    if (world == PeerWorld::sky) environment.texture = make_sky(sky_direction(40, 35), {1.0f, 0.86f, 0.68f});
    scene.environment = environment;
    return scene;
}

} // namespace relief
