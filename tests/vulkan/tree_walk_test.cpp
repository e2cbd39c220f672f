// Every traversal over every tree on the device: the hits of brute force, and those of the same walk on the
// host to the bit, counts included.
#include <bit>
#include <deque>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include "bvh/sah_bvh.h"
#include "formulas/constants.h"
#include "formulas/object_ray.h"
#include "formulas/tree.h"
#include "lab/vulkan/lbvh_builder.h"
#include "lab/vulkan/tree_tracer.h"
#include "lab/walks/trail.h"
#include "relief/error.h"
#include "support/dense_heap.h"
#include "support/ray_cases.h"
#include "vulkan/gpu_fixture.h"

#include "vulkan/layout/device_trees.h"

namespace relief::vulkan::tests {
namespace {

using scalar::HeapKey;
using scalar::kNone;
using scalar::RayCounts;
using scalar::TreeHit;
using scalar::TreeRay;
using test::Triangle;
using test::TriangleSet;
using Kind = HitKind;
using Start = WalkStart;

bool is_same(const TreeHit& a, const TreeHit& b) {
    return std::bit_cast<std::array<uint32_t, 4>>(a) == std::bit_cast<std::array<uint32_t, 4>>(b);
}

bool is_same(const RayCounts& a, const RayCounts& b) {
    return std::bit_cast<std::array<uint32_t, 4>>(a) == std::bit_cast<std::array<uint32_t, 4>>(b);
}

/// What a batch of rays met, and what that took.
struct Answers {
    std::vector<TreeHit> hits;
    std::vector<RayCounts> counts;
    std::vector<HeapKey> leaves;
};

/// The triangle test of the device, on the host.
class HostLeaf {
  public:
    HostLeaf(const std::vector<Triangle>& triangles, const BoxRay& ray)
        : triangles_(triangles), object_ray_(scalar::make_object_ray(ray.origin, ray.direction)) {
        best_ = {ray.t_max, kNone, 0, 0};
    }

    bool operator()(uint32_t id, BoxRay& ray) {
        const auto shear = [&](const Vec3f& p) { return scalar::shear_vertex(object_ray_, p); };
        const Triangle& triangle = triangles_[id];
        const scalar::TriangleHit found = scalar::intersect_sheared(
            object_ray_, shear(triangle.a), shear(triangle.b), shear(triangle.c), ray.t_min, best_.t);
        if (found.t == scalar::make_infinity() || (found.t == best_.t && id >= best_.primitive)) return false;
        best_ = {found.t, id, found.weight_b, found.weight_c};
        ray.t_max = found.t;
        return true;
    }

    TreeHit result() const {
        TreeHit hit = best_;
        if (hit.primitive == kNone) hit.t = scalar::make_infinity();
        return hit;
    }

