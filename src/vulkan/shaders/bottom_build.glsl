// Builds a job's patch tree with several lanes: vertices, bounds, leaves, then bottom-up (Harada 2015, listing 1.2).
// All lanes of the group must call these functions because of the barriers between levels.
//
// Vertices are stored before edge samples are snapped, so that coarser levels and edges find theirs. Boxes of boundary
// nodes also bound the snapped samples.
#ifndef RELIEF_BOTTOM_BUILD_GLSL
#define RELIEF_BOTTOM_BUILD_GLSL

#include "vulkan/shaders/patch_evaluation.glsl"
#include "vulkan/shaders/rays.glsl"
#include "formulas/quantise.h"
#include "formulas/patch_tree.h"

layout(constant_id = 1) const uint kLanes = 8; ///< lanes per tree
layout(constant_id = 2) const uint kDeepest = 5; ///< maximum level of the trees built here

#define POOL_DECLARED
layout(scalar, set = 0, binding = kBindPool) coherent buffer Pool { uint pool[]; };

shared uint shared_bounds[gl_WorkGroupSize.x / kLanes * 6u];

struct BuildJob {
    bool is_real;
    uint base;  ///< first word of the tree
    uint level; ///< of the tree
    uint coverage;
    SurfaceData s;
    uint patch_index;
    uint levels; ///< packed levels at which vertices are evaluated
    uint cell_x, cell_y;
    uint reversed;
};

/// The job of a tree with pairs in this round; its first pair determines the instance.
BuildJob make_build_job(uint tree, uint patch_count, uint pool_capacity) {
    BuildJob job;
    job.is_real = true;
    TreeRecord record = trees[tree];
    job.base = record.address % pool_capacity * kPoolUnitWords;
    job.coverage = record.coverage;
    job.level = uint(findMSB(record.coverage & 63u));
    if (tree >= patch_count) {
        TileRecord tile = tile_records[tree - patch_count];
        job.s = surfaces[instances[tile.instance].surface];
        job.patch_index = tile.patch_index;
        job.levels = tile.levels;
        job.cell_x = tile.cell_x;
        job.cell_y = tile.cell_y;
    } else {
        CandidateData candidate = candidates[pairs[record.begin].y];
        job.s = surfaces[instances[candidate.instance].surface];
        job.patch_index = candidate.patch_index;
        job.levels = pack_uniform_level(job.level);
        job.cell_x = job.cell_y = 0u;
    }
    return job;
}

uint tree_vertex_word(BuildJob job, uint i, uint j) {
    uint side = (1u << job.level) + 1u;
    return job.base + first_vertex_word(job.level) + 3u * (j * side + i);
}

vec3 read_vertex(BuildJob job, uint i, uint j) {
    uint word = tree_vertex_word(job, i, j);
    return vec3(uintBitsToFloat(pool[word]), uintBitsToFloat(pool[word + 1u]), uintBitsToFloat(pool[word + 2u]));
}

void reset_bounds(uint place, uint lane) {
    for (uint k = lane; k < 6u; k += kLanes) shared_bounds[6u * place + k] = k < 3u ? 0xffffffffu : 0u;
}

void build_vertices(inout BuildJob job, uint place, uint lane) {
    PatchCorners corners = load_corners(job.s, job.patch_index);
    job.reversed = find_reversed_edges(job.s, corners.quad, job.patch_index);
    uint side = (1u << job.level) + 1u;
    vec3 lower = vec3(kInfinity);
    vec3 upper = vec3(-kInfinity);
    for (uint v = lane; v < side * side; v += kLanes) {
        uint j = v / side;
        uint i = v - j * side;
        vec3 p = evaluate_sample(job.s, corners, job.patch_index, job.levels, job.cell_x + i, job.cell_y + j);
        uint word = tree_vertex_word(job, i, j);
        pool[word] = floatBitsToUint(p.x);
        pool[word + 1u] = floatBitsToUint(p.y);
        pool[word + 2u] = floatBitsToUint(p.z);
        lower = min(lower, p);
        upper = max(upper, p);
    }
    for (uint k = 0u; k < 3u; ++k) {
        atomicMin(shared_bounds[6u * place + k], order_float(lower[k]));
        atomicMax(shared_bounds[6u * place + 3u + k], order_float(upper[k]));
    }
}

struct TreeSpace {
    vec3 origin, scale;
};

TreeSpace find_space(uint place) {
    TreeSpace space;
    for (uint k = 0u; k < 3u; ++k) {
        space.origin[k] = unorder_float(shared_bounds[6u * place + k]);
        space.scale[k] = choose_scale(unorder_float(shared_bounds[6u * place + 3u + k]) - space.origin[k]);
    }
    return space;
}

