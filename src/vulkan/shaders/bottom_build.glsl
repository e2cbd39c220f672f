// Builds a job's patch tree with several lanes: vertices, bounds, leaves, then bottom-up (Harada 2015, listing 1.2).
// All lanes of the group must call these functions because of the barriers between levels.
//
// What lanes exchange lies in shared memory, less than the 16 KiB that every device has. Vertices are stored before
// edge samples are snapped, so that coarser levels and edges find theirs. Boxes of boundary nodes also bound the
// snapped samples.
#ifndef RELIEF_BOTTOM_BUILD_GLSL
#define RELIEF_BOTTOM_BUILD_GLSL

#include "vulkan/shaders/patch_evaluation.glsl"
#include "vulkan/shaders/rays.glsl"
#include "formulas/quantise.h"
#include "formulas/patch_tree.h"

layout(constant_id = 1) const uint kLanes = 8; ///< lanes per tree
layout(constant_id = 2) const uint kDeepest = 5; ///< maximum level of the trees built here, at least 1

#define POOL_DECLARED
layout(scalar, set = 0, binding = kBindPool) coherent buffer Pool { uint pool[]; };

const uint kJobs = gl_WorkGroupSize.x / kLanes; ///< per group
const uint kSide = (1u << kDeepest) + 1u;
const uint kInnerNodes = 1u << (2u * kDeepest - 2u); ///< most nodes of the level above the leaves

// Vertices that samples are blended from: of a patch its four corners, the ends of the lines of its four edges, and
// the dominant vertices of its corners. Then, of each edge, whether its line is reversed.
const uint kLineSlot = 4u;
const uint kDominantSlot = 12u;
const uint kSlots = 16u;
const uint kPositionWord = 0u;
const uint kUvWord = 3u;
const uint kFrameWord = 5u; ///< t, b, n
const uint kTileWord = 14u;
const uint kSlotWords = 15u;
const uint kPatchWords = kSlots * kSlotWords + 4u;
const uint kWords = 3u * kInnerNodes > kPatchWords ? 3u * kInnerNodes : kPatchWords;

shared uint shared_bounds[6u * kJobs];
shared float shared_vertices[3u * kSide * kSide * kJobs];
/// While vertices are evaluated, what they are blended from. Then the codes of each node above the leaves, in the place
/// of the first of its descendants on the level above the leaves.
shared uint shared_words[kWords * kJobs];

struct BuildJob {
    bool is_real;
    uint place; ///< in the group
    uint base;  ///< first word of the tree
    uint level; ///< of the tree
    uint coverage;
    uint surface;
    uint patch_index;
    uint levels; ///< packed levels at which vertices are evaluated
    uint cell_x, cell_y;
    uint reversed;
};

/// The job of a tree with pairs in this round; its first pair determines the instance. A group that has one job knows
/// that all that follows from it is the same for all lanes.
BuildJob make_build_job(uint tree, const uint place, const uint patch_count, const uint pool_capacity) {
    BuildJob job;
    job.is_real = true;
    job.place = place;
    if (kJobs == 1u) {
        job.place = 0u;
        tree = subgroupBroadcastFirst(tree);
    }
    TreeRecord record = trees[tree];
    job.base = record.address % pool_capacity * kPoolUnitWords;
    job.coverage = record.coverage;
    job.level = uint(findMSB(record.coverage & 63u));
    if (tree >= patch_count) {
        TileRecord tile = tile_records[tree - patch_count];
        job.surface = instances[tile.instance].surface;
        job.patch_index = tile.patch_index;
        job.levels = tile.levels;
        job.cell_x = tile.cell_x;
        job.cell_y = tile.cell_y;
    } else {
        CandidateData candidate = candidates[pairs[record.begin].y];
        job.surface = instances[candidate.instance].surface;
        job.patch_index = candidate.patch_index;
        job.levels = pack_uniform_level(job.level);
        job.cell_x = job.cell_y = 0u;
    }
    return job;
}

uint find_vertex(const BuildJob job, const uint i, const uint j) { return j * ((1u << job.level) + 1u) + i; }