  private:
    const std::vector<Triangle>& triangles_;
    const scalar::ObjectRay object_ray_;
    TreeHit best_;
};

/// What brute force finds.
struct Truth {
    TreeHit nearest;
    /// The rounding of a triangle test says hit where the ray misses the triangle's own box: whether a walk
    /// comes there depends on the tree.
    bool is_doubtful = false;
};

Truth find_truth(const std::vector<Triangle>& triangles, BoxRay ray) {
    Truth truth;
    HostLeaf leaf(triangles, ray);
    for (uint32_t id = 0; id < triangles.size(); ++id) {
        BoxRay whole = ray;
        HostLeaf alone(triangles, ray);
        if (!alone(id, whole)) continue;
        truth.is_doubtful |= test::ends_before_box(ray, triangles[id], whole.t_max);
        leaf(id, ray);
    }
    truth.nearest = leaf.result();
    return truth;
}

RayCounts narrow_counts(const WalkCounts& counts) {
    return {uint32_t(counts.box_tests), uint32_t(counts.primitive_tests), uint32_t(counts.restarts),
            uint32_t(counts.bytes)};
}

uint32_t narrow_key(uint32_t, HeapKey key) { return key.low; }
HeapKey narrow_key(HeapKey, HeapKey key) { return key; }
HeapKey widen_key(uint32_t key) { return {key, 0}; }
HeapKey widen_key(HeapKey key) { return key; }

/// One tree with one walk, on the device and on the host.
struct WalkCase {
    std::string name;
    const DeviceTree* tree;
    TraversalKind traversal;
    std::function<Answers(Kind, const std::vector<BoxRay>&, const std::vector<HeapKey>&)> run_on_host;
};

/// From keys; only walks of heaps heed them.
template <TraversalKind kTraversal, class View>
Answers run_walk(const View& view, const std::vector<Triangle>& triangles, Kind kind,
                 const std::vector<BoxRay>& rays, const std::vector<HeapKey>& starts) {
    Answers answers;
    for (size_t k = 0; k < rays.size(); ++k) {
        BoxRay ray = rays[k];
        HostLeaf leaf(triangles, ray);
        WalkCounts counts;
        auto key = narrow_key(typename View::Key{}, starts[k]);
        if (kind == Kind::any)
            any_hit_from<kTraversal>(view, key, ray, leaf, counts);
        else
            closest_hit_from<kTraversal>(view, key, ray, leaf, counts);
        answers.hits.push_back(leaf.result());
        answers.counts.push_back(narrow_counts(counts));
        answers.leaves.push_back(widen_key(key));
    }
    return answers;
}

constexpr uint32_t kRayCount = 500;

std::vector<BoxRay> make_rays(const TriangleSet& set) {
    test::RayMaker maker(90, set.triangles);
    std::vector<BoxRay> rays;
    for (uint32_t k = 0; k < kRayCount; ++k)
        rays.push_back(k % 2 ? maker.make_general() : maker.make_special());
    return rays;
}

DeviceMesh upload_triangles(const Device& device, const std::vector<Triangle>& triangles) {
    std::vector<Vec3f> positions;
    std::vector<uint32_t> indices;
    for (const Triangle& triangle : triangles)
        for (const Vec3f& corner : {triangle.a, triangle.b, triangle.c}) {
            indices.push_back(uint32_t(positions.size()));
            positions.push_back(corner);
        }
    return upload_mesh(device, positions, indices);
}

/// All trees over one set of triangles, with all their walks. Its members stay where they are.
class Forest {
  public:
    Forest(const Device& device, DeviceLbvhBuilder& builder, const TriangleSet& set)
        : device_(device), triangles_(set.triangles), mesh(upload_triangles(device, set.triangles)) {
        const std::vector<Box> boxes = set.boxes();
        const Bvh sah = SahBvhBuilder::build(boxes, {.max_depth = int(scalar::kTrailLevels32)});
        add_linked("SAH", sah, compute_axes(sah));
        const AxisBvh lbvh = LbvhBuilder::build(boxes, {.code_bits = 63, .max_leaf_size = 2});
        add_linked("LBVH", lbvh.bvh, lbvh.axes);
        add_built(builder, boxes);
        const auto& kd =
            kd_.emplace_back(SahKdTreeBuilder::build(boxes, {.cells = SahKdTreeBuilder::Cells::kept}));
        const DeviceTree& tree = keep(upload_tree(device_, kd));
        add<TraversalKind::restart>("kd-tree", tree, make_walk_view(kd));
        add<TraversalKind::push_down>("kd-tree", tree, make_walk_view(kd));
        add<TraversalKind::backtrack>("kd-tree", tree, make_walk_view(kd));
    }

    const std::vector<WalkCase>& walks() const { return walks_; }

  private:
    const DeviceTree& keep(DeviceTree tree) { return trees_.emplace_back(std::move(tree)); }

    void add_linked(const std::string& name, const Bvh& bvh, const std::vector<uint8_t>& axes) {
        const LinkedBvh& linked = linked_.emplace_back(make_linked_bvh({bvh, axes, compute_depth(bvh)}));
        add_links(name, keep(upload_tree(device_, linked)), linked);
        const SuccinctHeap& succinct =
            succinct_.emplace_back(make_succinct_heap({bvh, axes, compute_depth(bvh)}));
        const DeviceTree& narrow = keep(upload_tree(device_, succinct));
        if (narrow.depth <= int(scalar::kTrailLevels32))
            add_heap(name + ", succinct", narrow, make_walk_view(succinct));
        add_heap(name + ", succinct, wide", widen(upload_tree(device_, succinct)),
                 make_wide_walk_view(succinct));
        if (linked.depth >= 16) return;
        const DenseHeap& dense = dense_.emplace_back(test::make_dense_heap(bvh, axes));
        add_heap(name + ", dense", keep(upload_tree(device_, dense)), make_walk_view(dense));
    }

