#include "lab/scenes/character_scenes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "lab/scenes/box_mesh.h"
#include "math/vec.h"
#include "relief/error.h"
#include "samples/bake.h"
#include "samples/noise.h"
#include "samples/stage.h"

namespace relief {

namespace {

using namespace samples;

// The body in lattice steps: 26 high, arms stretched out to 32.
constexpr float kBodyScale = 1.75f / 26; ///< metres a step
constexpr Vec2f kShoulder{3, 19};        ///< x and y of the joint, steps
constexpr int kGutter = 1;               ///< steps between strips and ends of boxes in the map
constexpr uint32_t kBodySeed = 501, kHeadSeed = 701, kPlaceSeed = 91;
constexpr int kCrowdColumns = 4, kCrowdRows = 5;

std::vector<LatticeBox> make_body_boxes() {
    std::vector<LatticeBox> boxes = {{{-3, 12, -2}, {3, 21, 2}, 1},  // torso
                                     {{-1, 21, -1}, {1, 22, 1}, 1},  // neck
                                     {{-2, 22, -2}, {2, 26, 2}, 1}}; // head
    const LatticeBox limbs[] = {{{3, 18, -1}, {13, 20, 1}, 0},       // arm
                                {{13, 18, -2}, {16, 20, 2}, 0},      // hand
                                {{1, 2, -1}, {3, 12, 1}, 1},         // leg
                                {{1, 0, -1}, {3, 2, 4}, 2}};         // foot
    for (LatticeBox limb : limbs) {
        boxes.push_back(limb);
        limb.low[0] = -std::exchange(limb.high[0], -limb.low[0]);
        boxes.push_back(limb);
    }
    return boxes;
}

/// The sides around a box in one piece, or one of its ends, in lattice steps.
struct Island {
    size_t box = 0;
    int side = 0; ///< 0: all four around the axis
    int width = 0, height = 0;
    int x = 0, y = 0;
};

std::vector<Island> list_islands(const std::vector<LatticeBox>& boxes) {
    std::vector<Island> islands;
    for (size_t box = 0; box < boxes.size(); ++box) {
        const auto [first, height] = find_side_size(boxes[box], 0);
        const int second = find_side_size(boxes[box], 1)[0];
        islands.push_back({box, 0, 2 * (first + second), height});
        for (const int end : {kLowEnd, kHighEnd}) {
            const auto [across, along] = find_side_size(boxes[box], end);
            islands.push_back({box, end, across, along});
        }
    }
    std::ranges::stable_sort(islands, std::greater(), &Island::height);
    return islands;
}

/// Places the islands, highest first, on shelves of a square; returns whether they fit.
bool place_on_shelves(std::vector<Island>& islands, int square) {
    int x = kGutter, y = kGutter, shelf = 0;
    for (Island& island : islands) {
        if (x + island.width + kGutter > square) x = kGutter, y += std::exchange(shelf, 0) + kGutter;
        island.x = x, island.y = y;
        x += island.width + kGutter, shelf = std::max(shelf, island.height);
        if (x > square || y + shelf + kGutter > square) return false;
    }
    return true;
}

/// The rectangle of each side of each box; the four around an axis share their edges.
std::vector<std::array<UvRectangle, kBoxSides>> place_sides(const std::vector<LatticeBox>& boxes) {
    std::vector<Island> islands = list_islands(boxes);
    int square = 1;
    while (!place_on_shelves(islands, square)) ++square;
    std::vector<std::array<UvRectangle, kBoxSides>> rectangles(boxes.size());
    const float step = 1 / float(square);
    for (const Island& island : islands) {
        float u = float(island.x) * step;
        for (int side = island.side; side < (island.side == 0 ? kLowEnd : island.side + 1); ++side) {
            const auto [across, along] = find_side_size(boxes[island.box], side);
            const Vec2f size{float(across) * step, float(along) * step};
            rectangles[island.box][size_t(side)] = {{u, float(island.y) * step}, size};
            u += size.x;
        }
    }
    return rectangles;
}

/// Lets the arms, which are stretched out, hang down to both sides.
Vec3f lower_arm(Vec3f p) {
    const float side = p.x < 0 ? -1.0f : 1.0f, x = std::fabs(p.x);
    const float angle = -0.8f * smooth_step(2, 6, x), c = std::cos(angle), s = std::sin(angle);
    const float across = x - kShoulder.x, up = p.y - kShoulder.y;
    if (x <= kShoulder.x - 1) return p;
    return {side * (kShoulder.x + c * across - s * up), kShoulder.y + s * across + c * up, p.z};
}

BoxMesh make_body(CharacterDetail detail) {
    const int cells = detail == CharacterDetail::full ? 4 : 1;
    const std::vector<LatticeBox> boxes = make_body_boxes();
    const auto rectangles = place_sides(boxes);
    BoxMesh body =
        make_box_mesh(boxes, cells, [&](size_t box, int side) { return rectangles[box][size_t(side)]; });
    smooth_positions(body.mesh, 5 * cells * cells);
    for (Vec3f& p : body.mesh.positions) p = lower_arm(p) * kBodyScale;
    add_crease_loop(body, 1, cells, kInfiniteSharpness);                             // of the shoes
    add_crease_loop(body, 1, 14 * cells, 2.5f);                                      // the belt
    for (const int wrist : {-12, 12}) add_crease_loop(body, 0, wrist * cells, 1.2f); // the cuffs
    body.mesh.name = "body";
    return body;
}

/// A place of the unit ball as one of a head that looks along +z and is about 2.4 high.
Vec3f shape_head(const Vec3f& n) {
    const float jaw = smooth_step(0.1f, -0.9f, n.y), front = smooth_step(-0.2f, 0.9f, n.z);
    Vec3f p{n.x * (0.86f - 0.3f * jaw), n.y * 1.2f, n.z * (1.02f - 0.12f * jaw)};
    const auto add_bump = [&](const Vec3f& centre, float radius, float height) {
        const float near = smooth_step(radius, 0, length(n - normalize(centre)));
        p += n * (height * near);
    };
    add_bump({0, -0.08f, 1}, 0.32f, 0.26f);                                               // nose
    for (const float x : {-1.0f, 1.0f}) add_bump({0.36f * x, 0.16f, 0.9f}, 0.3f, -0.09f); // eyes
    for (const float x : {-1.0f, 1.0f}) add_bump({x, 0, -0.1f}, 0.24f, 0.16f);            // ears
    p.z += 0.08f * jaw * front;
    return p;
}

/// Sides around y, from x = low on: left, front, right, back; then bottom and top. A tile each for the front,
/// for both sides of the face, for back and top, and for the bottom.
UvRectangle place_head_side(size_t, int side) {
    const struct {
        float u, v, width;
    } places[kBoxSides] = {{1.05f, 0.25f, 0.4f}, {0.05f, 0.05f, 0.9f}, {1.55f, 0.25f, 0.4f},
                           {2.05f, 0.25f, 0.4f}, {3.2f, 0.2f, 0.6f},   {2.55f, 0.25f, 0.4f}};
    const auto& place = places[side];
    return {{place.u, place.v}, {place.width, place.width}};
}

BoxMesh make_head(CharacterDetail detail) {
    const int cells = detail == CharacterDetail::full ? 60 : 15;
    BoxMesh head = make_box_mesh({{{0, 0, 0}, {1, 1, 1}, 1}}, cells, place_head_side);
    for (Vec3f& p : head.mesh.positions) {
        const auto bend = [](float x) { return std::tan((2 * x - 1) * 0.7853982f); };
        p = shape_head(normalize(Vec3f{bend(p.x), bend(p.y), bend(p.z)}));
    }
    head.mesh.name = "head";
    return head;
}

/// Muscles and folds of a surface `size` units high, sideways too.
Vec3f compute_relief(const SurfacePoint& at, float size, uint32_t seed) {
    const Vec3f p = at.position * (1 / size);
    const float muscle = 0.012f * fractal_noise(p * 9.0f, 3, seed);
    const float fold = 0.004f * ridged_noise(p * 34.0f, 3, seed + 1);
    const Vec3f sideways{noise(p * 21.0f, seed + 2), noise(p * 21.0f, seed + 3), noise(p * 21.0f, seed + 4)};
    return (at.normal * (muscle + fold) + (sideways - at.normal * dot(sideways, at.normal)) * 0.004f) * size;
}

struct MapRecipe {
    uint32_t size = 512, seed = 0;
    float height = 1; ///< of the body, scene units
    int tiles = 1;    ///< in a row, from 1001 on
};

Displacement make_map(const std::string& name, const SurfaceFinder& surface, const MapRecipe& recipe) {
    Displacement map;
    map.name = name, map.space = DisplacementSpace::object, map.is_udim = recipe.tiles > 1;
    for (int tile = 0; tile < recipe.tiles; ++tile) {
        const auto sample = [&](Vec2f uv) {
            const SurfacePoint at = surface.find({uv.x + float(tile), uv.y});
            return MapSample{compute_relief(at, recipe.height, recipe.seed), {}};
        };
        map.tiles.push_back({1001 + tile, bake_maps(name, recipe.size, Texels::halves, sample).displacement});
    }
    return map;
}

uint32_t choose_map_size(uint32_t full, CharacterDetail detail) {
    return detail == CharacterDetail::full ? full : full / 8;
}

Scene start_scene(Mesh mesh) {
    Scene scene;
    mesh.subdivision.scheme = SubdivisionScheme::catmark;
    scene.meshes.push_back(std::move(mesh));
    scene.materials.push_back(make_character_material());
    scene.environment = make_character_sky();
    return scene;
}

void add_object(Scene& scene, const std::string& name, Displacement map, const Affine& place) {
    scene.objects.push_back({name, 0, uint32_t(scene.displacements.size()), 0, place});
    scene.displacements.push_back(std::move(map));
}

void look_from(Camera& camera, const Vec3f& from, const Vec3f& to, float fov_degrees) {
    camera.from = from, camera.to = to, camera.fov_degrees = fov_degrees;
}

Scene make_body_scene(CharacterDetail detail) {
    const BoxMesh body = make_body(detail);
    Scene scene = start_scene(body.mesh);
    const MapRecipe recipe{.size = choose_map_size(1024, detail), .seed = kBodySeed, .height = 1.75f};
    add_object(scene, "body", make_map("body", SurfaceFinder(body), recipe), {});
    look_from(scene.camera, {1.2f, 1.5f, 4.6f}, {0, 0.87f, 0}, 28);
    return scene;
}

Scene make_head_scene(CharacterDetail detail) {
    const BoxMesh head = make_head(detail);
    Scene scene = start_scene(head.mesh);
    const MapRecipe recipe{
        .size = choose_map_size(512, detail), .seed = kHeadSeed, .height = 2.4f, .tiles = 4};
    add_object(scene, "head", make_map("head", SurfaceFinder(head), recipe), {});
    look_from(scene.camera, {1.6f, 0.5f, 5.2f}, {0, 0, 0}, 30);
    return scene;
}

Scene make_crowd_scene(CharacterDetail detail) {
    const BoxMesh body = make_body(detail);
    const SurfaceFinder surface(body);
    Scene scene = start_scene(body.mesh);
    Random random(kPlaceSeed);
    for (int k = 0; k < kCrowdColumns * kCrowdRows; ++k) {
        const int column = k % kCrowdColumns, row = k / kCrowdColumns;
        const float x = (float(column) - 1.5f) * 1.7f + random.range(-0.1f, 0.1f);
        const float z = float(-row) * 1.6f + random.range(-0.2f, 0.2f);
        const MapRecipe recipe{
            .size = choose_map_size(512, detail), .seed = kBodySeed + 10 * uint32_t(k + 1), .height = 1.75f};
        const std::string name = fmt::format("body_{}", k);
        add_object(scene, name, make_map(name, surface, recipe), place({x, 0, z}, 1, random.range(-25, 25)));
    }
    look_from(scene.camera, {0, 12, 11}, {0, 0.3f, -3.2f}, 28);
    return scene;
}

} // namespace

std::vector<std::string> character_scene_names() { return {"body", "head", "crowd"}; }

Scene make_character_scene(const std::string& name, CharacterDetail detail) {
    if (name == "body") return make_body_scene(detail);
    if (name == "head") return make_head_scene(detail);
    if (name == "crowd") return make_crowd_scene(detail);
    throw Error(ErrorKind::usage,
                {fmt::format("unknown scene '{}'", name), "", "the scenes are body, head and crowd"});
}

Environment make_character_sky() {
    Environment environment;
    environment.texture = make_sky(sky_direction(40, 35), {1.0f, 0.86f, 0.68f});
    return environment;
}

Material make_character_material() {
    Material white;
    white.name = "white", white.roughness = 1, white.ior = 1;
    return white;
}

} // namespace relief
