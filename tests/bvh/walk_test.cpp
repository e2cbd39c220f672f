#include <gtest/gtest.h>

#include "bvh/sah_bvh.h"
#include "support/box_sets.h"
#include "support/brute_force.h"
#include "support/walk_plain.h"
#include "support/walk_wide.h"

namespace relief {
namespace {

using test::Triangle;

struct Nearest {
    float t = std::numeric_limits<float>::infinity();
    uint32_t id = 0xffffffffu;
    bool operator==(const Nearest&) const = default;
};

template <class Structure>
Nearest find_nearest(const Structure& structure, BoxRay ray, const std::vector<Triangle>& triangles,
                     int* tests) {
    Nearest best;
    closest_hit(structure, ray, [&](uint32_t id, BoxRay& r) {
        ++*tests;
        const float t = intersect(r, triangles[id]);
        if (t == std::numeric_limits<float>::infinity()) return;
        if (t < best.t || (t == best.t && id < best.id && t <= r.t_max)) best = {t, id}, r.t_max = t;
    });
    return best;
}

template <class Structure>
bool find_any(const Structure& structure, const BoxRay& ray, const std::vector<Triangle>& triangles) {
    return any_hit(structure, ray, [&](uint32_t id, const BoxRay& r) {
        return intersect(r, triangles[id]) < std::numeric_limits<float>::infinity();
    });
}

/// Number of rays that hit something.
int expect_same_as_brute_force(const std::vector<Triangle>& triangles, std::vector<BoxRay> rays) {
    std::vector<Box> boxes;
    for (const Triangle& triangle : triangles) boxes.push_back(triangle.box());
    int hits = 0, brute_tests = 0, stack_tests = 0, wide_tests = 0;
    for (const auto method : {SahBvhBuilder::Method::binned, SahBvhBuilder::Method::sweep}) {
        SahBvhBuilder::Config config;
        config.method = method;
        config.max_leaf_size = method == SahBvhBuilder::Method::binned ? 4 : 1;
        const Bvh bvh = SahBvhBuilder::build(boxes, config);
        const WideBvh wide = make_wide_bvh(bvh);
        const BruteForce all{uint32_t(triangles.size())};
        for (const BoxRay& ray : rays) {
            const Nearest expected = find_nearest(all, ray, triangles, &brute_tests);
            EXPECT_EQ(find_nearest(bvh, ray, triangles, &stack_tests), expected);
            EXPECT_EQ(find_nearest(wide, ray, triangles, &wide_tests), expected);
            const bool is_hit = expected.id != 0xffffffffu;
            EXPECT_EQ(find_any(all, ray, triangles), is_hit);
            EXPECT_EQ(find_any(bvh, ray, triangles), is_hit);
            EXPECT_EQ(find_any(wide, ray, triangles), is_hit);
            hits += is_hit;
        }
    }
    if (triangles.size() > 1000) {
        EXPECT_LT(stack_tests * 20, brute_tests);
        EXPECT_LT(wide_tests * 20, brute_tests);
    }
    return hits;
}

TEST(Walk, finds_the_same_hits_as_brute_force) {
    EXPECT_GT(
        expect_same_as_brute_force(test::make_random_triangles(1, 2000, 1, 0.2f), test::make_rays(2, 900, 1)),
        300);
}

TEST(Walk, finds_the_same_hits_at_huge_and_tiny_scale) {
    EXPECT_GT(expect_same_as_brute_force(test::make_random_triangles(3, 300, 1e12f, 4e11f),
                                         test::make_rays(4, 300, 1e12f)),
              50);
    EXPECT_GT(expect_same_as_brute_force(test::make_random_triangles(5, 300, 1e-12f, 4e-13f),
                                         test::make_rays(6, 300, 1e-12f)),
              50);
}

TEST(Walk, finds_the_same_hits_among_flat_and_repeated_triangles) {
    std::vector<Triangle> triangles = test::make_random_triangles(7, 200, 1, 0.7f);
    for (size_t k = 0; k < triangles.size(); ++k)
        for (Vec3f* p : {&triangles[k].a, &triangles[k].b, &triangles[k].c})
            set_component(*p, int(k % 3), 0.25f);
    triangles.insert(triangles.end(), triangles.begin(), triangles.begin() + 100);
    triangles.insert(triangles.end(), 20, Triangle{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}});
    EXPECT_GT(expect_same_as_brute_force(triangles, test::make_rays(8, 600, 1)), 200);
}

TEST(Walk, finds_the_same_hits_on_edges_and_vertices_of_a_grid) {
    // Rays along the axis through grid points meet edges and corners of boxes and triangles exactly.
    std::vector<Triangle> triangles;
    std::vector<BoxRay> rays;
    for (int i = 0; i < 12; ++i)
        for (int j = 0; j < 12; ++j) {
            const float x = float(i), y = float(j);
            triangles.push_back({{x, y, 0}, {x + 1, y, 0}, {x + 1, y + 1, 0}});
            triangles.push_back({{x, y, 0}, {x + 1, y + 1, 0}, {x, y + 1, 0}});
            for (const float half : {0.0f, 0.5f})
                rays.push_back({{x + half, y, -2}, {half > 0 && i % 2 ? -0.0f : 0.0f, 0, 1}});
        }
    EXPECT_EQ(expect_same_as_brute_force(triangles, rays), 2 * int(rays.size()));
}

TEST(Walk, respects_the_interval_of_the_ray) {
    const std::vector<Triangle> triangles = test::make_random_triangles(9, 300, 1, 0.5f);
    std::vector<BoxRay> rays = test::make_rays(10, 600, 1);
    for (size_t k = 0; k < rays.size(); ++k)
        rays[k].t_min = 0.01f * float(k % 90), rays[k].t_max = rays[k].t_min + 1;
    const int hits = expect_same_as_brute_force(triangles, rays);
    EXPECT_GT(hits, 50);
    EXPECT_LT(hits, 1100);
}

TEST(Walk, finds_nothing_in_empty_trees) {
    BoxRay ray{{0, 0, 0}, {0, 0, 1}};
    const auto leaf = [](uint32_t, const BoxRay&) { return true; };
    EXPECT_FALSE(any_hit(Bvh{}, ray, leaf));
    EXPECT_FALSE(any_hit(WideBvh{}, ray, leaf));
    EXPECT_FALSE(any_hit(BruteForce{}, ray, leaf));
}

TEST(Walk, reaches_every_primitive_whose_box_holds_the_origin) {
    for (const test::BoxSet& set : test::make_box_sets()) {
        const Bvh bvh = SahBvhBuilder::build(set.boxes, {});
        const WideBvh wide = make_wide_bvh(bvh);
        for (uint32_t k = 0; k < set.boxes.size(); k += 7) {
            const Vec3f center = set.boxes[k].lower * 0.5f + set.boxes[k].upper * 0.5f;
            if (!set.boxes[k].contains(center)) continue;
            const BoxRay ray{center, {0.6f, 0, -0.8f}};
            const auto is_wanted = [&](uint32_t id, const BoxRay&) { return id == k; };
            EXPECT_TRUE(any_hit(bvh, ray, is_wanted)) << set.name;
            EXPECT_TRUE(any_hit(wide, ray, is_wanted)) << set.name;
        }
    }
}

} // namespace
} // namespace relief
