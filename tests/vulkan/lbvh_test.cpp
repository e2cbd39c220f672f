// Linear trees built on the device against those of the host, node for node.
#include <bit>
#include <vector>

#include <gtest/gtest.h>

#include "lab/vulkan/lbvh_builder.h"
#include "relief/error.h"
#include "support/box_sets.h"
#include "vulkan/gpu_fixture.h"

namespace relief::vulkan::tests {
namespace {

using test::BoxSet;

/// Boxes whose centres lie on few points of a lattice, so that many have the same code.
std::vector<Box> make_lattice_boxes(uint32_t count, uint32_t side) {
    std::vector<Box> boxes(count);
    for (uint32_t k = 0; k < count; ++k) {
        const uint32_t cell = k * 2654435761u >> 7;
        const Vec3f centre{float(cell % side), float(cell / side % side), float(cell / side / side % side)};
        const float size = 0.125f * float(k % 5);
        boxes[k] = {centre - Vec3f{size, size, size}, centre + Vec3f{size, size, size}};
    }
    return boxes;
}

std::vector<BoxSet> make_sets() {
    std::vector<BoxSet> sets = test::make_box_sets();
    sets.push_back({"none", {}});
    sets.push_back({"duplicated codes", make_lattice_boxes(5000, 3)});
    sets.push_back({"some duplicated codes", make_lattice_boxes(5000, 16)});
    sets.push_back({"more than a tile of the scan", test::make_random_boxes(21, 9001, 10, 0.1f)});
    return sets;
}

/// As bits, but the zeros of boxes without their signs.
std::array<uint32_t, 8> make_comparable(const TreeNode& node) {
    const auto bits = [](float value) { return std::bit_cast<uint32_t>(value == 0 ? 0.0f : value); };
    return {bits(node.lower.x), bits(node.lower.y), bits(node.lower.z), node.first,
            bits(node.upper.x), bits(node.upper.y), bits(node.upper.z), node.word};
}

void expect_same_nodes(const DeviceTree& found, const std::vector<TreeNode>& expected,
                       const std::string& name) {
    ASSERT_EQ(found.node_count, expected.size()) << name;
    if (expected.empty()) return;
    const std::vector<TreeNode> nodes = found.nodes.download<TreeNode>(expected.size());
    size_t different = 0, first = 0;
    for (size_t k = expected.size(); k-- > 0;)
        if (make_comparable(nodes[k]) != make_comparable(expected[k])) ++different, first = k;
    EXPECT_EQ(different, 0u) << name << ": of " << expected.size() << " nodes, node " << first
                             << " is the first that differs: " << nodes[first].first << " "
                             << nodes[first].word << " for " << expected[first].first << " "
                             << expected[first].word;
}

void expect_same_words(const Buffer& found, const std::vector<uint32_t>& expected, const std::string& name) {
    if (expected.empty()) return;
    EXPECT_EQ(found.download<uint32_t>(expected.size()), expected) << name;
}

class DeviceLbvh : public GpuTest {
  protected:
    DeviceLbvh() : builder_(get_builder()) {}

    /// A triangle a box, from corner to corner.
    static DeviceMesh upload_boxes(const std::vector<Box>& boxes) {
        std::vector<Vec3f> positions;
        std::vector<uint32_t> indices;
        for (const Box& box : boxes) {
            const uint32_t first = uint32_t(positions.size());
            positions.insert(positions.end(), {box.lower, box.upper});
            indices.insert(indices.end(), {first, first + 1, first});
        }
        return upload_mesh(device(), positions, indices);
    }

    void expect_same_tree(const BoxSet& set, const LbvhBuilder::Config& config) {
        const std::string name = set.name + ", " + std::to_string(config.code_bits) + " bits, leaves of " +
                                 std::to_string(config.max_leaf_size);
        const AxisBvh lbvh = LbvhBuilder::build(set.boxes, config);
        const LinkedBvh expected = make_linked_bvh(lbvh);
        const DeviceTree found = builder_.build(upload_boxes(set.boxes), config);
        expect_same_nodes(found, expected.nodes, name);
        expect_same_words(found.primitive_ids, expected.primitive_ids, name + ": ids");
        expect_same_words(found.parents, expected.parents, name + ": parents");
        expect_same_words(found.skips, expected.skips, name + ": skip links");
        EXPECT_EQ(found.depth, expected.depth) << name;
    }

    void expect_same_heap(const BoxSet& set, const LbvhBuilder::HeapConfig& config) {
        const std::string name = set.name + ", " + std::to_string(config.code_bits) + " bits, " +
                                 std::to_string(config.levels) + " levels";
        const DenseHeap expected = LbvhBuilder::build_heap(set.boxes, config);
        const DeviceTree found = builder_.build_heap(upload_boxes(set.boxes), config);
        expect_same_nodes(found, expected.nodes, name);
        expect_same_words(found.primitive_ids, expected.primitive_ids, name + ": ids");
        EXPECT_EQ(found.depth, compute_depth(expected)) << name;
    }

    /// One for all tests: its kernels take a while to make.
    static DeviceLbvhBuilder& get_builder() {
        static DeviceLbvhBuilder builder(device());
        return builder;
    }

