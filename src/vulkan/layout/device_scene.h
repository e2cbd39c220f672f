// The scene as device kernels read it: tables whose entries point into the texel buffers of bindings.h.
// Scalar block layout, members of 4 bytes, the same bytes in C++ and GLSL.
#ifndef RELIEF_DEVICE_SCENE_H
#define RELIEF_DEVICE_SCENE_H
#include "formulas/begin.h"

/// Affine map p -> (dot(x, p), dot(y, p), dot(z, p)) + t.
struct AffineData {
    Vec3 x, y, z, t;
};

struct InstanceData {
    AffineData object_from_world, world_from_object;
    uint surface;     ///< index into surfaces
    uint material;    ///< index into materials
    uint root;        ///< node of the surface's tree; kNone: the surface is empty
    uint first_level; ///< index into levels; kNone: all patches have `levels`
    uint levels;      ///< packed
    uint is_mirrored; ///< winding turned
    uint visibility_mask;
};

/// First entries in the texel buffers; kNone where the surface has no such data.
struct SurfaceData {
    uint first_vertex; ///< of positions, in vertices
    uint first_uv, first_frame, first_dominant;
    uint first_vertex_tile; ///< in bytes: four a word
    uint first_quad;        ///< also the number of the surface's first patch among all trees
    uint first_override, override_count;
    uint first_override_word; ///< of override_bits
    uint map;                 ///< index into maps; kNone: not displaced
    uint first_control;       ///< of positions, in vertices: twelve a patch; kNone: bilinear patches
    uint first_mip;           ///< of override_bits: a word a patch (mips.h); kNone: the map itself everywhere
    uint first_derivative; ///< of positions, in vertices: dP/du and dP/dv of each vertex; kNone: unit frames
};

/// d = matrix (texel - midlevel).
struct MapData {
    Vec3 row0, row1, row2;
    Vec3 midlevel;
    uint wrap;
    uint flip_v;
    uint is_tangent;
    uint first_tile; ///< index into textures; copies of the tiles follow, one after another
    uint tile_count;
};

/// Four channels a texel, row 0 at the top.
struct TextureData {
    uint first_texel;
    uint width, height;
    uint channel_count; ///< of the file
    uint is_half;       ///< in half_texels, not in float_texels
};

/// Indices into textures are kNone without one.
struct MaterialData {
    Vec3 base_color;
    float roughness;
    Vec3 emission;
    float metallic;
    float ior;
    uint color_texture, roughness_texture;
};

/// A tile of a patch above level 5: tree number = count of all patches + its index among tile records.
struct TileRecord {
    uint instance; ///< of which `patch_index` has `levels`; others with equal levels share it
    uint patch_index;
    uint levels;         ///< packed, as rays of one bias see them
    uint cell_x, cell_y; ///< first cell on the patch
};

/// An scene tree of a traversal chosen by name. Its nodes lie among the nodes, all else as words among the
/// ids of primitives, at the beginning of which are these records: first that of the tree of instances, then
/// one a surface.
struct WalkTreeData {
    Vec3 lower, upper; ///< kd: cell of the root
    uint is_empty;
    uint nodes;                   ///< its first node; kd: its first cell
    uint ids;                     ///< first word of what leaves count into: instances, or patches
    uint links;                   ///< first word: parents, skip links, blocks of a heap, or kd nodes
    uint bricks;                  ///< first word: bricks of a heap
    uint boxes;                   ///< kd: first of the boxes of primitives, kept as nodes
    uint flat_levels, flat_pairs; ///< HeapForm of a heap
};
const uint kWalkTreeWords = 14u;

// Nodes of every scene tree take two texels: (lower x y z, first), (upper x y z, kind_and_count), floats as
// their bits.
const uint kNodeInner = 0u;    ///< first: node of the left child, the right one follows
const uint kNodeInstance = 1u; ///< first: instance
const uint kNodePolygons = 2u; ///< first: entry of primitive_ids; count of them
const uint kNodePatch = 3u;    ///< first: patch of the surface
const uint kNodeTile = 4u;     ///< first: tree number
const uint kNodeKindShift = 28u;

#include "formulas/end.h"
#endif
