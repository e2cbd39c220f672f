#include "vulkan/tile_directory.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "base/parallel.h"
#include "formulas/patch_tree.h"
#include "vulkan/layout/bindings.h"
#include "vulkan/layout/device_rays.h"
#include "vulkan/layout/device_scene.h"

namespace relief::vulkan {

namespace {

constexpr uint32_t kTileCells = 1u << scalar::kTreeLevels;
constexpr size_t kFirstTableSize = 64;
constexpr size_t kMostNewTiles = size_t(1) << 18; ///< per call

} // namespace

/// Bounds of the tiles of one patch, row by row.
struct TileDirectories::Boxes {
    uint32_t side; ///< tiles
    std::vector<Box> boxes;
};

TileDirectories::TileDirectories(const Device& device, const PreparedScene& scene,
                                 const DeviceScene& device_scene)
    : device_(device),
      scene_(scene),
      device_scene_(device_scene),
      table_(kFirstTableSize, {scalar::kNone, 0, 0}),
      node_count_(device_scene.node_count()) {
    for (const Instance& instance : scene.instances)
        if (scene.surfaces[instance.surface].has_displacement)
            finest_level_ = std::max(finest_level_, instance.levels->max_level());
    tile_buffer_ = Buffer(device, {"tile records", 0, Purpose::structures});
    table_buffer_ =
        Buffer(device, {"tile directories", table_.size() * sizeof(table_[0]), Purpose::structures});
    table_buffer_.upload(table_);
}

void TileDirectories::bind(BindingTable& bindings) const {
    bindings.bind(scalar::kBindTileRecords, tile_buffer_);
    bindings.bind(scalar::kBindDirectories, table_buffer_);
    if (nodes_) bindings.bind(scalar::kBindNodes, nodes_);
}

void TileDirectories::build(std::span<const scalar::RequestData> requests, Commands& commands,
                            BindingTable& bindings) {
    // Removes duplicates; sorted, so that tile indices do not depend on the order of requests.
    std::map<std::pair<uint32_t, uint32_t>, scalar::RequestData> unique;
    for (const scalar::RequestData& request : requests) {
        const uint32_t surface = scene_.instances[request.instance].surface;
        unique.try_emplace({device_scene_.first_patch(surface) + request.patch_index, request.levels},
                           request);
    }
    new_nodes_.clear();
    const uint32_t first_node = node_count_;
    const size_t first_tile = tiles_.size();
    const size_t most_tiles = tiles_.size() + kMostNewTiles; // the remaining requests are repeated
    for (const auto& [key, request] : unique) {
        if (tiles_.size() >= most_tiles) break;
        const Boxes boxes = compute_boxes(request);
        const uint32_t first_tree = device_scene_.patch_count() + tile_count();
        for (uint32_t k = 0; k < boxes.boxes.size(); ++k)
            tiles_.push_back({request.instance, request.patch_index, request.levels,
                              k % boxes.side * kTileCells, k / boxes.side * kTileCells});
        insert({key.first, key.second, append_tree(boxes, first_tree)});
    }
    upload_nodes(first_node, commands);
    upload_tiles(first_tile);
    if (table_.size() * sizeof(table_[0]) > table_buffer_.byte_count())
        table_buffer_ =
            Buffer(device_, {"tile directories", table_.size() * sizeof(table_[0]), Purpose::structures});
    table_buffer_.upload(table_);
    bind(bindings);
}

TileDirectories::Boxes TileDirectories::compute_boxes(const scalar::RequestData& request) const {
    const Surface& surface = scene_.surfaces[scene_.instances[request.instance].surface];
    const PatchLevels levels = unpack_levels(request.levels);
    Boxes boxes{1u << (levels.patch - scalar::kTreeLevels), {}};
    boxes.boxes.resize(size_t(boxes.side) * boxes.side);
    // Neither box contains the other; the tile lies in their intersection.
    const Box whole = compute_patch_box(surface, request.patch_index);
    parallel_for("tile_boxes", boxes.boxes.size(), 4, [&](size_t begin, size_t end) {
        for (size_t k = begin; k < end; ++k) {
            const uint32_t x = uint32_t(k) % boxes.side * kTileCells,
                           y = uint32_t(k) / boxes.side * kTileCells;
            const Box tile = compute_tile_box(surface, request.patch_index, levels,
                                              {x, y, x + kTileCells, y + kTileCells});
            boxes.boxes[k] = {max(tile.lower, whole.lower), min(tile.upper, whole.upper)};
        }
    });
    return boxes;
}

uint32_t TileDirectories::append_tree(const Boxes& boxes, uint32_t first_tree) {
    const uint32_t root = node_count_++;
    new_nodes_.emplace_back();
    append_node(boxes, uint32_t(new_nodes_.size()) - 1, first_tree, {0, 0, boxes.side});
    return root;
}

/// Fills node `place` of new_nodes_ with the tiles of a square (x, y, side), split by columns, then by rows.
void TileDirectories::append_node(const Boxes& boxes, uint32_t place, uint32_t first_tree,
                                  const std::array<uint32_t, 3>& square) {
    const auto [x, y, side] = square;
    Box box;
    for (uint32_t row = y; row < y + side; ++row)
        for (uint32_t column = x; column < x + side; ++column)
            box.extend(boxes.boxes[row * boxes.side + column]);
    if (side == 1) {
        new_nodes_[place] = {box.lower, first_tree + y * boxes.side + x, box.upper,
                             scalar::kNodeTile << scalar::kNodeKindShift | 1u};
        return;
    }
    const uint32_t half = side / 2, base = node_count_ - uint32_t(new_nodes_.size());
    const uint32_t columns = uint32_t(new_nodes_.size());
    new_nodes_.resize(columns + 6);
    node_count_ += 6;
    new_nodes_[place] = {box.lower, base + columns, box.upper, scalar::kNodeInner << scalar::kNodeKindShift};
    for (uint32_t column = 0; column < 2; ++column) {
        const uint32_t rows = columns + 2 + 2 * column;
        Box half_box;
        for (uint32_t row = 0; row < 2; ++row) {
            append_node(boxes, rows + row, first_tree, {x + column * half, y + row * half, half});
            half_box.extend({new_nodes_[rows + row].lower, new_nodes_[rows + row].upper});
        }
        new_nodes_[columns + column] = {half_box.lower, base + rows, half_box.upper,
                                        scalar::kNodeInner << scalar::kNodeKindShift};
    }
}

void TileDirectories::insert(const scalar::DirectoryData& directory) {
    if (2 * ++directory_count_ > table_.size()) {
        std::vector<scalar::DirectoryData> old(2 * table_.size(), {scalar::kNone, 0, 0});
        std::swap(old, table_);
        for (const scalar::DirectoryData& moved : old)
            if (moved.patch_number != scalar::kNone) place_in_table(moved);
    }
    place_in_table(directory);
}

void TileDirectories::place_in_table(const scalar::DirectoryData& directory) {
    uint32_t place = scalar::hash_directory(directory.patch_number, directory.levels) & directory_mask();
    while (table_[place].patch_number != scalar::kNone) place = (place + 1) & directory_mask();
    table_[place] = directory;
}

void TileDirectories::upload_nodes(uint32_t first_node, Commands& commands) {
    const uint64_t needed = uint64_t(node_count_) * sizeof(NodeTexels);
    if (needed > node_capacity_) {
        const uint64_t capacity = needed + needed / 2;
        Buffer larger(device_, {"nodes with tiles", capacity, Purpose::structures, TexelFormat::rgba32_uint});
        commands.copy(nodes_ ? nodes_ : device_scene_.nodes(), 0, larger, 0,
                      uint64_t(first_node) * sizeof(NodeTexels));
        commands.run();
        nodes_ = std::move(larger);
        node_capacity_ = capacity;
    }
    nodes_.upload(new_nodes_, uint64_t(first_node) * sizeof(NodeTexels));
}

void TileDirectories::upload_tiles(size_t first_tile) {
    const uint64_t needed = tiles_.size() * sizeof(tiles_[0]);
    if (needed > tile_buffer_.byte_count()) {
        tile_buffer_ = Buffer(device_, {"tile records", needed + needed / 2, Purpose::structures});
        first_tile = 0;
    }
    tile_buffer_.upload(std::as_bytes(std::span(tiles_).subspan(first_tile)), first_tile * sizeof(tiles_[0]));
}

} // namespace relief::vulkan
