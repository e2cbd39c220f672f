// Rays, hits and pairs as device kernels pass them on. Scalar block layout, members of 4 bytes.
#ifndef RELIEF_DEVICE_RAYS_H
#ifndef __cplusplus
#define RELIEF_DEVICE_RAYS_H
#endif

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

#endif
