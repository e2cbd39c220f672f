#include "lab/trees/sah_kdtree.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include <fmt/format.h>

#include "base/check.h"
#include "base/parallel.h"
#include "bvh/sah_split.h"
#include "formulas/tree.h"
#include "relief/error.h"

namespace relief {

namespace {

constexpr double kMaxEntryCount = 1u << 29;
constexpr size_t kMaxNodeCount = size_t(1) << 30;

/// A subtree with fewer primitives is built by one thread.
constexpr size_t kParallelCount = 4096;

/// Of the greatest coordinate: the distances of planes, the ray's new origin, and a reported hit may each be
/// off by some units of 2^-24, and they are compared with one another.
constexpr float kMargin = 64 * 0x1p-24f;
constexpr float kLeastMargin = 1e-36f;

/// One face of a box. Of all events at one position the order does not matter.
struct Event {
    float position;
    uint32_t primitive_and_kind; ///< number within the set << 1 | is the upper face

    uint32_t primitive() const { return primitive_and_kind >> 1; }
    bool is_upper() const { return (primitive_and_kind & 1u) != 0; }
};

/// Primitives of one node, with the faces of their boxes in order along each axis.
struct EventSet {
    std::vector<uint32_t> ids;
    std::array<std::vector<Event>, 3> events;
};

struct Plane {
    double cost = std::numeric_limits<double>::infinity();
    int axis = -1;
    float position = 0;
    uint32_t left_count = 0, right_count = 0;
};

struct Node {
    Box cell;
    uint32_t parent;
    int depth;
    uint64_t budget; ///< entries that the leaves of this subtree may have together
};

/// A part of the tree with numbers of its own.
struct Output {
    std::vector<scalar::KdNode> nodes;
    std::vector<uint32_t> ids;
    std::vector<scalar::KdBox> cells;
    int depth = 0;
};

Box cut_cell(Box cell, int axis, float lower, float upper) {
    set_component(cell.lower, axis, lower);
    set_component(cell.upper, axis, upper);
    return cell;
}

/// A ray leaves the tree at its end, which has slack, and not at the faces of the root: without a plane of
/// their own there, cells are left where the way down ends them.
void open_outer_faces(std::span<scalar::KdBox> cells, const Box& bounds) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    parallel_for("outer faces", cells.size(), 4096, [&](size_t begin, size_t end) {
        for (scalar::KdBox& cell : cells.subspan(begin, end - begin))
            for (int axis = 0; axis < 3; ++axis) {
                if (get_component(cell.lower, axis) == get_component(bounds.lower, axis))
                    set_component(cell.lower, axis, -kInfinity);
                if (get_component(cell.upper, axis) == get_component(bounds.upper, axis))
                    set_component(cell.upper, axis, kInfinity);
            }
    });
}

class KdBuild {
  public:
    KdBuild(std::span<const Box> boxes, const SahKdTreeBuilder::Config& config) : config_(config) {
        for (const Box& box : boxes) bounds_.extend(box);
        float greatest = 0;
        for (int axis = 0; axis < 3; ++axis)
            greatest = std::max({greatest, std::fabs(get_component(bounds_.lower, axis)),
                                 std::fabs(get_component(bounds_.upper, axis))});
        margin_ = std::max(greatest * kMargin, kLeastMargin);
        boxes_.assign(boxes.begin(), boxes.end());
        for (Box& box : boxes_) box = widen(box);
        bounds_ = widen(bounds_);
        max_depth_ = config.max_depth > 0 ? config.max_depth : 8 + int(1.3 * std::log2(double(boxes.size())));
        max_depth_ = std::min(max_depth_, SahKdTreeBuilder::kMaxDepth);
    }

    KdTree run() {
        Output output;
        const uint64_t budget = uint64_t(double(boxes_.size()) * config_.max_duplication);
        build_node(make_root_set(), {bounds_, scalar::kNoNode, 0, budget}, output);
        if (output.nodes.size() > kMaxNodeCount)
            throw Error(ErrorKind::out_of_memory,
                        {fmt::format("{} nodes are too many, room is for 2^30", output.nodes.size()),
                         "kd-tree",
                         "choose the structure bvh, or split the scene into instances of several meshes"});
        KdTree tree;
        tree.bounds = bounds_;
        tree.nodes = std::move(output.nodes);
        tree.primitive_ids = std::move(output.ids);
        tree.cells = std::move(output.cells);
        open_outer_faces(tree.cells, bounds_);
        tree.depth = output.depth;
        return tree;
    }

