// Device representation of the scene: tables whose entries point into the texel buffers of bindings.h. Scalar
// block layout, members of 4 bytes, identical in C++ and GLSL.
#ifndef RELIEF_DEVICE_SCENE_H
#define RELIEF_DEVICE_SCENE_H
#include "formulas/glass_parameters.h"
#include "formulas/input_numbers.h"
#include "formulas/layer_grid.h"
#include "formulas/layer_parameters.h"

#include "formulas/begin.h"

/// Affine map p -> (dot(x, p), dot(y, p), dot(z, p)) + t.
struct AffineData {
    Vec3 x, y, z, t;
};

/// Of InstanceData::levels. A million instances have to fit into a buffer of 128 MiB.
const uint kManyLevels = 0x80000000u;
const uint kMirrored = 0x40000000u;      ///< winding reversed
const uint kShadowCatcher = 0x20000000u; ///< see Object::is_shadow_catcher
const uint kNarrowLevels = 0x10000000u;  ///< of many: two patches a word (narrow_levels)

struct InstanceData {
    AffineData object_from_origin, world_from_object;
    Vec3 origin;   ///< what places are measured from first, world space: 0 but for objects that lie far away
    float reach;   ///< of the displaced surface from the object's origin, world space
    uint surface;  ///< index into surfaces
    uint material; ///< index into materials
    uint root;     ///< node of the surface's tree; kNone: the surface is empty
    uint levels;   ///< packed ones of all patches, or kManyLevels and an index into levels; and the others
    uint visibility_mask;
};

/// First entries in the texel buffers; kNone where the surface has no such data.
struct SurfaceData {
    uint first_vertex;   ///< of positions, one a dominant vertex
    uint dominant_count; ///< vertices from here on have their position at a dominant one
    uint first_uv, first_frame, first_dominant;
    uint first_vertex_tile; ///< in vertices: two per word
    uint first_quad;        ///< the tree index of the surface's first patch
    uint first_quad_texel;  ///< of quads
    uint has_wide_quads;    ///< one a texel, not two: there are more vertices than 16 bits count
    uint first_override, override_count;
    uint first_override_word; ///< of override_bits
    uint map;                 ///< index into maps; kNone: not displaced
    uint first_control;       ///< of positions, in vertices: twelve per patch; kNone: bilinear patches
    uint first_height; ///< in numbers of positions, three per vertex: Surface::base_heights; kNone: all are 0
    uint first_mip;    ///< of override_bits: one word per patch (mips.h); kNone: mip level 0 everywhere
    uint first_derivative; ///< of positions, in vertices: dP/du and dP/dv of each vertex; kNone: unit frames
    uint has_bilinear_uvs; ///< of polygons; else linear on each triangle
    uint first_tangent;    ///< of override_bits: one word per corner of each patch (frame.h); kNone: none
    /// Of override_bits: a word for each further uv set of the scene, which is the first of four uvs per
    /// patch, or kNone. kNone: the surface has only its own.
    uint first_uv_set;
};

/// d = matrix (texel - midlevel).
struct MapData {
    Vec3 row0, row1, row2;
    Vec3 midlevel;
    uint wrap;
    uint flip_v;
    uint is_tangent;
    uint first_tile; ///< index into textures; mip levels of the tiles follow consecutively
    uint tile_count;
    uint is_smooth; ///< texels are coefficients of a uniform bicubic B-spline
    /// Index into override_bits, which has two words per tile: the tiles to its left and right, and those
    /// above and below (TileNeighbours), 16 bits each, 0xffff for none. The index is kNone if no tile
    /// continues another one.
    uint first_neighbour;
};

/// Four channels per texel, row 0 at the top.
struct TextureData {
    uint first_texel;
    uint width, height;
    uint channel_count; ///< of the file
    uint is_half;       ///< stored in half_texels, else in float_texels
};

/// Set in an index into textures where the texels are coefficients of a uniform bicubic B-spline.
const uint kSplineTexture = 0x80000000u;
struct MaterialData {
    Vec3 base_color;
    float roughness;
    Vec3 emission;
    float metallic;
    float ior;
    float opacity;
    Vec2 normal_scale; ///< of x and y; negative y: flipped
    uint light_group;  ///< of what it emits, as LightSourceData::group
    uint has_layers;
    LayerParameters layers;
    uint has_glass;
    GlassParameters glass;
    uint inputs;             ///< entry of MaterialInputData; kNone: no textures
    uint has_vertex_numbers; ///< these change numbers that points do not have of themselves
};

/// The inputs of a material with textures. The buffer of materials holds these entries behind all materials,
/// and the textures behind them. Each array begins at the next multiple of its entry size.
struct MaterialInputData {
    InputNumbers numbers;
    InputConstants constants;
    LayerGrid grid;
    uint places; ///< of the numbers that the textures change, as kPointPlaces
    uint first_texture, texture_count;
};

struct InputTextureData {
    uint place, count; ///< words of the numbers
    uint is_number;    ///< the first channel counts alone
    uint is_udim;
    uint wrap;
    Vec2 uv_scale, uv_offset;
    uint
        first_tile; ///< word of the buffer; tiles are indices into textures, with kSplineTexture; kNone: none
    uint tile_count;
    uint uv_set; ///< one of the further sets of the scene (SurfaceData::first_uv_set); kNone: the mesh's own
};

/// A tile of a patch above level 5: its tree index = number of all patches + its index among tile records.
struct TileRecord {
    uint instance; ///< an instance whose patch has `levels`; shared by instances with equal levels
    uint patch_index;
    uint levels;         ///< packed, after the LOD bias
    uint cell_x, cell_y; ///< first cell on the patch
};

/// A scene tree of a traversal selected by name: nodes among the nodes, all else as words among the primitive
/// ids, which begin with these records: of the instances, then one a surface.
struct WalkTreeData {
    Vec3 lower, upper; ///< kd: cell of the root
    uint is_empty;
    uint nodes;                   ///< its first node; kd: its first cell
    uint ids;                     ///< first word of the ids that leaves refer to: instances or patches
    uint links;                   ///< first word: parents, skip links, blocks of a heap, or kd nodes
    uint bricks;                  ///< first word: bricks of a heap
    uint boxes;                   ///< kd: first primitive box, stored as nodes
    uint flat_levels, flat_pairs; ///< HeapForm of a heap
};
const uint kWalkTreeWords = 14u;

// Nodes of the scene trees are those of bvh/wide_bvh.h, of six texels: (origin, exponents and child count),
// three of codes, two of child words. Nodes are numbered in units of two texels, which is what others take.
const uint kWideNodeUnits = 3u;
// Words of children: a node, or a leaf of the tree of instances (an instance), of a displaced surface (a
// patch), or of polygons (entries of primitive_ids).
const uint kLeafFlag = 0x80000000u;
const uint kLeafCountShift = 28u; ///< three bits: entries - 1
const uint kLeafFirstMask = 0x0fffffffu;

// Nodes of the trees over the tiles of a patch, and those of other traversals: (lower x y z, first), (upper x
// y z, kind_and_count), as bits.
const uint kNodeInner = 0u; ///< first: node of the left child, the right one follows
const uint kNodeTile = 4u;  ///< first: tree index
const uint kNodeKindShift = 28u;

#include "formulas/end.h"
#endif