vec3 read_vertex(const BuildJob job, const uint i, const uint j) {
    uint word = 3u * (job.place * kSide * kSide + find_vertex(job, i, j));
    return vec3(shared_vertices[word], shared_vertices[word + 1u], shared_vertices[word + 2u]);
}

void write_vertex(const BuildJob job, const uint i, const uint j, const vec3 p) {
    uint vertex = find_vertex(job, i, j);
    uint word = 3u * (job.place * kSide * kSide + vertex);
    uint pool_word = job.base + first_vertex_word(job.level) + 3u * vertex;
    for (uint k = 0u; k < 3u; ++k) {
        shared_vertices[word + k] = p[k];
        pool[pool_word + k] = floatBitsToUint(p[k]);
    }
}

void reset_bounds(const uint place, const uint lane) {
    for (uint k = lane; k < 6u; k += kLanes) shared_bounds[6u * place + k] = k < 3u ? 0xffffffffu : 0u;
}

uint slot_word(const BuildJob job, const uint slot) { return job.place * kWords + slot * kSlotWords; }

void share_vertex(const BuildJob job, const uint slot, const VertexData data) {
    uint word = slot_word(job, slot);
    for (uint k = 0u; k < 3u; ++k) {
        shared_words[word + kPositionWord + k] = floatBitsToUint(data.position[k]);
        shared_words[word + kFrameWord + k] = floatBitsToUint(data.t[k]);
        shared_words[word + kFrameWord + 3u + k] = floatBitsToUint(data.b[k]);
        shared_words[word + kFrameWord + 6u + k] = floatBitsToUint(data.n[k]);
    }
    shared_words[word + kUvWord] = floatBitsToUint(data.uv.x);
    shared_words[word + kUvWord + 1u] = floatBitsToUint(data.uv.y);
    shared_words[word + kTileWord] = data.tile;
}

/// The vertices that samples are blended from.
void share_patch(const BuildJob job, const uint lane) {
    SurfaceData s = surfaces[job.surface];
    uvec4 quad = load_quad(s, job.patch_index);
    [[dont_unroll]] for (uint slot = lane; slot < kSlots; slot += kLanes) {
        uint vertex = slot < kLineSlot ? quad[slot] : load_dominant(s, quad[slot & 3u]);
        if (slot >= kLineSlot && slot < kDominantSlot) {
            uint edge = (slot - kLineSlot) >> 1u;
            EdgeLine line = find_edge_line(s, quad, job.patch_index, edge);
            bool is_second = (slot & 1u) != 0u;
            vertex = is_second ? line.second : line.first;
            if (!is_second) shared_words[slot_word(job, kSlots) + edge] = line.is_reversed ? 1u << edge : 0u;
        }
        share_vertex(job, slot, load_vertex(s, vertex));
    }
}

uint read_reversed(const BuildJob job) {
    uint word = slot_word(job, kSlots);
    return shared_words[word] | shared_words[word + 1u] | shared_words[word + 2u] | shared_words[word + 3u];
}

float read_slot(const uint word) { return uintBitsToFloat(shared_words[word]); }

float blend_inside(const uint word, const vec2 at) {
    return blend_quad(read_slot(word), read_slot(word + kSlotWords), read_slot(word + 2u * kSlotWords),
                      read_slot(word + 3u * kSlotWords), at.x, at.y);
}
vec3 blend_vector_inside(const uint word, const vec2 at) {
    return vec3(blend_inside(word, at), blend_inside(word + 1u, at), blend_inside(word + 2u, at));
}

bool needs_frame(const SurfaceData s) { return s.map != kNone && maps[s.map].is_tangent != 0u; }

