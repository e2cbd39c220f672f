// Trees over one mesh by way of lab/trees.h: every builder and walk finds the hits of all triangles one
// by one.
#include "lab/trees.h"

#include <cmath>
#include <memory>
#include <random>

#include <gtest/gtest.h>

#include "formulas/object_ray.h"
#include "lab/scenes/structure_scenes.h"
#include "lab/tree_workshop.h"
#include "relief/error.h"

namespace relief {
namespace {

std::vector<Ray> make_rays(size_t count) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> unit(-1, 1);
    std::vector<Ray> rays(count);
    for (Ray& ray : rays) {
        ray.origin = {18 * unit(random), 4 + 4 * unit(random), 5 * unit(random)};
        ray.direction = {unit(random), unit(random), unit(random)};
    }
    return rays;
}

TreeHit find_nearest(const Mesh& mesh, const Ray& ray) {
    TreeHit best;
    const scalar::ObjectRay object_ray = scalar::make_object_ray(ray.origin, ray.direction);
    for (uint32_t k = 0; k < mesh.face_sizes.size(); ++k) {
        const auto shear = [&](uint32_t corner) {
            return scalar::shear_vertex(object_ray, mesh.positions[mesh.position_indices[3 * k + corner]]);
        };
        const float t =
            scalar::intersect_sheared(object_ray, shear(0), shear(1), shear(2), ray.t_min, ray.t_max).t;
        if (t < best.t) best = {t, k};
    }
    return best;
}

class MeshTreesTest : public testing::Test {
  protected:
    MeshTreesTest()
        : scene_(make_structure_scene("hall", MeshDetail::reduced)),
          trees_(scene_.meshes[0], {}),
          rays_(make_rays(400)),
          hits_(rays_.size()) {
        for (const Ray& ray : rays_) expected_.push_back(find_nearest(scene_.meshes[0], ray));
    }

    void expect_hits(const TreeQuery& query, const std::string& name) {
        size_t different = 0;
        for (size_t k = 0; k < rays_.size(); ++k)
            different += query.kind == HitKind::any
                             ? std::isinf(hits_[k].t) != std::isinf(expected_[k].t)
                             : hits_[k].t != expected_[k].t || hits_[k].primitive != expected_[k].primitive;
        EXPECT_EQ(different, 0u) << name;
    }

    Scene scene_;
    MeshTrees trees_;
    std::vector<Ray> rays_;
    std::vector<TreeHit> hits_, expected_;
};

TEST_F(MeshTreesTest, every_walk_of_every_tree_finds_the_hits_of_brute_force) {
    for (const TreeKind kind : tree_kinds()) {
        trees_.build(kind);
        for (const TraversalKind traversal : tree_traversals(kind))
            for (const HitKind hit : {HitKind::closest, HitKind::any})
                for (const Counting counting : {Counting::off, Counting::on}) {
                    const TreeQuery query{traversal, hit, counting};
                    const TreeCast cast = trees_.cast(query, {rays_, hits_, {}});
                    expect_hits(query, std::string(tree_name(kind)) + ", " + traversal_name(traversal));
                    EXPECT_EQ(cast.bytes > 0, counting == Counting::on);
                    EXPECT_EQ(cast.triangle_tests > 0, counting == Counting::on);
                }
    }
}

TEST_F(MeshTreesTest, rays_that_are_no_numbers_hit_nothing) {
    for (size_t k = 0; k < rays_.size(); k += 7) {
        Ray& ray = rays_[k];
        float* const places[] = {&ray.origin.x,    &ray.origin.z,    &ray.direction.x,
                                 &ray.direction.y, &ray.direction.z, &ray.t_min};
        *places[k / 7 % std::size(places)] = k % 2 == 0 ? NAN : INFINITY;
        expected_[k] = {};
    }
    for (const TreeKind kind : tree_kinds()) {
        trees_.build(kind);
        for (const TraversalKind traversal : tree_traversals(kind))
            for (const HitKind wanted : {HitKind::closest, HitKind::any}) {
                const TreeQuery query{traversal, wanted};
                trees_.cast(query, {rays_, hits_, {}});
                expect_hits(query, std::string(tree_name(kind)) + ", " + traversal_name(traversal));
            }
    }
}

/// As of a traversal that has been added to tree_traversals() alone.
TEST_F(MeshTreesTest, no_walk_takes_the_place_of_one_that_is_not_there) {
    const std::unique_ptr<TreeWorkshop> workshop = make_cpu_tree_workshop(make_soup(scene_.meshes[0]));
    for (const TreeKind kind : {TreeKind::sah, TreeKind::heap, TreeKind::kdtree}) {
        workshop->build(kind, 0);
        try {
            workshop->cast({TraversalKind::wide}, {rays_, hits_, {}});
            ADD_FAILURE() << tree_name(kind);
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::usage) << tree_name(kind);
        }
    }
}

