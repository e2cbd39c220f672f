// Rays, hits and pairs as device kernels pass them on. Scalar block layout, members of 4 bytes.
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
    uint bias; ///< surface M_bias is seen
};

/// Nearest hit so far. Any-hit rays only tell `instance`: kNone while nothing is in the way, else 0.
struct HitData {
    float t;          ///< infinity: nothing
    uint instance;    ///< kNone: nothing
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

/// How far a ray has come in the order of its patches: (entry, instance, tree). The next round offers what
/// follows.
struct CursorData {
    float entry;
    uint instance, tree;
};

/// A patch, or tile of one, that a ray may meet.
struct CandidateData {
    uint instance, tree;
    uint patch_index;
    uint levels; ///< packed, as this ray sees the patch
    float entry; ///< where the ray meets its box
};

/// A patch above level 5 whose tiles a ray asks for.
struct RequestData {
    uint instance, patch_index, levels;
};

/// Bits that tell which patches were asked for.
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

/// Patches that a ray may offer in one round.
const uint kMostSlots = 8u;

/// What the kernels of a cast are told.
struct CastPush {
    uint first, count;   ///< part of the active rays that is worked on
    uint round;          ///< 0: rays start afresh
    uint slots;          ///< nearest patches that a ray offers, at most kMostSlots
    uint is_any;         ///< anything in the way ends the ray
    uint is_repeated;    ///< only rays that wait for tiles
    uint wave;           ///< number of this wave of jobs
    uint pool_start;     ///< pool_head when the wave began
    uint pool_budget;    ///< units that the wave may fill
    uint pool_capacity;  ///< units
    uint is_cached;      ///< trees of earlier waves may serve
    uint root;           ///< node of the tree of instances; kNone: nothing to be seen
    uint patch_count;    ///< trees below are patches, from there on tiles
    uint directory_mask; ///< entries of the hash table - 1
    uint request_limit;
    uint is_ray_lod;      ///< levels by the ray's own distance
    float pixel_angle;    ///< of a cell at distance 1
    uint builds_stride;   ///< places of each bin
    uint visibility_mask; ///< instances are entered that share a bit
};

/// A patch tree: what rays want of it in this round, and where in the pool it is.
struct TreeRecord {
    uint begin, end; ///< its pairs, sorted
    uint need;       ///< make_need of all of them; zero between rounds
    uint coverage;   ///< what the tree in the pool serves; 0: there is none
    uint address;    ///< in units of the pool, counted on for ever
    uint ready_wave; ///< wave of jobs in which its pairs may be traced
    uint build_wave; ///< and in which it was, or is to be, built
};

/// What kernels count; zeroed by the host where it says so.
struct CounterData {
    uint pair_count;            ///< of this round
    uint job_count;             ///< trees of this round
    uint next_active_count;     ///< rays of the next round
    uint deferred_count;        ///< jobs that found no room in the pool and wait for the next wave
    uint request_count;         ///< patches whose tiles are asked for
    uint rays_lost;             ///< whose walk the device ended: a proof, as those below
    uint pool_head;             ///< next free place of the pool, in units; grows for ever, modulo 2^32
    uint next_job;              ///< queue of the persistent kernel
    uint build_count[3];        ///< jobs to be built, by bin
    uint pairs_done, jobs_done; ///< of this wave: proofs that nothing was lost
    uint pairs_with_hit;
    uint reused;
    uint built[6];   ///< trees, by level
    uint path_count; ///< paths that go on
    uint shadow_count;
};

/// Launches to be sized: invocations a group, and trees a group in each bin of builds.
struct ArgumentsPush {
    uint group_size;
    uint builds_per_group[3];
};

#include "formulas/end.h"
#endif
