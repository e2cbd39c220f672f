// Layout of what a patch keeps while rays are inside it: sixteen-wide boxes, two quad levels a step, over
// blocks of 4 x 2 micro-quads (15 vertices, 16 triangles: one 16-lane register an axis). Blocks are not
// stored: every vertex is kept once, in the grid of its tile, and a block is loaded out of three of its rows.
//
// A patch tree covers a tile of at most 64 x 64 cells. Finer patches have directories: nodes of the same kind
// over parts of the patch, down to the quarters of tiles. Only the directories and tiles that rays enter are
// made.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "relief/render.h"
#include "surface/patch/surface.h"

namespace relief::cpu {

inline constexpr int kTileLevel = 6;                 ///< a tile has at most 2^6 cells a side
inline constexpr int kQuarterLevel = kTileLevel - 1; ///< of the smallest parts that directories have boxes of
inline constexpr uint32_t kDirectories = 0x80000000u; ///< in place of tile indices: DirectoryPlace::number()

/// Boxes of up to sixteen children: lower x y z, upper x y z. Empty slots have lower +inf, upper -inf.
struct alignas(64) Node16 {
    float bounds[6][16];
};

/// Boxes of eight leaf blocks.
struct alignas(64) Node8 {
    float bounds[6][8];
};

/// What a cached object is of; equal keys mean equal bits.
struct TreeKey {
    uint32_t surface = 0, patch = 0, tile = 0;
    uint32_t levels = 0; ///< patch level and four edge levels, 5 x 4 bits

    friend bool operator==(const TreeKey&, const TreeKey&) = default;
};

/// Common head of the cached objects; `is_recent` is set by look-ups and cleared by the eviction's clock
/// hand.
struct alignas(64) CachedTree {
    TreeKey key;
    uint32_t byte_count = 0;
    std::atomic<uint8_t> is_recent{0};
};

/// The boxes of a tree of level kLevel, 3 or more: one node, or a root over sixteen.
template <int kLevel> struct TreeShape {
    static constexpr bool kHasGroups = kLevel >= 5;
    static constexpr bool kHasSquares = kLevel % 2 == 0; ///< leaves of 4 x 4 cells, else of 4 x 2
    static constexpr uint32_t kWidth = kHasSquares ? 16 : 8, kLeafBlocks = kHasSquares ? 2 : 1;
    using Node = std::conditional_t<kHasSquares, Node16, Node8>;
};

/// Tree over the cells of one tile with 2^level cells a side, level in [0, kTileLevel]. Boxes and vertices
/// follow the head:
/// - level 6: root, 16 Node16, 512 blocks; child g of the root covers 16 x 16 cells, its child k 4 x 4 of
///   them: blocks 2 (16 g + k) and the next;
/// - level 5: root, 16 Node8, 128 blocks; child g of the root covers 8 x 8 cells, its block k 4 x 2 of them;
/// - level 4: root, 32 blocks; child g covers 4 x 4 cells: blocks 2 g and 2 g + 1;
/// - level 3: one Node8, 8 blocks;
/// - levels 2, 1, 0: no boxes; 2, 1, 1 blocks.
struct PatchTree : CachedTree {
    uint32_t level = 0;
    uint32_t cell_x = 0, cell_y = 0; ///< first cell of the tile on the patch

    static constexpr uint32_t block_count(int level) {
        constexpr uint32_t kCounts[] = {1, 1, 2, 8, 32, 128, 512};
        return kCounts[level];
    }
    static constexpr size_t node_bytes(int level) {
        return level == 6   ? 17 * sizeof(Node16)
               : level == 5 ? sizeof(Node16) + 16 * sizeof(Node8)
               : level == 4 ? sizeof(Node16)
               : level == 3 ? sizeof(Node8)
                            : 0;
    }
    /// Vertices a row, and rows: those of a block at least. What a tile has less repeats its last column and
    /// row, which makes triangles without area that no ray hits.
    static constexpr uint32_t column_count(int level) { return level < 2 ? 5 : (1u << level) + 1; }
    static constexpr uint32_t row_count(int level) { return level < 1 ? 3 : (1u << level) + 1; }
    static constexpr uint32_t vertex_count(int level) { return column_count(level) * row_count(level); }
    /// Loads of whole registers read one number past the last vertex.
    static constexpr size_t vertex_bytes(int level) {
        return (3 * size_t(vertex_count(level)) + 1) * sizeof(float);
    }
    static constexpr size_t size_bytes(int level);
    /// Behind the head, whose size is a multiple of 64 bytes.
    const char* data() const { return reinterpret_cast<const char*>(this + 1); }
    char* data() { return reinterpret_cast<char*>(this + 1); }
    const Node16& root() const { return *reinterpret_cast<const Node16*>(data()); }
    Node16& root() { return *reinterpret_cast<Node16*>(data()); }
    /// The node above the leaves: of group g, or the only one (g = 0). kLevel is the tree's.
    template <int kLevel> const auto& node(uint32_t g) const {
        using Shape = TreeShape<kLevel>;
        return reinterpret_cast<const typename Shape::Node*>(data() +
                                                             (Shape::kHasGroups ? sizeof(Node16) : 0))[g];
    }
    template <int kLevel> auto& node(uint32_t g) {
        return const_cast<typename TreeShape<kLevel>::Node&>(
            const_cast<const PatchTree*>(this)->node<kLevel>(g));
    }
    /// x of all vertices, row by row, then y, then z. `own_level` is the tree's.
    const float* grid(int own_level) const {
        return reinterpret_cast<const float*>(data() + node_bytes(own_level));
    }
    /// The vertices of one axis.
    const float* vertices(int axis) const {
        return grid(int(level)) + uint32_t(axis) * vertex_count(int(level));
    }
    float* vertices(int axis) {
        return const_cast<float*>(const_cast<const PatchTree*>(this)->vertices(axis));
    }
    /// Number of a block's first vertex: of its lowest row and column.
    static uint32_t find_first_vertex(int level, uint32_t block) {
        uint32_t column = 0, row = 0;
        block_cell(level, block, column, row);
        return row * column_count(level) + column;
    }