    void add_built(DeviceLbvhBuilder& builder, const std::vector<Box>& boxes) {
        const AxisBvh lbvh = LbvhBuilder::build(boxes, {});
        const LinkedBvh& linked = linked_.emplace_back(make_linked_bvh(lbvh));
        add_links("LBVH of the device", keep(builder.build(mesh, {})), linked);
        const DenseHeap& dense = dense_.emplace_back(LbvhBuilder::build_heap(boxes, {}));
        add_heap("heap of the device", keep(builder.build_heap(mesh, {})), make_walk_view(dense));
    }

    void add_links(const std::string& name, const DeviceTree& tree, const LinkedBvh& linked) {
        add<TraversalKind::stack>(name, tree, make_walk_view(linked));
        add<TraversalKind::parent_link>(name, tree, make_walk_view(linked));
        add<TraversalKind::skip_link>(name, tree, make_walk_view(linked));
        if (tree.depth <= int(scalar::kTrailLevels32))
            add<TraversalKind::restart_trail>(name, tree, make_walk_view(linked));
        add<TraversalKind::restart_trail>(name + ", wide", widen(upload_tree(device_, linked)),
                                          make_wide_walk_view(linked));
    }

    template <class View> void add_heap(const std::string& name, const DeviceTree& tree, const View& view) {
        add<TraversalKind::trail>(name, tree, view);
        add<TraversalKind::pair_trail>(name, tree, view);
    }

    /// As if it were deeper: the walk takes keys of 64 bits.
    const DeviceTree& widen(DeviceTree tree) {
        tree.depth = std::max(tree.depth, int(scalar::kTrailLevels32) + 1);
        return keep(std::move(tree));
    }

    template <TraversalKind kTraversal, class View>
    void add(const std::string& name, const DeviceTree& tree, const View& view) {
        walks_.push_back({name + ", traversal " + std::to_string(int(kTraversal)), &tree, kTraversal,
                          [this, view](Kind kind, const auto& rays, const auto& starts) {
                              return run_walk<kTraversal>(view, triangles_, kind, rays, starts);
                          }});
    }

    const Device& device_;
    const std::vector<Triangle>& triangles_;
    std::deque<LinkedBvh> linked_;
    std::deque<DenseHeap> dense_;
    std::deque<SuccinctHeap> succinct_;
    std::deque<KdTree> kd_;
    std::deque<DeviceTree> trees_;
    std::vector<WalkCase> walks_;

  public:
    const DeviceMesh mesh;
};

/// Rays of one table, on the device.
class TreeBatch : public GpuTest {
  protected:
    TreeBatch() : rays_(device(), kRayCount) {}

    void upload(const std::vector<BoxRay>& rays) {
        std::vector<TreeRay> packed;
        for (const BoxRay& ray : rays) packed.push_back({ray.origin, ray.t_min, ray.direction, ray.t_max});
        rays_.rays.upload(packed);
    }

    Answers run(const DeviceTree& tree, const DeviceMesh& mesh, const TreeQuery& query,
                Start start = Start::root) {
        tracer().trace(tree, mesh, rays_, kRayCount, query, start);
        return {rays_.hits.download<TreeHit>(kRayCount), rays_.counts.download<RayCounts>(kRayCount),
                rays_.leaf_keys.download<HeapKey>(kRayCount)};
    }

    /// Of this device and the host, which agree to the bit where the device divides exactly, as CPUs do.
    static void expect_as_on_host(const Answers& found, const Answers& expected, const std::string& name) {
        if (!device().is_cpu()) return;
        expect_same(found, expected, name);
        for (uint32_t k = 0; k < kRayCount; ++k)
            ASSERT_TRUE(scalar::is_equal(found.leaves[k], expected.leaves[k])) << name << ", ray " << k;
    }