/// Attributes at `at` inside a patch.
VertexData evaluate_inside(const BuildJob job, const SurfaceData s, const uvec4 quad, const vec2 at) {
    uint word = slot_word(job, 0u);
    VertexData base;
    base.position = is_bicubic(s) ? evaluate_base(s, quad, job.patch_index, at.x, at.y)
                                  : blend_vector_inside(word + kPositionWord, at);
    base.uv = vec2(blend_inside(word + kUvWord, at), blend_inside(word + kUvWord + 1u, at));
    base.t = base.b = base.n = vec3(0.0);
    if (needs_frame(s)) {
        base.t = blend_vector_inside(word + kFrameWord, at);
        base.b = blend_vector_inside(word + kFrameWord + 3u, at);
        base.n = blend_vector_inside(word + kFrameWord + 6u, at);
    }
    base.tile = shared_words[word + kTileWord];
    return base;
}

vec3 read_slot_vector(const uint word) { return vec3(read_slot(word), read_slot(word + 1u), read_slot(word + 2u)); }
vec3 blend_vector_along(const uint first, const uint second, const float s) {
    return blend_vectors(read_slot_vector(first), read_slot_vector(second), s);
}

/// Attributes on the boundary of a patch. The ends of `place` are slots.
VertexData evaluate_along(const BuildJob job, const SurfaceData s, const uvec4 quad, const LinePlace place) {
    uint first = slot_word(job, place.first);
    uint second = slot_word(job, place.second);
    VertexData base;
    base.position = blend_vector_along(first + kPositionWord, second + kPositionWord, place.s);
    if (is_bicubic(s) && place.control != kNone)
        base.position = blend_cubic_vectors(read_slot_vector(first + kPositionWord),
                                            load_control(s, quad, job.patch_index, place.control),
                                            load_control(s, quad, job.patch_index, place.end_control),
                                            read_slot_vector(second + kPositionWord), weigh_cubic(place.s));
    base.uv = vec2(blend(read_slot(first + kUvWord), read_slot(second + kUvWord), place.s),
                   blend(read_slot(first + kUvWord + 1u), read_slot(second + kUvWord + 1u), place.s));
    base.t = base.b = base.n = vec3(0.0);
    if (needs_frame(s)) {
        base.t = blend_vector_along(first + kFrameWord, second + kFrameWord, place.s);
        base.b = blend_vector_along(first + kFrameWord + 3u, second + kFrameWord + 3u, place.s);
        base.n = blend_vector_along(first + kFrameWord + 6u, second + kFrameWord + 6u, place.s);
    }
    base.tile = shared_words[first + kTileWord];
    return base;
}

LinePlace place_at_corner(const uint corner) {
    return LinePlace(kDominantSlot + corner, kDominantSlot + corner, 0.0, kNone, kNone, kMipCorners + corner);
}

/// As find_corner() and find_edge_place() have it, with slots in place of vertices.
LinePlace place_on_boundary(const BuildJob job, const uint i, const uint j) {
    uint edge = find_sample_edge(i, j, packed_patch_level(job.levels));
    if (edge == 4u) return place_at_corner(find_grid_corner(i, j));
    EdgeSample moved = snap_edge_sample(job.levels, uvec3(i, j, edge), ((job.reversed >> edge) & 1u) != 0u);
    if (moved.corner != kNone) return place_at_corner(moved.corner);
    return LinePlace(kLineSlot + 2u * edge, kLineSlot + 2u * edge + 1u, moved.s, moved.control, moved.end_control,
                     kMipEdges + edge);
}

/// Sample (i, j) of the tree, as find_sample() of sample_evaluation.glsl has it.
vec3 evaluate_tree_sample(const BuildJob job, const SurfaceData s, const uvec4 quad, const uint mips, uint i, uint j) {
    i += job.cell_x;
    j += job.cell_y;
    VertexData base;
    uint mip_place = kMipInside;
    if (is_on_boundary(job.levels, i, j)) {
        LinePlace place = place_on_boundary(job, i, j);
        base = evaluate_along(job, s, quad, place);
        mip_place = place.mip_place;
    } else {
        float cell = 1.0 / float(1u << packed_patch_level(job.levels));
        base = evaluate_inside(job, s, quad, vec2(float(i) * cell, float(j) * cell));
    }
    return displace(s, base, packed_mip(mips, mip_place));
}

