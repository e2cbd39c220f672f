#include "lab/tree_workshop.h"

#include "base/parallel.h"
#include "base/timer.h"
#include "bvh/sah_bvh.h"
#include "formulas/tree.h"
#include "lab/trees/lbvh.h"
#include "lab/walks/trail.h"

namespace relief {

namespace {

constexpr int kMostLevels = int(scalar::kTrailLevels64);

AxisBvh build_sah(std::span<const Box> boxes, SahBvhBuilder::Config config) {
    config.max_depth = kMostLevels;
    return add_axes(SahBvhBuilder::build(boxes, config));
}

AxisBvh build_linear(std::span<const Box> boxes, int code_bits) {
    LbvhBuilder::Config config;
    config.code_bits = code_bits;
    return limit_depth(LbvhBuilder::build(boxes, config), kMostLevels);
}

SahBvhBuilder::Config make_wide_config() {
    SahBvhBuilder::Config config;
    config.method = SahBvhBuilder::Method::sweep;
    config.traversal_cost = 3.0f, config.intersection_cost = 1.5f;
    config.max_leaf_size = 8;
    return config;
}

HostTree build_tree(std::span<const Box> boxes, TreeKind kind, int heap_levels) {
    switch (kind) {
    case TreeKind::sah:
        return make_linked_bvh(build_sah(boxes, {}));
    case TreeKind::sah_wide:
        return make_linked_bvh(build_sah(boxes, make_wide_config()));
    case TreeKind::lbvh30:
        return make_linked_bvh(build_linear(boxes, 30));
    case TreeKind::lbvh63:
        return make_linked_bvh(build_linear(boxes, 63));
    case TreeKind::heap:
        return LbvhBuilder::build_heap(boxes, {30, heap_levels});
    case TreeKind::succinct_lbvh:
        return make_succinct_heap(build_linear(boxes, 30));
    case TreeKind::succinct_sah:
        return make_succinct_heap(build_sah(boxes, {}));
    case TreeKind::kdtree:
        break;
    }
    SahKdTreeBuilder::Config config;
    config.cells = SahKdTreeBuilder::Cells::kept;
    return SahKdTreeBuilder::build(boxes, config);
}

void describe_form(const LinkedBvh& tree, TreeBuild& report) {
    report.link_bytes = tree.parents.size() * sizeof(uint32_t);
    report.slots = report.used = tree.nodes.size();
    report.depth = tree.depth;
}

void describe_form(const DenseHeap& tree, TreeBuild& report) {
    report.slots = tree.nodes.size(), report.used = count_used_slots(tree);
    report.depth = compute_depth(tree);
}

void describe_form(const SuccinctHeap& tree, TreeBuild& report) {
    report.slots = tree.nodes.size(), report.used = tree.nodes.size() - 1;
    report.depth = tree.depth;
}

void describe_form(const KdTree& tree, TreeBuild& report) {
    report.link_bytes = tree.cells.size() * sizeof(scalar::KdBox);
    report.bytes -= report.link_bytes;
    report.slots = report.used = tree.nodes.size();
    report.depth = tree.depth;
}

} // namespace

TriangleSoup make_soup(const Mesh& mesh) {
    TriangleSoup soup;
    soup.positions = mesh.positions;
    size_t first = 0;
    for (const uint32_t corners : mesh.face_sizes) {
        for (uint32_t k = 2; k < corners; ++k)
            for (const size_t corner : {first, first + k - 1, first + k})
                soup.indices.push_back(mesh.position_indices[corner]);
        first += corners;
    }
    return soup;
}

std::vector<Box> compute_triangle_boxes(const TriangleSoup& soup) {
    std::vector<Box> boxes(soup.triangle_count());
    parallel_for("triangle_boxes", boxes.size(), 4096, [&](size_t begin, size_t end) {
        for (size_t k = begin; k < end; ++k)
            for (size_t corner = 0; corner < 3; ++corner)
                boxes[k].extend(soup.positions[soup.indices[3 * k + corner]]);
    });
    return boxes;
}

BuiltTree build_host_tree(std::span<const Box> boxes, TreeKind kind, int heap_levels) {
    const Timer timer;
    BuiltTree built{build_tree(boxes, kind, heap_levels), {}};
    const double seconds = timer.seconds();
    built.report.seconds = seconds;
    const auto describe = [&report = built.report](const auto& tree) {
        report.bytes = tree.byte_count();
        report.entries = tree.primitive_ids.size();
        describe_form(tree, report);
    };
    std::visit(describe, built.tree);
    return built;
}

} // namespace relief