    static void expect_same(const Answers& found, const Answers& expected, const std::string& name) {
        for (uint32_t k = 0; k < kRayCount; ++k) {
            const TreeHit &a = found.hits[k], &b = expected.hits[k];
            ASSERT_TRUE(is_same(a, b)) << name << ", ray " << k << ": " << a.primitive << " at " << a.t
                                       << " for " << b.primitive << " at " << b.t;
            const RayCounts &c = found.counts[k], &d = expected.counts[k];
            ASSERT_TRUE(is_same(c, d))
                << name << ", ray " << k << ": " << c.box_tests << " boxes, " << c.primitive_tests
                << " primitives, " << c.restarts << " restarts, " << c.bytes << " bytes for " << d.box_tests
                << " " << d.primitive_tests << " " << d.restarts << " " << d.bytes;
        }
    }

    static std::vector<HeapKey> roots() { return std::vector<HeapKey>(kRayCount, HeapKey{1, 0}); }

    static void expect_true(const Answers& found, const std::vector<Truth>& truths, Kind kind,
                            const std::string& name) {
        uint32_t wrong = 0, last = 0;
        for (uint32_t k = 0; k < kRayCount; ++k) {
            const TreeHit &hit = found.hits[k], &nearest = truths[k].nearest;
            const bool is_right = kind == Kind::any ? (hit.primitive == kNone) == (nearest.primitive == kNone)
                                                    : is_same(hit, nearest);
            if (!is_right && !truths[k].is_doubtful) ++wrong, last = k;
        }
        // What is doubtful is found on the host, and devices may round otherwise.
        const uint32_t allowed = device().is_cpu() ? 0 : kRayCount / 100;
        EXPECT_LE(wrong, allowed) << name << ", ray " << last << ": " << found.hits[last].primitive << " at "
                                  << found.hits[last].t << " for " << truths[last].nearest.primitive << " at "
                                  << truths[last].nearest.t;
    }

    /// Of the rays that are uploaded. Divisions that round otherwise than the host's hit other edges: such a
    /// device is compared with itself, all triangles in one leaf.
    std::vector<Truth> find_truths(const TriangleSet& set, const DeviceMesh& mesh,
                                   const std::vector<BoxRay>& rays) {
        std::vector<Truth> truths;
        uint32_t doubtful = 0, outside = 0;
        for (const BoxRay& ray : rays) {
            truths.push_back(find_truth(set.triangles, ray));
            doubtful += truths.back().is_doubtful;
        }
        EXPECT_LE(doubtful, kRayCount / 20);
        if (device().is_cpu()) return truths;
        const DeviceTree leaf = upload_tree(device(), LbvhBuilder::build_heap(set.boxes(), {.levels = 1}));
        const Answers own = run(leaf, mesh, {.traversal = TraversalKind::trail});
        // Products below the normal floats, which a device may take for zero, put hits out of their boxes.
        for (uint32_t k = 0; k < kRayCount; ++k) {
            const TreeHit& hit = truths[k].nearest = own.hits[k];
            if (hit.primitive == kNone) continue;
            const bool is_outside = test::ends_before_box(rays[k], set.triangles[hit.primitive], hit.t);
            truths[k].is_doubtful |= is_outside, outside += is_outside;
        }
        const bool is_flat = set.name == "floor" || set.name == "flat and repeated"; // on an H200 8 and 25
        EXPECT_LE(outside, set.name == "tiny" ? kRayCount / 5 : is_flat ? 30 : kRayCount / 100) << set.name;
        return truths;
    }

    static TreeTracer& tracer() {
        static TreeTracer tracer(device());
        return tracer;
    }
    static DeviceLbvhBuilder& builder() {
        static DeviceLbvhBuilder builder(device());
        return builder;
    }

