// Figures of the paper: its table of models and statements in its text.
#pragma once

#include <array>
#include <string_view>

#include "bench/paper_statement.h"

namespace relief::bench {

/// 1024 x 1024 pixels, primary and shadow rays, one GPU of a GeForce GTX 590. Percentages are printed without
/// labels; triangles per leaf determine their assignment. Bytes per triangle and the bound on rays per second
/// are derived from the paper's figures.
struct Paper2Model {
    std::string_view stands_for, model;
    double triangles, levels, frames_per_second, triangles_a_leaf, used_share, heap_bytes;
};

/// 0 frames per second: the paper shows a bar without a number.
inline constexpr std::array<Paper2Model, 3> kPaper2Models = {
    {{"body", "Stanford Bunny", 69451, 18, 94, 1.72, 0.31, 8.0 * (1 << 20)},
     {"hall", "Crytek Sponza", 279163, 21, 0, 2.98, 0.09, 64.0 * (1 << 20)},
     {"knot", "Welsh Dragon", 2097152, 23, 31, 2.35, 0.22, 256.0 * (1 << 20)}}};

inline constexpr std::array<PaperStatement, 4> kPaper2Statements = {
    {{"casts",
      "against a SAH tree built on the CPU and walked with a stack: equal on the bunny, slower on Sponza and "
      "the dragon"},
     {"casts", "without shadow rays a frame is up to twice as fast"},
     {"casts", "shadow and reflection rays start at the node of the last hit; what that gains is not told"},
     {"builds", "hundreds of small triangles of one code in a leaf are the weakness of the linear tree"}}};

inline constexpr std::array<std::string_view, 5> kPaper2Comparable = {
    "Our meshes have the paper's numbers of triangles and about its unevenness, but are other models.",
    "Tree sizes compare: slots in use, depth of the heap, triangles a leaf, bytes a triangle.",
    "Frames a second do not: another device, and the paper's frame shades too. Ratios of traversals on one "
    "device "
    "are what can be compared.",
    "The paper sorts on the GPU up to 2^18 primitives and builds larger trees on the CPU; it prints no build "
    "times.",
    "Times are of the walks alone: no shading, no making of rays, no transfers."};

} // namespace relief::bench
