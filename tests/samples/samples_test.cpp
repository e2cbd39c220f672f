#include "relief/samples.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "base/parallel.h"
#include "math/affine.h"
#include "relief/error.h"
#include "relief/half.h"
#include "samples/models.h"
#include "samples/noise.h"
#include "surface/patch/surface.h"

namespace relief {
namespace {

size_t count_displaced_patches(const Scene& scene) {
    size_t count = 0;
    for (const Object& object : scene.objects)
        if (object.displacement != kNoIndex) count += scene.meshes[object.mesh].face_sizes.size();
    return count;
}

float texel_channel(const Texture& texture, size_t i) {
    return texture.halves.empty() ? texture.floats[i] : half_to_float(texture.halves[i]);
}

/// The most expensive scene holds every model but the ear; it is made once for all tests.
const Scene& party() {
    static const Scene scene = make_sample_scene("party", Instancing::none);
    return scene;
}

const samples::Model& ear() {
    static const samples::Model model = samples::make_ear();
    return model;
}

/// Share of cells, one a texel along either axis of a patch, whose displaced normal looks away from the base
/// normal.
double measure_folding(const Mesh& mesh, const Displacement& displacement) {
    const Surface surface = make_surface(mesh, &displacement, {});
    const float size = float(displacement.tiles[0].texture->width);
    samples::Random random(17);
    int folded = 0;
    constexpr int kCells = 30000;
    for (int k = 0; k < kCells; ++k) {
        const uint32_t patch =
            std::min(uint32_t(random.unit() * float(surface.patch_count())), surface.patch_count() - 1);
        const Quad quad = surface.quads[patch];
        const Vec2f edge = surface.uvs[quad.vertex[1]] - surface.uvs[quad.vertex[0]];
        int level = 0;
        while (level < 11 && float(1 << level) < length(edge) * size) ++level;
        const uint32_t cells = 1u << level;
        const uint32_t i = std::min(uint32_t(random.unit() * float(cells)), cells - 1);
        const uint32_t j = std::min(uint32_t(random.unit() * float(cells)), cells - 1);
        const uint8_t all = uint8_t(level);
        const PatchLevels levels{all, {all, all, all, all}};
        const auto at = [&](uint32_t x, uint32_t y) { return evaluate_vertex(surface, patch, levels, x, y); };
        const Vec3f normal = cross(at(i + 1, j + 1) - at(i, j), at(i, j + 1) - at(i + 1, j));
        const auto corner = [&](int c) { return surface.position(quad.vertex[size_t(c)]); };
        const Vec3f base = cross(corner(2) - corner(0), corner(3) - corner(1));
        folded += dot(normal, base) < 0;
    }
    return double(folded) / kCells;
}

TEST(SampleScenes, have_at_least_the_patches_of_paper_1) {
    EXPECT_GE(count_displaced_patches(party()), 106000u);
    for (const Object& object : party().objects)
        if (object.name.starts_with("pumpkin"))
            EXPECT_EQ(party().meshes[object.mesh].face_sizes.size(), 800u);
    EXPECT_GE(samples::make_trunk_body(samples::TrunkShape{}).patch_count(), 3100);
    validate_scene(party());
}

TEST(SampleScenes, of_several_trunks_own_their_meshes_or_share_one) {
    const Scene own = make_sample_scene("barks", Instancing::none);
    EXPECT_GE(count_displaced_patches(own), 22000u);
    EXPECT_EQ(own.displacements.size(), 1u);
    std::set<uint32_t> meshes;
    for (const Object& object : own.objects) meshes.insert(object.mesh);
    EXPECT_EQ(meshes.size(), own.objects.size());

    const Scene shared = make_sample_scene("barks", Instancing::shared);
    EXPECT_EQ(count_displaced_patches(shared), count_displaced_patches(own));
    EXPECT_EQ(shared.meshes.size(), 2u) << "the trunk and the ground";
}

TEST(SampleScenes, of_materials_show_twelve_of_them_on_one_displaced_body) {
    const Scene scene = make_sample_scene("materials", Instancing::shared);
    validate_scene(scene);
    EXPECT_EQ(scene.displacements.size(), 1u);
    std::set<uint32_t> materials;
    bool has_coat = false, has_fuzz = false, has_metal = false;
    for (const Object& object : scene.objects) {
        if (object.displacement == kNoIndex) continue;
        materials.insert(object.material);
        const Material& material = scene.materials.at(object.material);
        EXPECT_EQ(material.name, object.name);
        has_coat |= material.coat_weight > 0, has_fuzz |= material.fuzz_weight > 0;
        has_metal |= material.metallic == 1;
    }
    EXPECT_EQ(materials.size(), 12u);
    EXPECT_TRUE(has_coat && has_fuzz && has_metal);
}

TEST(SampleScenes, names_are_known_and_others_refused) {
    EXPECT_EQ(sample_scene_names(),
              (std::vector<std::string>{"pumpkin", "bark", "barks", "party", "ear", "materials", "shot"}));
    try {
        make_sample_scene("pumpkn", Instancing::none);
        FAIL() << "an unknown name must be refused";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::usage);
        EXPECT_NE(error.hint().find("pumpkin"), std::string::npos);
    }
}

TEST(PartyScene, mixes_four_models_and_a_few_thousand_triangles) {
    std::set<uint32_t> models;
    size_t triangles = 0, displaced_meshes = 0;
    std::set<uint32_t> meshes;
    for (const Object& object : party().objects) {
        const Mesh& mesh = party().meshes[object.mesh];
        if (object.displacement != kNoIndex) {
            models.insert(object.displacement);
            meshes.insert(object.mesh);
            ++displaced_meshes;
        } else {
            triangles += size_t(std::count(mesh.face_sizes.begin(), mesh.face_sizes.end(), 3u));
        }
    }
    EXPECT_GE(models.size(), 4u);
    EXPECT_EQ(meshes.size(), displaced_meshes) << "nothing is instanced";
    EXPECT_GT(triangles, 500u);
    EXPECT_LT(triangles, 20000u);
    EXPECT_LE(party().displacements.size(), 6u);
}

TEST(SampleMaps, are_large_and_finite) {
    std::vector<Displacement> displacements = party().displacements;
    displacements.push_back(ear().displacement);
    for (const Displacement& displacement : displacements) {
        const Texture& texture = *displacement.tiles[0].texture;
        EXPECT_GE(texture.width, 2048u);
        EXPECT_GE(texture.height, 2048u);
        bool is_finite = true;
        for (size_t i = 0; i < texture.value_count(); i += 7)
            is_finite = is_finite && std::isfinite(texel_channel(texture, i));
        EXPECT_TRUE(is_finite) << displacement.name;
    }
}

TEST(SampleMaps, fold_over_in_at_least_one_cell_of_twenty) {
    std::set<uint32_t> seen;
    for (const Object& object : party().objects) {
        if (object.displacement == kNoIndex || !seen.insert(object.displacement).second) continue;
        const Displacement& displacement = party().displacements[object.displacement];
        EXPECT_GE(measure_folding(party().meshes[object.mesh], displacement), 0.05) << displacement.name;
    }
    const Mesh quad = ear().make_mesh([](const Vec3f& p) { return p; });
    EXPECT_GE(measure_folding(quad, ear().displacement), 0.05) << "ear";
}

TEST(SampleMeshes, of_bodies_are_closed_quads) {
    for (const Object& object : party().objects) {
        if (object.displacement == kNoIndex) continue;
        const Mesh& mesh = party().meshes[object.mesh];
        std::map<std::pair<uint32_t, uint32_t>, int> edges;
        size_t corner = 0;
        for (uint32_t size : mesh.face_sizes) {
            ASSERT_EQ(size, 4u);
            for (uint32_t k = 0; k < 4; ++k)
                ++edges[{mesh.position_indices[corner + k], mesh.position_indices[corner + (k + 1) % 4]}];
            corner += 4;
        }
        size_t open = 0;
        for (const auto& [edge, uses] : edges) open += uses != 1 || !edges.count({edge.second, edge.first});
        EXPECT_EQ(open, 0u) << mesh.name << ": an edge runs once each way";
    }
}

TEST(SampleMeshes, have_no_face_without_area) {
    for (const Mesh& mesh : party().meshes) {
        size_t corner = 0;
        float least = INFINITY, largest = 0;
        for (uint32_t size : mesh.face_sizes) {
            const auto at = [&](uint32_t k) {
                return mesh.positions[mesh.position_indices[corner + k % size]];
            };
            const Vec3f normal = cross(at(2) - at(0), at(3) - at(1));
            least = std::min(least, length(normal));
            largest = std::max(largest, length(normal));
            corner += size;
        }
        EXPECT_GT(least, 1e-3f * largest) << mesh.name;
    }
}

TEST(SampleMeshes, look_outwards) {
    for (const Object& object : party().objects) {
        const Mesh& mesh = party().meshes[object.mesh];
        if (object.displacement == kNoIndex) continue;
        double volume = 0;
        for (size_t f = 0; f < mesh.face_sizes.size(); ++f) {
            const auto at = [&](size_t k) { return mesh.positions[mesh.position_indices[4 * f + k]]; };
            volume += dot(at(0), cross(at(1), at(2))) + dot(at(0), cross(at(2), at(3)));
        }
        EXPECT_GT(volume, 0) << mesh.name;
    }
}

TEST(SampleModels, are_the_same_for_any_number_of_threads) {
    const Displacement* shared = nullptr;
    for (const Displacement& displacement : party().displacements)
        if (displacement.name == "coral") shared = &displacement;
    ASSERT_NE(shared, nullptr);
    samples::Model alone;
    with_threads(1, [&] { alone = samples::make_coral(); });
    EXPECT_EQ(shared->tiles[0].texture->halves, alone.displacement.tiles[0].texture->halves);
}

} // namespace
} // namespace relief