    TreeRays rays_;
};

class TreeWalks : public TreeBatch, public testing::WithParamInterface<TriangleSet> {};

TEST_P(TreeWalks, find_the_hits_of_brute_force_and_count_as_the_host_does) {
    const TriangleSet& set = GetParam();
    const Forest forest(device(), builder(), set);
    const std::vector<BoxRay> rays = make_rays(set);
    upload(rays);
    const std::vector<Truth> truths = find_truths(set, forest.mesh, rays);
    for (const WalkCase& walk : forest.walks())
        for (const Kind kind : {Kind::closest, Kind::any}) {
            const Answers found = run(*walk.tree, forest.mesh, {walk.traversal, kind, Counting::on});
            const std::string name = walk.name + (kind == Kind::any ? ", any" : ", closest");
            Answers expected = walk.run_on_host(kind, rays, roots());
            expected.leaves = found.leaves; // none were requested
            expect_as_on_host(found, expected, name);
            expect_true(found, truths, kind, name);
        }
}

/// From the hits of `rays`, or their origins, on to other places.
std::vector<BoxRay> bounce_rays(const std::vector<BoxRay>& rays, const std::vector<TreeHit>& hits) {
    std::vector<BoxRay> result = rays;
    for (size_t k = 0; k < rays.size(); ++k) {
        const BoxRay& other = rays[(k * 7 + 1) % rays.size()];
        if (hits[k].primitive != kNone) result[k].origin = rays[k].origin + rays[k].direction * hits[k].t;
        result[k].direction = other.direction;
    }
    return result;
}

TEST_P(TreeWalks, that_start_at_the_last_hit_find_the_same) {
    const TriangleSet& set = GetParam();
    const Forest forest(device(), builder(), set);
    const std::vector<BoxRay> rays = make_rays(set);
    for (const WalkCase& walk : forest.walks()) {
        if (walk.traversal != TraversalKind::trail && walk.traversal != TraversalKind::pair_trail) continue;
        TreeQuery query{walk.traversal, Kind::closest, Counting::on};
        upload(rays);
        rays_.start_keys.upload(roots());
        const Answers first = run(*walk.tree, forest.mesh, query, Start::last_leaf);
        expect_as_on_host(first, walk.run_on_host(Kind::closest, rays, roots()), walk.name);
        const std::vector<BoxRay> bounced = bounce_rays(rays, first.hits);
        upload(bounced);
        rays_.start_keys.upload(first.leaves);
        const Answers closest = run(*walk.tree, forest.mesh, query, Start::last_leaf);
        query.kind = Kind::any;
        const Answers any = run(*walk.tree, forest.mesh, query, Start::last_leaf);
        for (const Kind kind : {Kind::closest, Kind::any}) {
            const Answers expected = walk.run_on_host(kind, bounced, first.leaves);
            expect_as_on_host(kind == Kind::any ? any : closest, expected, walk.name + " from the last leaf");
        }
        const std::vector<Truth> truths = find_truths(set, forest.mesh, bounced);
        expect_true(closest, truths, Kind::closest, walk.name + ", closest from the last leaf");
        expect_true(any, truths, Kind::any, walk.name + ", any from the last leaf");
    }
}

class TreeTracing : public TreeBatch {
  protected:
    TreeTracing()
        : set_(find_set("many small")),
          boxes_(set_.boxes()),
          mesh_(upload_triangles(device(), set_.triangles)) {
        upload(make_rays(set_));
    }

    static TriangleSet find_set(const std::string& name) {
        for (const TriangleSet& set : test::make_triangle_sets())
            if (set.name == name) return set;
        return {};
    }

    DeviceTree make_linked() {
        const Bvh sah = SahBvhBuilder::build(boxes_, {});
        return upload_tree(device(), make_linked_bvh(add_axes(sah)));
    }