  private:
    Box widen(const Box& box) const {
        constexpr float kGreatest = std::numeric_limits<float>::max();
        const Vec3f margin{margin_, margin_, margin_}, greatest{kGreatest, kGreatest, kGreatest};
        return {max(box.lower - margin, -greatest), min(box.upper + margin, greatest)};
    }

    EventSet make_root_set() const {
        EventSet set;
        set.ids.resize(boxes_.size());
        for (size_t k = 0; k < boxes_.size(); ++k) set.ids[k] = uint32_t(k);
        parallel_for("sort faces", 3, 1, [&](size_t begin, size_t) {
            const int axis = int(begin);
            std::vector<Event>& events = set.events[begin];
            events.reserve(2 * boxes_.size());
            for (uint32_t k = 0; k < boxes_.size(); ++k) {
                events.push_back({get_component(boxes_[k].lower, axis), 2 * k});
                events.push_back({get_component(boxes_[k].upper, axis), 2 * k + 1});
            }
            std::sort(events.begin(), events.end(), [](const Event& a, const Event& b) {
                return a.position < b.position ||
                       (a.position == b.position && a.primitive_and_kind < b.primitive_and_kind);
            });
        });
        return set;
    }

    /// The cheapest plane along one axis.
    Plane sweep(const EventSet& set, const Box& cell, int axis, double half_area) const {
        const float lower = get_component(cell.lower, axis), upper = get_component(cell.upper, axis);
        const std::vector<Event>& events = set.events[size_t(axis)];
        const uint32_t count = uint32_t(set.ids.size());
        // Half the area of a part of the cell: both ends, and the sides by its length.
        const double ends = compute_half_area(cut_cell(cell, axis, lower, lower));
        const double sides = (half_area - ends) / (double(upper) - lower);
        uint32_t begun = 0, ended = 0; // boxes whose lower, whose upper face lies below the position
        Plane best;
        for (size_t k = 0; k < events.size();) {
            const float position = events[k].position;
            uint32_t beginning = 0;
            const uint32_t left_count = begun;
            for (; k < events.size() && events[k].position == position; ++k)
                events[k].is_upper() ? ++ended : ++beginning;
            begun += beginning;
            if (!(position - lower >= margin_ && upper - position >= margin_)) continue;
            Plane plane{0, axis, position, left_count, count - ended};
            const double left = ends + sides * (double(position) - lower);
            const double right = ends + sides * (double(upper) - position);
            plane.cost = config_.traversal_cost + config_.intersection_cost *
                                                      (left * plane.left_count + right * plane.right_count) /
                                                      half_area;
            if (plane.left_count == 0 || plane.right_count == 0) plane.cost *= config_.empty_factor;
            if (plane.cost < best.cost) best = plane;
        }
        return best;
    }

    /// Axis -1: make a leaf.
    Plane choose_plane(const EventSet& set, const Node& node) const {
        const double half_area = compute_half_area(node.cell);
        if (node.depth >= max_depth_ || set.ids.empty() || !(half_area > 0)) return {};
        Plane best;
        for (int axis = 0; axis < 3; ++axis) {
            const Plane plane = sweep(set, node.cell, axis, half_area);
            if (plane.cost < best.cost) best = plane;
        }
        const bool is_expensive = best.cost >= double(config_.intersection_cost) * double(set.ids.size());
        if (is_expensive || uint64_t(best.left_count) + best.right_count > node.budget) return {};
        return best;
    }

    /// Of the boxes that reach into (lower, upper) along the axis; their events keep their order.
    EventSet select(const EventSet& set, int axis, float lower, float upper) const {
        constexpr uint32_t kOutside = 0xffffffffu;
        EventSet part;
        std::vector<uint32_t> numbers(set.ids.size(), kOutside);
        for (size_t k = 0; k < set.ids.size(); ++k) {
            const Box& box = boxes_[set.ids[k]];
            if (get_component(box.lower, axis) >= upper || get_component(box.upper, axis) <= lower) continue;
            numbers[k] = uint32_t(part.ids.size());
            part.ids.push_back(set.ids[k]);
        }
        // No branch on what is left out, which is unpredictable: the next one is written over it.
        for (size_t a = 0; a < 3; ++a) {
            std::vector<Event>& events = part.events[a];
            events.resize(2 * part.ids.size() + 1);
            size_t place = 0;
            for (const Event& event : set.events[a]) {
                const uint32_t number = numbers[event.primitive()];
                events[place] = {event.position, 2 * number + (event.is_upper() ? 1u : 0u)};
                place += number != kOutside ? 1 : 0;
            }
            events.pop_back();
        }
        return part;
    }