TEST_F(MeshTreesTest, walks_of_heaps_start_at_the_last_hit) {
    for (const TreeKind kind : {TreeKind::heap, TreeKind::succinct_lbvh, TreeKind::succinct_sah}) {
        trees_.build(kind);
        for (const TraversalKind traversal : tree_traversals(kind)) {
            std::vector<uint64_t> keys(rays_.size(), kRootKey);
            const TreeQuery query{traversal, HitKind::closest, Counting::on};
            for (int round = 0; round < 2; ++round) {
                trees_.cast(query, {rays_, hits_, keys});
                expect_hits(query, std::string(tree_name(kind)) + ", " + traversal_name(traversal));
            }
            for (size_t k = 0; k < keys.size(); ++k)
                if (expected_[k].primitive == kNoIndex)
                    EXPECT_EQ(keys[k], kRootKey);
                else
                    EXPECT_GT(keys[k], kRootKey);
        }
    }
}

TEST_F(MeshTreesTest, reports_of_builds_are_consistent) {
    for (const TreeKind kind : tree_kinds()) {
        const TreeBuild build = trees_.build(kind);
        EXPECT_GT(build.seconds, 0) << tree_name(kind);
        EXPECT_GT(build.bytes, build.used * 8) << tree_name(kind);
        EXPECT_LE(build.used, build.slots) << tree_name(kind);
        EXPECT_GE(build.entries, trees_.triangle_count()) << tree_name(kind);
        EXPECT_FALSE(build.is_on_device) << tree_name(kind);
    }
}

TEST_F(MeshTreesTest, misuse_is_refused) {
    trees_.build(TreeKind::sah);
    EXPECT_THROW(trees_.cast({TraversalKind::trail}, {rays_, hits_, {}}), Error);
    EXPECT_THROW(trees_.cast({TraversalKind::wide}, {rays_, hits_, {}}), Error);
    EXPECT_THROW(trees_.cast({}, {rays_, std::span(hits_).first(3), {}}), Error);
    std::vector<uint64_t> keys(rays_.size(), kRootKey);
    EXPECT_THROW(trees_.cast({}, {rays_, hits_, keys}), Error);
    EXPECT_THROW(MeshTrees(Mesh{}, {}), Error);
    trees_.build(TreeKind::succinct_sah);
    for (const uint64_t key : {uint64_t(0), uint64_t(1) << 40, ~uint64_t(0), uint64_t(3) << 61}) {
        keys[7] = key;
        EXPECT_THROW(trees_.cast({TraversalKind::trail}, {rays_, hits_, keys}), Error) << key;
    }
}

TEST_F(MeshTreesTest, keys_of_another_tree_are_refused) {
    std::vector<uint64_t> keys(rays_.size(), kRootKey);
    trees_.build(TreeKind::succinct_sah);
    trees_.cast({TraversalKind::trail}, {rays_, hits_, keys});
    for (const TreeKind kind : {TreeKind::heap, TreeKind::succinct_lbvh}) {
        trees_.build(kind, kind == TreeKind::heap ? 4 : 0);
        EXPECT_THROW(trees_.cast({TraversalKind::trail}, {rays_, hits_, keys}), Error) << tree_name(kind);
    }
}

TEST(MeshTreesOfADamagedMesh, are_refused) {
    const Mesh sound = make_structure_scene("hall", MeshDetail::reduced).meshes[0];
    Mesh far_index = sound, overrun = sound, line = sound, not_finite = sound;
    far_index.position_indices[5] = uint32_t(sound.positions.size());
    overrun.face_sizes.back() = 7;
    line.face_sizes[0] = 2;
    not_finite.positions[0].x = std::nanf("");
    for (const Mesh& mesh : {far_index, overrun, line, not_finite}) EXPECT_THROW(MeshTrees(mesh, {}), Error);
}

} // namespace
} // namespace relief