    TriangleSet set_;
    std::vector<Box> boxes_;
    DeviceMesh mesh_;
};

TEST_F(TreeTracing, twice_gives_the_same_bits) {
    const DeviceTree heap = builder().build_heap(mesh_, {});
    const TreeQuery query{TraversalKind::pair_trail, Kind::closest, Counting::on};
    const Answers first = run(heap, mesh_, query);
    expect_same(run(heap, mesh_, query), first, "second run");
}

TEST_F(TreeTracing, counts_nothing_unless_asked) {
    const DeviceTree tree = make_linked();
    const Answers counted = run(tree, mesh_, {.counting = Counting::on});
    rays_.counts.upload(std::vector<RayCounts>(kRayCount, RayCounts{1, 2, 3, 4}));
    Answers uncounted = run(tree, mesh_, {});
    for (const RayCounts& counts : uncounted.counts) EXPECT_TRUE(is_same(counts, {1, 2, 3, 4}));
    uncounted.counts = counted.counts;
    expect_same(uncounted, counted, "without counts");
}

TEST_F(TreeTracing, notes_the_leaf_of_each_hit) {
    const DenseHeap host = LbvhBuilder::build_heap(boxes_, {});
    const Answers found = run(upload_tree(device(), host), mesh_, {.traversal = TraversalKind::trail});
    rays_.start_keys.upload(roots());
    const Answers noted =
        run(upload_tree(device(), host), mesh_, {.traversal = TraversalKind::trail}, Start::last_leaf);
    for (uint32_t k = 0; k < kRayCount; ++k) {
        EXPECT_TRUE(is_same(noted.hits[k], found.hits[k]));
        if (noted.hits[k].primitive == kNone) {
            EXPECT_EQ(noted.leaves[k].low, 1u);
            continue;
        }
        const TreeNode& leaf = host.nodes[noted.leaves[k].low];
        ASSERT_TRUE(scalar::is_leaf_word(leaf.word));
        const auto begin = host.primitive_ids.begin() + leaf.first;
        EXPECT_EQ(std::count(begin, begin + scalar::get_word_count(leaf.word), noted.hits[k].primitive), 1);
    }
}

TEST_F(TreeTracing, refuses_trees_that_the_traversal_does_not_walk) {
    const DeviceTree linked = make_linked();
    const DeviceTree kd = upload_tree(device(), SahKdTreeBuilder::build(boxes_, {}));
    EXPECT_THROW(run(linked, mesh_, {.traversal = TraversalKind::trail}), Error);
    EXPECT_THROW(run(linked, mesh_, {.traversal = TraversalKind::restart}), Error);
    EXPECT_THROW(run(linked, mesh_, {}, Start::last_leaf), Error);
    EXPECT_THROW(run(kd, mesh_, {.traversal = TraversalKind::stack}), Error);
    EXPECT_THROW(run(kd, mesh_, {.traversal = TraversalKind::backtrack}), Error) << "it has no cells";
    DeviceTree deep = make_linked();
    deep.depth = int(scalar::kTrailLevels64) + 1;
    EXPECT_THROW(run(deep, mesh_, {.traversal = TraversalKind::restart_trail}), Error);
    deep.depth = int(scalar::kTreeStackSize);
    EXPECT_THROW(run(deep, mesh_, {.traversal = TraversalKind::stack}), Error);
}

TEST_F(TreeTracing, says_so_when_the_device_ends_a_walk_early) {
    if (!device().is_cpu()) GTEST_SKIP() << "only a device that bounds its loops";
    const TriangleSet same{"one leaf",
                           std::vector<Triangle>(70'000, Triangle{{-9, -9, 0}, {9, -9, 0}, {0, 9, 0}})};
    const DenseHeap heap = LbvhBuilder::build_heap(same.boxes(), {.levels = 1});
    upload(std::vector<BoxRay>(kRayCount, BoxRay{{0, 0, -1}, {0, 0, 1}}));
    const DeviceMesh mesh = upload_triangles(device(), same.triangles);
    EXPECT_THROW(run(upload_tree(device(), heap), mesh, {.traversal = TraversalKind::trail}), Error);
}

INSTANTIATE_TEST_SUITE_P(Sets, TreeWalks, testing::ValuesIn(test::make_triangle_sets()),
                         [](const testing::TestParamInfo<TriangleSet>& info) {
                             std::string name = info.param.name;
                             std::replace(name.begin(), name.end(), ' ', '_');
                             return name;
                         });

} // namespace
} // namespace relief::vulkan::tests
