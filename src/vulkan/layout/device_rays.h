// Rays, hits and pairs exchanged by device kernels. Scalar block layout, members of 4 bytes.
#ifndef RELIEF_DEVICE_RAYS_H
#define RELIEF_DEVICE_RAYS_H
#include "formulas/sobol.h"

#include "formulas/begin.h"

/// World space; hits lie in (t_min, t_max].
struct RayData {
    Vec3 origin;
    float t_min;
    Vec3 direction;
    float t_max;
    uint lod_bias; ///< number of levels by which patches are coarser
};

/// Nearest hit so far. Any-hit rays only set `instance`: kNone if unoccluded, else 0.
struct HitData {
    float t;          ///< infinity: no hit
    uint instance;    ///< kNone: no hit
    uint patch_index; ///< of the surface
    float u, v;       ///< on the patch
    uint cell;        ///< make_cell_rank: (j, i, is_upper) at the patch's own level
    uint levels;      ///< packed levels of the patch as this ray saw it
};

/// Order among hits at one distance: by row, column, lower triangle first. Levels are at most 12.
FN uint make_cell_rank(uint i, uint j, uint is_upper) { return j << 13u | i << 1u | is_upper; }
FN uint cell_column(uint cell) { return cell >> 1u & 0xfffu; }
FN uint cell_row(uint cell) { return cell >> 13u & 0xfffu; }
FN uint cell_is_upper(uint cell) { return cell & 1u; }

/// Progress of a ray through its candidates, ordered by (entry, instance, tree): later ones are next.
struct CursorData {
    float entry;
    uint instance, tree;
};

/// A patch or tile that a ray may hit.
struct CandidateData {
    uint instance, tree;
    uint patch_index;
    uint levels; ///< packed, as this ray sees the patch
    float entry; ///< entry distance into its box
};

/// A patch above level 5 whose tiles a ray requests.
struct RequestData {
    uint instance, patch_index, levels;
};

/// Size of the bit set of requested patches.
const uint kRequestBits = 65536u;

/// Entry of the hash table of directories: the tree over the tiles of a patch at given levels.
struct DirectoryData {
    uint patch_number; ///< of the patch among all; kNone: empty
    uint levels;
    uint root; ///< node
};

FN uint hash_directory(uint patch_number, uint levels) {
    return hash_combine(hash_uint(patch_number), levels);
}

/// Maximum candidates that a ray offers per round, and in one that collects.
const uint kMostSlots = 8u;
const uint kMostCollected = 127u; // with kCellBits, a rank and a cell are never all ones

/// The tree of the first candidate, which is none, of a ray that had more than it may collect.
const uint kOverflown = 0xfffffffeu;

/// Push constants of the kernels of a cast.
struct CastPush {
    uint first, count;   ///< range of the active rays
    uint round;          ///< 0: rays start from the root
    uint slots;          ///< nearest candidates that a ray offers, at most kMostSlots
    uint is_any;         ///< any-hit query
    uint is_collecting;  ///< rays offer all their candidates or, if those are too many, none
    uint is_repeated;    ///< process only rays that wait for tiles
    uint wave;           ///< index of this wave of jobs
    uint pool_start;     ///< pool_head when the wave began
    uint pool_budget;    ///< units available to the wave
    uint pool_capacity;  ///< units
    uint is_cached;      ///< trees of earlier waves may be reused
    uint root;           ///< root of the tree of instances; kNone: empty scene
    uint patch_count;    ///< lower tree indices are patches, others tiles
    uint directory_mask; ///< entries of the hash table - 1
    uint request_limit;
    uint is_ray_lod;      ///< levels from the ray's own distance
    float pixel_angle;    ///< of a cell at distance 1
    uint builds_stride;   ///< capacity of each bin
    uint visibility_mask; ///< only instances that share a bit are visited
};

/// A patch tree: requirements of the rays of this round, and its place in the pool.
struct TreeRecord {
    uint begin, end; ///< its pairs, sorted
    uint need;       ///< make_need of all pairs; zero between rounds
    uint coverage;   ///< needs met by the tree in the pool; 0: no tree
    uint address;    ///< in units of the pool, increasing monotonically
    uint ready_wave; ///< wave of jobs in which its pairs may be traced
    uint build_wave; ///< wave in which it was, or will be, built
};

/// Counters of kernels, cleared by the host.
struct CounterData {
    uint pair_count;        ///< of this round
    uint job_count;         ///< trees of this round
    uint next_active_count; ///< rays of the next round
    uint deferred_count;    ///< jobs without room in the pool, deferred to the next wave
    uint request_count;     ///< patches whose tiles are requested
    uint rays_lost; ///< rays whose traversal the device cut short; for consistency checks, as are those below
    uint pool_head; ///< next free address of the pool, in units, modulo 2^32
    uint next_job;  ///< queue of the persistent kernel
    uint build_count[3];        ///< jobs to be built, by bin
    uint pairs_done, jobs_done; ///< of this wave; checked against the expected counts
    uint pairs_with_hit;
    uint reused;
    uint built[6];   ///< trees built, by level
    uint path_count; ///< paths active at the next depth
    uint shadow_count;
};

/// Push constants of prepare_arguments: invocations per group, and trees per group in each build bin.
struct ArgumentsPush {
    uint group_size;
    uint builds_per_group[3];
};

#include "formulas/end.h"
#endif
