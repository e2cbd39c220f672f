// The SIMD evaluation of tiles is the definition of the surface, bit for bit, and every box holds what is
// below it.
#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>
#include <set>

#include "cpu/traversal/kernels.h"
#include "prepare/prepared_scene.h"
#include "support/bodies.h"
#include "support/isas.h"

namespace relief {

namespace {

struct Free {
    void operator()(void* memory) const { std::free(memory); }
};

/// The same texels as binary16: normal numbers only, rounded toward zero.
std::shared_ptr<Texture> to_halves(const Texture& source) {
    auto result = std::make_shared<Texture>(source);
    result->floats.clear();
    for (const float value : source.floats) {
        const uint32_t bits = std::bit_cast<uint32_t>(value);
        const int exponent = int(bits >> 23 & 255) - 112;
        result->halves.push_back(exponent <= 0 ? 0
                                               : uint16_t((bits >> 16 & 0x8000) | uint32_t(exponent) << 10 |
                                                          (bits >> 13 & 0x3ff)));
    }
    return result;
}

void expect_tree_of_definition(const Surface& surface, uint32_t patch, const PatchLevels& levels,
                               const cpu::Kernels& kernels) {
    const std::unique_ptr<void, Free> memory(
        std::aligned_alloc(64, cpu::PatchTree::size_bytes(cpu::kTileLevel)));
    const int depth = std::max(0, int(levels.patch) - cpu::kTileLevel);
    for (uint32_t tile : {0u, (1u << 2 * depth) - 1}) {
        auto* tree = new (memory.get()) cpu::PatchTree;
        tree->key.patch = patch;
        tree->level = uint32_t(levels.patch - depth);
        tree->cell_x = (tile & ((1u << depth) - 1)) << cpu::kTileLevel;
        tree->cell_y = (tile >> depth) << cpu::kTileLevel;
        kernels.build_tree(surface, levels, *tree);
        const uint32_t side = 1u << tree->level;
        for (uint32_t b = 0; b < cpu::PatchTree::block_count(int(tree->level)); ++b) {
            uint32_t column = 0, row = 0;
            cpu::PatchTree::block_cell(int(tree->level), b, column, row);
            for (uint32_t v = 0; v < 15; ++v) {
                const uint32_t i = tree->cell_x + std::min(column + v % 5, side),
                               j = tree->cell_y + std::min(row + v / 5, side);
                const Vec3f expected = evaluate_vertex(surface, patch, levels, i, j);
                const uint32_t number = cpu::PatchTree::find_first_vertex(int(tree->level), b) +
                                        v / 5 * cpu::PatchTree::column_count(int(tree->level)) + v % 5;
                const Vec3f found{tree->vertices(0)[number], tree->vertices(1)[number],
                                  tree->vertices(2)[number]};
                ASSERT_EQ(found, expected)
                    << kernels.name << " patch " << patch << " vertex " << i << " " << j;
                for (int axis = 0; axis < 3; ++axis) {
                    const float value = tree->vertices(axis)[number];
                    const auto expect_inside = [&](const auto& node, uint32_t slot) {
                        EXPECT_LE(node.bounds[axis][slot], value);
                        EXPECT_GE(node.bounds[3 + axis][slot], value);
                    };
                    if (tree->level == 6) expect_inside(tree->root(), b / 32);
                    if (tree->level == 6) expect_inside(tree->node<6>(b / 32), b / 2 % 16);
                    if (tree->level == 5) expect_inside(tree->root(), b / 8);
                    if (tree->level == 5) expect_inside(tree->node<5>(b / 8), b % 8);
                    if (tree->level == 4) expect_inside(tree->node<4>(0), b / 2);
                    if (tree->level == 3) expect_inside(tree->node<3>(0), b);
                }
            }
        }
    }
}

void expect_definition(const Displacement& displacement, SubdivisionScheme scheme = SubdivisionScheme::none,
                       bool has_mips = false, const Vec2f& tile_shift = {}) {
    Scene scene = test::make_body_scene(test::make_torus(4, 6), displacement);
    scene.camera.from = {1.6f, 0.1f, 0.1f};
    if (displacement.is_udim)
        for (Vec2f& uv : scene.meshes[0].uvs) uv = {2 * uv.x + tile_shift.x, 2 * uv.y + tile_shift.y};
    scene.meshes[0].subdivision.scheme = scheme;
    scene.meshes[0].subdivision.level = 0;
    if (displacement.frame == FrameKind::file) test::add_flat_normals(scene.meshes[0]);
    RenderSettings settings;
    settings.surface.level = has_mips ? kAutoLevel : 0;
    settings.image.height = 60;
    const auto prepared = prepare_scene(scene, settings);
    const Surface& surface = prepared->surfaces[0];
    if (has_mips) EXPECT_GT(std::set(surface.mips.begin(), surface.mips.end()).size(), 4u);
    const PatchLevels cases[] = {{0, {0, 0, 0, 0}}, {1, {1, 0, 1, 0}}, {2, {2, 1, 0, 2}},
                                 {3, {3, 1, 2, 0}}, {4, {2, 4, 3, 4}}, {5, {5, 3, 0, 4}},
                                 {6, {4, 6, 5, 2}}, {7, {7, 7, 3, 6}}, {8, {8, 2, 7, 8}}};
    for (const Isa isa : test::machine_isas())
        for (const PatchLevels& levels : cases)
            for (const uint32_t patch : {0u, 5u, 18u, 23u}) {
                expect_tree_of_definition(surface, patch, levels, *cpu::find_kernels(isa));
                if (testing::Test::HasFatalFailure()) return;
            }
}

TEST(Evaluation, is_the_definition_in_every_space_and_wrap_mode) {
    for (const DisplacementSpace space :
         {DisplacementSpace::object, DisplacementSpace::tangent, DisplacementSpace::world})
        for (const WrapMode wrap : {WrapMode::clamp, WrapMode::repeat, WrapMode::mirror, WrapMode::black}) {
            Displacement displacement =
                test::make_displacement(test::make_random_map(37, 23, 0.1f, 3), space);
            displacement.wrap = wrap;
            displacement.midlevel = {0.01f, -0.02f, 0.03f};
            displacement.scale = {1.5f, 0.5f, -1};
            displacement.axes = {{2, 0, 1}, {1, -1, 1}};
            displacement.flip_v = wrap == WrapMode::repeat;
            expect_definition(displacement);
            if (testing::Test::HasFatalFailure()) return;
        }
}

TEST(Evaluation, is_the_definition_for_half_maps_height_maps_and_missing_tiles) {
    const auto map = test::make_random_map(40, 30, 0.1f, 9);
    Displacement displacement = test::make_displacement(to_halves(*map), DisplacementSpace::tangent);
    expect_definition(displacement);
    displacement = test::make_displacement(map, DisplacementSpace::tangent);
    displacement.type = DisplacementType::height;
    expect_definition(displacement);
    displacement = test::make_displacement(map, DisplacementSpace::object);
    displacement.is_udim = true;
    displacement.tiles[0].udim = 1002; // the mesh lies on 1001: nothing is displaced
    expect_definition(displacement);
}

TEST(Evaluation, is_the_definition_of_maps_with_tiles_and_of_faces_across_them) {
    for (const MapFilter filter : {MapFilter::none, MapFilter::cubic, MapFilter::mip})
        for (const float shift : {0.0f, 0.1f})
            for (const bool is_small : {false, true}) {
                Displacement displacement = test::make_displacement(
                    test::make_random_map(is_small ? 9 : 60, 16, 0.1f, 3), DisplacementSpace::tangent);
                displacement.is_udim = true, displacement.filter = filter;
                displacement.midlevel = {0.01f, -0.02f, 0.03f};
                displacement.flip_v = is_small;
                displacement.tiles.push_back({1002, test::make_random_map(60, 16, 0.1f, 4)});
                displacement.tiles.push_back({1011, test::make_random_map(31, 40, 0.1f, 5)});
                expect_definition(displacement, SubdivisionScheme::none, false, {shift, 2 * shift});
                if (testing::Test::HasFatalFailure()) return;
            }
}

TEST(Evaluation, is_the_definition_of_filtered_maps) {
    for (const DisplacementSpace space : {DisplacementSpace::object, DisplacementSpace::tangent})
        for (const SubdivisionScheme scheme : {SubdivisionScheme::none, SubdivisionScheme::catmark}) {
            Displacement displacement =
                test::make_displacement(test::make_random_map(510, 301, 0.1f, 3), space);
            displacement.wrap = WrapMode::repeat, displacement.filter = MapFilter::mip;
            expect_definition(displacement, scheme, true);
            if (testing::Test::HasFatalFailure()) return;
        }
}

TEST(Evaluation, is_the_definition_of_smooth_maps) {
    for (const MapFilter filter : {MapFilter::cubic, MapFilter::bspline})
        for (const WrapMode wrap : {WrapMode::clamp, WrapMode::repeat, WrapMode::mirror, WrapMode::black})
            for (const uint32_t width : {37u, 150u}) { // many and few samples a texel
                auto map = test::make_random_map(width, width - 14, 0.1f, 3);
                if (wrap == WrapMode::mirror) map = to_halves(*map);
                Displacement displacement = test::make_displacement(
                    map, wrap == WrapMode::repeat ? DisplacementSpace::object : DisplacementSpace::tangent);
                displacement.wrap = wrap, displacement.filter = filter;
                displacement.midlevel = {0.01f, -0.02f, 0.03f};
                displacement.flip_v = width == 150;
                expect_definition(displacement,
                                  width == 37 ? SubdivisionScheme::none : SubdivisionScheme::catmark);
                if (testing::Test::HasFatalFailure()) return;
            }
}

TEST(Evaluation, is_the_definition_on_bicubic_patches) {
    for (const DisplacementSpace space : {DisplacementSpace::object, DisplacementSpace::tangent})
        for (const WrapMode wrap : {WrapMode::clamp, WrapMode::black}) {
            Displacement displacement =
                test::make_displacement(test::make_random_map(37, 23, 0.1f, 3), space);
            displacement.wrap = wrap;
            expect_definition(displacement, SubdivisionScheme::catmark);
            if (testing::Test::HasFatalFailure()) return;
        }
}

TEST(Evaluation, is_the_definition_through_every_kind_of_frame) {
    Displacement displacement =
        test::make_displacement(test::make_random_map(37, 23, 0.1f, 3), DisplacementSpace::tangent);
    for (const FrameKind frame : {FrameKind::mikk, FrameKind::dpdu, FrameKind::file})
        for (const FrameLengths lengths : {FrameLengths::absolute, FrameLengths::relative}) {
            if (frame == FrameKind::file && lengths == FrameLengths::relative) continue;
            displacement.frame = frame, displacement.lengths = lengths;
            expect_definition(displacement);
            if (frame != FrameKind::file) expect_definition(displacement, SubdivisionScheme::catmark);
            if (testing::Test::HasFatalFailure()) return;
        }
}

void expect_boxes_hold_vertices(const Surface& surface, const PatchLevels& levels, uint32_t step) {
    const uint32_t level = levels.patch, side = cpu::DirectoryPlace::side(level, step);
    const uint32_t children = 1u << cpu::DirectoryPlace::shift(level, step);
    const uint32_t cells = (1u << level) / (side * children); // of a child
    std::vector<cpu::TileDirectory> directories(side * side);
    for (uint32_t k = 0; k < directories.size(); ++k) {
        directories[k].key.patch = 7;
        directories[k].key.tile = cpu::DirectoryPlace{step, k % side, k / side}.number();
        cpu::build_tile_directory(surface, levels, directories[k]);
    }
    for (uint32_t j = 0; j <= 1u << level; j += 3)
        for (uint32_t i = 0; i <= 1u << level; i += 3) {
            const Vec3f p = evaluate_vertex(surface, 7, levels, i, j);
            const float value[3] = {p.x, p.y, p.z};
            const uint32_t x = std::min(i / cells, side * children - 1),
                           y = std::min(j / cells, side * children - 1);
            const uint32_t child = y % children * children + x % children;
            const cpu::Node16& node = directories[y / children * side + x / children].node;
            for (int axis = 0; axis < 3; ++axis) {
                ASSERT_LE(node.bounds[axis][child], value[axis]);
                ASSERT_GE(node.bounds[3 + axis][child], value[axis]);
            }
        }
}

TEST(Evaluation, boxes_of_a_directory_hold_the_vertices_of_their_cells) {
    for (const uint8_t level : {uint8_t(7), uint8_t(8), uint8_t(10)}) {
        const Scene scene = test::make_body_scene(
            test::make_torus(4, 6),
            test::make_displacement(test::make_random_map(256, 192, 0.1f, 4), DisplacementSpace::tangent));
        RenderSettings settings;
        settings.surface.level = 0;
        const auto prepared = prepare_scene(scene, settings);
        const Surface& surface = prepared->surfaces[0];
        const PatchLevels levels{level, {level, 3, uint8_t(level - 1), 0}};
        for (uint32_t step = 0; step < cpu::DirectoryPlace::step_count(level); ++step)
            expect_boxes_hold_vertices(surface, levels, step);
        if (testing::Test::HasFatalFailure()) return;
    }
}

} // namespace

} // namespace relief