    DeviceLbvhBuilder& builder_;
};

TEST_F(DeviceLbvh, is_the_tree_of_the_host_node_for_node) {
    for (const BoxSet& set : make_sets())
        for (const int code_bits : {30, 63}) expect_same_tree(set, {.code_bits = code_bits});
}

TEST_F(DeviceLbvh, splits_equal_codes_as_the_host_does) {
    const std::vector<BoxSet> sets = {{"lattice", make_lattice_boxes(3000, 2)},
                                      {"one point", std::vector<Box>(2500, Box{{1, 2, 3}, {2, 3, 5}})}};
    for (const BoxSet& set : sets)
        for (const uint32_t size : {1u, 3u, 7u, 64u, 100'000u})
            expect_same_tree(set, {.max_leaf_size = size});
}

TEST_F(DeviceLbvh, as_a_heap_is_that_of_the_host_slot_for_slot) {
    for (const BoxSet& set : make_sets())
        for (const int code_bits : {30, 63}) expect_same_heap(set, {.code_bits = code_bits});
}

TEST_F(DeviceLbvh, heaps_of_any_depth_cut_off_at_their_last_level) {
    const BoxSet set{"random", test::make_random_boxes(31, 800, 10, 0.1f)};
    for (const int levels : {1, 2, 5, 17})
        for (const int code_bits : {30, 63}) expect_same_heap(set, {code_bits, levels});
}

TEST_F(DeviceLbvh, of_a_mesh_is_that_of_its_triangles_boxes) {
    std::vector<Vec3f> positions;
    std::vector<uint32_t> indices;
    BoxSet set{"mesh", {}};
    for (const test::Triangle& triangle : test::make_random_triangles(3, 3000, 5, 0.3f)) {
        for (const Vec3f& corner : {triangle.a, triangle.b, triangle.c}) {
            indices.push_back(uint32_t(positions.size()));
            positions.push_back(corner);
        }
        set.boxes.push_back(triangle.box());
    }
    const DeviceMesh mesh = upload_mesh(device(), positions, indices);
    const AxisBvh lbvh = LbvhBuilder::build(set.boxes, {});
    expect_same_nodes(builder_.build(mesh, {}), make_linked_bvh(lbvh).nodes, "mesh");
    expect_same_nodes(builder_.build_heap(mesh, {}), LbvhBuilder::build_heap(set.boxes, {}).nodes, "heap");
    EXPECT_THROW(upload_mesh(device(), positions, std::vector<uint32_t>{0, 1, 9000}), Error);
}

TEST_F(DeviceLbvh, twice_gives_the_same_bits) {
    const std::vector<Box> boxes = make_lattice_boxes(20'000, 24);
    const DeviceMesh uploaded = upload_boxes(boxes);
    const DeviceTree first = builder_.build(uploaded, {});
    const DeviceTree second = builder_.build(uploaded, {});
    ASSERT_EQ(first.node_count, second.node_count);
    const size_t words = size_t(first.node_count) * 8;
    EXPECT_EQ(first.nodes.download<uint32_t>(words), second.nodes.download<uint32_t>(words));
}

TEST_F(DeviceLbvh, says_so_when_the_device_ends_a_loop_early) {
    if (!device().is_cpu()) GTEST_SKIP() << "only a device that bounds its loops";
    const std::vector<Box> boxes(70'000, Box{{1, 2, 3}, {2, 3, 5}});
    const DeviceMesh uploaded = upload_boxes(boxes);
    EXPECT_THROW(builder_.build_heap(uploaded, {.levels = 2}), Error);
}

TEST_F(DeviceLbvh, reports_times_and_bytes_of_a_build) {
    const std::vector<Box> boxes = test::make_random_boxes(41, 50'000, 10, 0.1f);
    const DeviceMesh uploaded = upload_boxes(boxes);
    builder_.build(uploaded, {});
    const BuildReport& report = builder_.report();
    EXPECT_EQ(report.primitive_count, boxes.size());
    for (size_t part = 0; part < BuildReport::kPartCount; ++part) {
        EXPECT_GT(report.seconds[part], 0.0) << part;
        EXPECT_GT(report.bytes[part], boxes.size() * 4) << part;
    }
    const double bandwidth = measure_copy_bandwidth(device());
    EXPECT_GT(bandwidth, 1e8);
    const double share = compute_bound_share(report, bandwidth);
    EXPECT_GT(share, 0.0);
    EXPECT_LT(share, 1.5);
    RecordProperty("primitives_per_second", std::to_string(report.primitives_per_second()));
    RecordProperty("share_of_bound", std::to_string(share));
}

TEST(LeastBuildBytes, grow_with_the_codes_and_the_slots_of_a_heap) {
    BuildReport report;
    report.primitive_count = 1000;
    EXPECT_EQ(compute_least_build_bytes(report), 292'000);
    report.code_bits = 63;
    EXPECT_EQ(compute_least_build_bytes(report), 432'000);
    report.code_bits = 30, report.heap_slots = 4096;
    EXPECT_EQ(compute_least_build_bytes(report), 148'000 + 64 * 4096);
}

} // namespace
} // namespace relief::vulkan::tests