/// Column and row of vertex v: first those inside, by rows, then the border, around: the latter have other work to do.
uvec2 place_vertex(const uint level, uint v) {
    uint n = 1u << level;
    uint inner = n - 1u;
    if (v < inner * inner) return uvec2(1u + v % inner, 1u + v / inner);
    v -= inner * inner;
    uint along = v & (n - 1u);
    uint edge = v >> level;
    if (edge == 0u) return uvec2(along, 0u);
    if (edge == 1u) return uvec2(n, along);
    return edge == 2u ? uvec2(n - along, n) : uvec2(0u, n - along);
}

void build_vertices(inout BuildJob job, const uint lane) {
    SurfaceData s = surfaces[job.surface];
    uvec4 quad = load_quad(s, job.patch_index);
    uint mips = load_mips(s, job.patch_index);
    job.reversed = read_reversed(job);
    uint side = (1u << job.level) + 1u;
    vec3 lower = vec3(kInfinity);
    vec3 upper = vec3(-kInfinity);
    [[dont_unroll]] for (uint v = lane; v < side * side; v += kLanes) {
        uvec2 at = place_vertex(job.level, v);
        vec3 p = evaluate_tree_sample(job, s, quad, mips, at.x, at.y);
        write_vertex(job, at.x, at.y, p);
        lower = min(lower, p);
        upper = max(upper, p);
    }
    for (uint k = 0u; k < 3u; ++k) {
        atomicMin(shared_bounds[6u * job.place + k], order_float(lower[k]));
        atomicMax(shared_bounds[6u * job.place + 3u + k], order_float(upper[k]));
    }
}

struct TreeSpace {
    vec3 origin, scale;
};

TreeSpace find_space(const uint place) {
    TreeSpace space;
    for (uint k = 0u; k < 3u; ++k) {
        space.origin[k] = unorder_float(shared_bounds[6u * place + k]);
        space.scale[k] = choose_scale(unorder_float(shared_bounds[6u * place + 3u + k]) - space.origin[k]);
    }
    return space;
}