    /// First cell (column, row) of a block within the tile.
    static void block_cell(int level, uint32_t block, uint32_t& column, uint32_t& row) {
        if (level == 6) {
            const uint32_t g = block >> 5, k = block >> 1 & 15;
            column = (g & 3) * 16 + (k & 3) * 4, row = (g >> 2) * 16 + (k >> 2) * 4 + (block & 1) * 2;
        } else if (level == 5) {
            const uint32_t g = block >> 3, k = block & 7;
            column = (g & 3) * 8 + (k & 1) * 4, row = (g >> 2) * 8 + (k >> 1) * 2;
        } else if (level == 4) {
            const uint32_t g = block >> 1;
            column = (g & 3) * 4, row = (g >> 2) * 4 + (block & 1) * 2;
        } else if (level == 3) {
            column = (block & 1) * 4, row = (block >> 1) * 2;
        } else {
            column = 0, row = block * 2;
        }
    }
};

constexpr size_t PatchTree::size_bytes(int level) {
    return sizeof(PatchTree) + node_bytes(level) + (vertex_bytes(level) + 63) / 64 * 64;
}

/// Place of a directory in its patch: part (x, y) of those of a step, which are side(step) by side(step).
/// Step 0 is the whole patch. The children of a directory are 4 x 4 parts of the next step (2 x 2 from the
/// whole patch where that makes an even number of halvings); those of the last step are the quarters of four
/// tiles. `level` is the patch's, above kTileLevel.
struct DirectoryPlace {
    uint32_t step = 0, x = 0, y = 0;

    static constexpr uint32_t step_count(uint32_t level) { return (level - kQuarterLevel + 1) / 2; }
    static constexpr uint32_t side(uint32_t level, uint32_t step) {
        return step == 0 ? 1 : 1u << (level - kQuarterLevel - 2 * (step_count(level) - step));
    }
    /// Children a side of a directory of this step, as a power of two.
    static constexpr uint32_t shift(uint32_t level, uint32_t step) {
        return step == 0 && (level - kQuarterLevel) % 2 == 1 ? 1 : 2;
    }
    constexpr bool is_last(uint32_t level) const { return step + 1 == step_count(level); }
    /// Child `number` of a node, by rows.
    constexpr DirectoryPlace child(uint32_t level, uint32_t number) const {
        const uint32_t bits = shift(level, step);
        return {step + 1, (x << bits) + (number & ((1u << bits) - 1)), (y << bits) + (number >> bits)};
    }
    /// The tile that this quarter of a tile belongs to.
    constexpr uint32_t tile(uint32_t level) const { return (y / 2) << (level - kTileLevel) | x / 2; }

    constexpr uint32_t number() const { return kDirectories | step << 24 | y << 12 | x; }
    static constexpr DirectoryPlace from_number(uint32_t number) {
        return {number >> 24 & 0x7f, number & 0xfff, number >> 12 & 0xfff};
    }
};

inline constexpr uint32_t kMostDirectorySteps = DirectoryPlace::step_count(kMaxLevel);

/// The boxes of the parts of a patch, or of a part of it, with bounds from the map.
struct TileDirectory : CachedTree {
    Node16 node;

    /// Returns which of the four tiles below a directory of the last step has child `child` as a quarter.
    static constexpr uint32_t find_tile_of_node(uint32_t child) {
        return (child >> 2 & 2) | (child >> 1 & 1);
    }
};

/// Builds `tree`, whose key, level, cell_x and cell_y are set, by evaluating the tile's vertices.
using BuildTreeFunction = void (*)(const Surface& surface, const PatchLevels& levels, PatchTree& tree);

/// Builds `directory`, whose key is set, from conservative boxes.
void build_tile_directory(const Surface& surface, const PatchLevels& levels, TileDirectory& directory);

} // namespace relief::cpu