void write_header(BuildJob job, TreeSpace space) {
    for (uint k = 0u; k < 3u; ++k) {
        pool[job.base + kTreeOrigin + k] = floatBitsToUint(space.origin[k]);
        pool[job.base + kTreeScale + k] = floatBitsToUint(space.scale[k]);
    }
    pool[job.base + kTreeLevel] = job.level;
    pool[job.base + kTreeReversed] = job.reversed;
}

/// A box in codes.
struct CodeBox {
    uvec3 lower, upper;
};

void extend_box(inout CodeBox box, TreeSpace space, vec3 p) {
    for (uint k = 0u; k < 3u; ++k) {
        box.lower[k] = min(box.lower[k], encode_lower(p[k], space.origin[k], space.scale[k]));
        box.upper[k] = max(box.upper[k], encode_upper(p[k], space.origin[k], space.scale[k]));
    }
}

void extend_by_moved(BuildJob job, TreeSpace space, uvec4 i_j_edge_level, inout CodeBox box) {
    uint level = i_j_edge_level.w;
    uint edge = i_j_edge_level.z;
    if (find_sample_edge(i_j_edge_level.x, i_j_edge_level.y, level) == 4u) return;
    uint moves = need_moves(job.coverage, edge);
    for (uint shift = 1u; shift <= kTreeLevels; ++shift) {
        if (((moves >> shift) & 1u) == 0u) continue;
        GridSample moved = move_boundary_sample(i_j_edge_level.x, i_j_edge_level.y, level, edge, min(shift, level),
                                                job.reversed);
        uint finer = job.level - level;
        extend_box(box, space, read_vertex(job, moved.i << finer, moved.j << finer));
    }
}

/// Extends a box by the snapped corners of node (x, y) of a level, for all coarser edges.
void extend_boundary(BuildJob job, TreeSpace space, uvec2 node, uint level, inout CodeBox box) {
    if ((job.coverage & ~63u) == 0u) return;
    uint n = 1u << level;
    for (uint k = 0u; k < 8u; ++k) {
        uint edge = k >> 1u;
        uint end = k & 1u;
        bool is_row = (edge & 1u) == 0u;
        bool is_far = edge == 1u || edge == 2u;
        uint across = is_row ? node.y : node.x;
        if (across != (is_far ? n - 1u : 0u)) continue;
        uint border = is_far ? n : 0u;
        uvec2 corner = is_row ? uvec2(node.x + end, border) : uvec2(border, node.y + end);
        extend_by_moved(job, space, uvec4(corner, edge, level), box);
    }
}

CodeBox find_leaf_box(BuildJob job, TreeSpace space, uvec2 cell) {
    CodeBox box = CodeBox(uvec3(0xffffu), uvec3(0u));
    for (uint k = 0u; k < 4u; ++k) extend_box(box, space, read_vertex(job, cell.x + (k & 1u), cell.y + (k >> 1u)));
    return box;
}

/// Union of the quantised children.
CodeBox find_inner_box(BuildJob job, uint level, uint number) {
    uint children = job.base + kTreeHeaderWords + kTreeNodeWords * (count_nodes_above(level + 1u) + 4u * number);
    CodeBox box = CodeBox(uvec3(0xffffu), uvec3(0u));
    for (uint child = 0u; child < 4u; ++child)
        for (uint k = 0u; k < 3u; ++k) {
            uint codes = pool[children + kTreeNodeWords * child + k];
            box.lower[k] = min(box.lower[k], codes & 0xffffu);
            box.upper[k] = max(box.upper[k], codes >> 16u);
        }
    return box;
}

void build_node(BuildJob job, TreeSpace space, uint level, uint number) {
    uvec2 node = uvec2(morton_column(number), morton_row(number));
    CodeBox box;
    if (level == job.level)
        box = find_leaf_box(job, space, node);
    else
        box = find_inner_box(job, level, number);
    extend_boundary(job, space, node, level, box);
    uint word = job.base + kTreeHeaderWords + kTreeNodeWords * (count_nodes_above(level) + number);
    for (uint k = 0u; k < 3u; ++k) pool[word + k] = box.lower[k] | box.upper[k] << 16u;
}

void wait_for_group() {
    memoryBarrierBuffer();
    memoryBarrierShared();
    barrier();
}

/// `place`: index of the job in the group; `lane`: index of this invocation in the job.
void build_tree(BuildJob job, uint place, uint lane) {
    reset_bounds(place, lane);
    wait_for_group();
    if (job.is_real) build_vertices(job, place, lane);
    wait_for_group();
    TreeSpace space = find_space(place);
    if (job.is_real && lane == 0u) write_header(job, space);
    for (int level = int(kDeepest); level >= 0; --level) {
        if (job.is_real && uint(level) <= job.level)
            for (uint number = lane; number < 1u << (2 * level); number += kLanes)
                build_node(job, space, uint(level), number);
        wait_for_group();
    }
}

#endif