void write_header(const BuildJob job, const TreeSpace space) {
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

CodeBox make_empty_box() { return CodeBox(uvec3(0xffffu), uvec3(0u)); }

void extend_box(inout CodeBox box, const TreeSpace space, const vec3 lower, const vec3 upper) {
    for (uint k = 0u; k < 3u; ++k) {
        box.lower[k] = min(box.lower[k], encode_lower(lower[k], space.origin[k], space.scale[k]));
        box.upper[k] = max(box.upper[k], encode_upper(upper[k], space.origin[k], space.scale[k]));
    }
}

void extend_by_moved(const BuildJob job, const TreeSpace space, const uvec4 i_j_edge_level, inout CodeBox box) {
    uint level = i_j_edge_level.w;
    uint edge = i_j_edge_level.z;
    if (find_sample_edge(i_j_edge_level.x, i_j_edge_level.y, level) == 4u) return;
    uint moves = need_moves(job.coverage, edge);
    [[dont_unroll]] for (uint shift = 1u; shift <= kTreeLevels; ++shift) {
        if (((moves >> shift) & 1u) == 0u) continue;
        GridSample moved = move_boundary_sample(i_j_edge_level.x, i_j_edge_level.y, level, edge, min(shift, level),
                                                job.reversed);
        uint finer = job.level - level;
        vec3 p = read_vertex(job, moved.i << finer, moved.j << finer);
        extend_box(box, space, p, p);
    }
}

/// Extends a box by the snapped corners of node (x, y) of a level, for all coarser edges.
void extend_boundary(const BuildJob job, const TreeSpace space, const uvec2 node, const uint level, inout CodeBox box) {
    if ((job.coverage & ~63u) == 0u) return;
    uint n = 1u << level;
    [[dont_unroll]] for (uint k = 0u; k < 8u; ++k) {
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

/// Codes grow with what they encode: those of a box are the least and greatest of its vertices'.
CodeBox find_leaf_box(const BuildJob job, const TreeSpace space, const uvec2 cell) {
    vec3 lower = read_vertex(job, cell.x, cell.y);
    vec3 upper = lower;
    for (uint k = 1u; k < 4u; ++k) {
        vec3 p = read_vertex(job, cell.x + (k & 1u), cell.y + (k >> 1u));
        lower = min(lower, p);
        upper = max(upper, p);
    }
    CodeBox box = make_empty_box();
    extend_box(box, space, lower, upper);
    return box;
}

void write_node(const BuildJob job, const uint level, const uint number, const CodeBox box) {
    uint word = job.base + kTreeHeaderWords + kTreeNodeWords * (count_nodes_above(level) + number);
    for (uint k = 0u; k < 3u; ++k) pool[word + k] = box.lower[k] | box.upper[k] << 16u;
}

/// Of node `number` of `level`, above the leaves.
uint find_code_word(const BuildJob job, const uint level, const uint number) {
    return job.place * kWords + 3u * ((number << (2u * (job.level - 1u - level))));
}

void finish_node(const BuildJob job, const TreeSpace space, const uint level, const uint number, CodeBox box) {
    extend_boundary(job, space, uvec2(morton_column(number), morton_row(number)), level, box);
    write_node(job, level, number, box);
    uint word = find_code_word(job, level, number);
    for (uint k = 0u; k < 3u; ++k) shared_words[word + k] = box.lower[k] | box.upper[k] << 16u;
}

/// A node of the level above the leaves, with its leaves.
void build_last_nodes(const BuildJob job, const TreeSpace space, const uint number) {
    CodeBox box = make_empty_box();
    [[dont_unroll]] for (uint leaf = 4u * number; leaf < 4u * number + 4u; ++leaf) {
        uvec2 cell = uvec2(morton_column(leaf), morton_row(leaf));
        CodeBox own = find_leaf_box(job, space, cell);
        extend_boundary(job, space, cell, job.level, own);
        write_node(job, job.level, leaf, own);
        box.lower = min(box.lower, own.lower);
        box.upper = max(box.upper, own.upper);
    }
    finish_node(job, space, job.level - 1u, number, box);
}

/// Union of the quantised children, which are nodes above the leaves.
void build_node(const BuildJob job, const TreeSpace space, const uint level, const uint number) {
    CodeBox box = make_empty_box();
    [[dont_unroll]] for (uint child = 0u; child < 4u; ++child) {
        uint word = find_code_word(job, level + 1u, 4u * number + child);
        for (uint k = 0u; k < 3u; ++k) {
            uint codes = shared_words[word + k];
            box.lower[k] = min(box.lower[k], codes & 0xffffu);
            box.upper[k] = max(box.upper[k], codes >> 16u);
        }
    }
    finish_node(job, space, level, number, box);
}

/// The tree of a patch that is one cell.
void build_only_leaf(const BuildJob job, const TreeSpace space) {
    CodeBox box = find_leaf_box(job, space, uvec2(0u));
    extend_boundary(job, space, uvec2(0u), 0u, box);
    write_node(job, 0u, 0u, box);
}

void wait_for_group() {
    memoryBarrierBuffer();
    memoryBarrierShared();
    barrier();
}

/// `lane`: index of this invocation in the job.
void build_tree(BuildJob job, const uint lane) {
    reset_bounds(job.place, lane);
    if (job.is_real) share_patch(job, lane);
    wait_for_group();
    if (job.is_real) build_vertices(job, lane);
    wait_for_group();
    TreeSpace space = find_space(job.place);
    if (job.is_real && lane == 0u) write_header(job, space);
    if (job.is_real && job.level > 0u)
        [[dont_unroll]] for (uint number = lane; number < 1u << (2u * job.level - 2u); number += kLanes)
            build_last_nodes(job, space, number);
    if (job.is_real && job.level == 0u && lane == 0u) build_only_leaf(job, space);
    [[dont_unroll]] for (int level = int(kDeepest) - 2; level >= 0; --level) {
        wait_for_group();
        if (job.is_real && uint(level) + 1u < job.level)
            [[dont_unroll]] for (uint number = lane; number < 1u << (2 * level); number += kLanes)
                build_node(job, space, uint(level), number);
    }
}

#endif