    void add_node(const Node& node, Output& output) const {
        output.nodes.push_back({});
        output.depth = std::max(output.depth, node.depth);
        if (config_.cells == SahKdTreeBuilder::Cells::kept)
            output.cells.push_back({node.cell.lower, node.parent, node.cell.upper, 0});
    }

    void build_node(EventSet set, const Node& node, Output& output) const {
        const uint32_t index = uint32_t(output.nodes.size());
        add_node(node, output);
        const Plane plane = choose_plane(set, node);
        if (plane.axis < 0) {
            output.nodes[index] = {uint32_t(output.ids.size()),
                                   uint32_t(set.ids.size()) << 2 | scalar::kKdLeaf};
            output.ids.insert(output.ids.end(), set.ids.begin(), set.ids.end());
            return;
        }
        const float lower = get_component(node.cell.lower, plane.axis);
        const float upper = get_component(node.cell.upper, plane.axis);
        constexpr float kInfinity = std::numeric_limits<float>::infinity();
        EventSet left_set = select(set, plane.axis, -kInfinity, plane.position);
        EventSet right_set = select(set, plane.axis, plane.position, kInfinity);
        DCHECK(left_set.ids.size() == plane.left_count && right_set.ids.size() == plane.right_count);
        const bool is_parallel = set.ids.size() >= kParallelCount;
        set = {}; // the way down holds one list of each primitive only
        const uint64_t used = uint64_t(plane.left_count) + plane.right_count;
        const uint64_t spare = node.budget - used;
        const Node left{cut_cell(node.cell, plane.axis, lower, plane.position), index, node.depth + 1,
                        plane.left_count + spare * plane.left_count / used};
        const Node right{cut_cell(node.cell, plane.axis, plane.position, upper), index, node.depth + 1,
                         plane.right_count + spare * plane.right_count / used};
        uint32_t right_index = 0;
        if (is_parallel) {
            Output other;
            parallel_invoke([&] { build_node(std::move(left_set), left, output); },
                            [&] { build_node(std::move(right_set), right, other); });
            right_index = append(output, other, index);
        } else {
            build_node(std::move(left_set), left, output);
            right_index = uint32_t(output.nodes.size());
            build_node(std::move(right_set), right, output);
        }
        output.nodes[index] = {std::bit_cast<uint32_t>(plane.position),
                               right_index << 2 | uint32_t(plane.axis)};
    }

    /// Number of the other part's root among the nodes of `output`.
    static uint32_t append(Output& output, const Output& other, uint32_t parent) {
        const uint32_t first_node = uint32_t(output.nodes.size()), first_id = uint32_t(output.ids.size());
        for (scalar::KdNode node : other.nodes) {
            if ((node.word & 3u) == scalar::kKdLeaf)
                node.bits += first_id;
            else
                node.word += first_node << 2;
            output.nodes.push_back(node);
        }
        for (scalar::KdBox cell : other.cells) {
            cell.parent += first_node;
            output.cells.push_back(cell);
        }
        if (!other.cells.empty()) output.cells[first_node].parent = parent;
        output.ids.insert(output.ids.end(), other.ids.begin(), other.ids.end());
        output.depth = std::max(output.depth, other.depth);
        return first_node;
    }

    SahKdTreeBuilder::Config config_;
    std::vector<Box>
        boxes_; ///< widened by the margin, so that a plane on their face does not touch what is in them
    Box bounds_;
    float margin_ = 0;
    int max_depth_ = 0;
};

} // namespace

KdTree SahKdTreeBuilder::build(std::span<const Box> boxes, const Config& config) {
    DCHECK(config.traversal_cost > 0 && config.intersection_cost > 0);
    DCHECK(config.empty_factor > 0 && config.empty_factor <= 1 && config.max_duplication >= 1);
    DCHECK(config.max_depth >= 0 && config.max_depth <= kMaxDepth);
    if (boxes.empty()) return {};
    if (boxes.size() > scalar::kNodeCountMask ||
        double(boxes.size()) * config.max_duplication > kMaxEntryCount)
        throw Error(ErrorKind::out_of_memory,
                    {fmt::format("{} primitives are too many, room is for less than 2^26, and for 2^29 with "
                                 "{} entries each",
                                 boxes.size(), config.max_duplication),
                     "kd-tree",
                     "choose the structure bvh, or split the scene into instances of several meshes"});
    return KdBuild(boxes, config).run();
}

} // namespace relief
