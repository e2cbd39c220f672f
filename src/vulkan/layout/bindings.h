// Constants of kernels and host: bindings, sizes, markers. Shared structs are in device_*.h.
#ifndef RELIEF_BINDINGS_H
#define RELIEF_BINDINGS_H

#include "formulas/begin.h"

// Storage buffers. The smallest supported device allows 31 per stage.
const uint kBindInstances = 0u;     ///< InstanceData
const uint kBindSurfaces = 1u;      ///< SurfaceData
const uint kBindMaps = 2u;          ///< MapData
const uint kBindTextures = 3u;      ///< TextureData
const uint kBindMaterials = 4u;     ///< MaterialData; then MaterialInputData, InputTextureData, uint: tiles
const uint kBindSources = 5u;       ///< LightSourceData; behind all of them LightNodeData, then sets of bits
const uint kBindTileRecords = 6u;   ///< TileRecord: tiles of patches above level 5
const uint kBindRays = 7u;          ///< RayData
const uint kBindHits = 8u;          ///< HitData
const uint kBindActive = 9u;        ///< uint: rays of this round
const uint kBindNextActive = 10u;   ///< uint: rays of the next round
const uint kBindCursors = 11u;      ///< CursorData
const uint kBindCandidates = 12u;   ///< CandidateData
const uint kBindPairs = 13u;        ///< uvec2: (tree, candidate)
const uint kBindSortedPairs = 14u;  ///< uvec2
const uint kBindHistogram = 15u;    ///< uint
const uint kBindTrees = 16u;        ///< TreeRecord
const uint kBindPool = 17u;         ///< uint: the patch trees
const uint kBindNearest = 18u;      ///< uint64: (distance, rank) of each ray in this round
const uint kBindCounters = 19u;     ///< CounterData
const uint kBindJobs = 20u;         ///< uint: trees with pairs in this round
const uint kBindBuilds = 21u;       ///< uint: trees to be built, binned by size
const uint kBindArguments = 22u;    ///< uint: sizes of indirect launches, kArgumentWords each
const uint kBindRequests = 23u;     ///< RequestData: patches whose tiles are requested
const uint kBindPaths = 24u;        ///< PathData
const uint kBindPoints = 25u;       ///< SurfacePointData; then InputNumbers
const uint kBindFilm = 26u;         ///< FilmSumsData; then uint: light_sums.glsl, first hits
const uint kBindPathList = 27u;     ///< uint: active paths
const uint kBindNextPathList = 28u; ///< uint: paths active at the next depth
const uint kBindShadowList = 29u;   ///< uint: rays towards lights
const uint kBindDirectories = 30u;  ///< DirectoryData: hash table of the tiles of patches above level 5
const uint kStorageBindingCount = 31u;

// Rasterised first hits reuse buffers that only shading needs.
const uint kBindRasterVertices = kBindPoints;      ///< float: three per vertex
const uint kBindRasterItems = kBindShadowList;     ///< RasterItem
const uint kBindRasterNearest = kBindNextPathList; ///< uint64: (distance, rank) of each path's ray

// Uniform texel buffers, all immutable during a render.
const uint kFirstTexelBinding = 32u;
const uint kBindNodes = 32u;        ///< rgba32ui: six per node, or two (device_scene.h)
const uint kBindPositions = 33u;    ///< r32f: three per vertex
const uint kBindUvs = 34u;          ///< rg32f
const uint kBindFrames = 35u;       ///< rg32ui: PackedFrame
const uint kBindQuads = 36u;        ///< rgba32ui: one, or two of 16 bits a vertex
const uint kBindDominants = 37u;    ///< r32ui
const uint kBindVertexTiles = 38u;  ///< r32ui: four per word
const uint kBindOverrides = 39u;    ///< rgba32ui: patch edge, first, second, 0
const uint kBindOverrideBits = 40u; ///< r32ui; also mips and tangents of patches, places of uv sets
const uint kBindLevels = 41u;       ///< r32ui: pack_levels, one per patch of an instance
const uint kBindPrimitiveIds = 42u; ///< r32ui: polygons in leaf order
const uint kBindFloatTexels = 43u;  ///< rgba32f: maps and textures
const uint kBindHalfTexels = 44u;   ///< rgba16f: maps and textures
const uint kBindEnvironment = 45u;  ///< r32f: cumulative distributions
const uint kBindEmitters = 46u;     ///< rg32ui: cumulative distribution of emissive patches
const uint kBindAlbedos = 47u;      ///< rg32f: ggx_table.h, bound in every table; then layer_table.h
const uint kTexelBindingCount = 16u;

// Indirect launches, in the order of kBindArguments.
const uint kArgumentsPairs = 0u;
const uint kArgumentsJobs = 1u;
const uint kArgumentsBuilds = 2u; ///< and the following, one per bin
const uint kArgumentCount = 6u;

// Bins of trees to be built, by lanes per tree: up to 2 x 2 cells, up to 8 x 8, more.
const uint kBuildBinCount = 3u;

// Words of one entry of kBindArguments: group counts, padding, then the same work as a full-screen draw.
const uint kArgumentWords = 8u;
const uint kArgumentDrawWord = 4u;

// Fragments in place of work groups: a square of them is a group; all devices have the size.
const uint kFragmentSquare = 8u;  ///< pixels per side
const uint kScreenColumns = 256u; ///< squares
const uint kScreenRows = 512u;    ///< squares

const uint kMaxPushBytes = 128u;

// Specialization constant of kernels that read maps or textures: not 0 where any of the scene is smooth.
// Without one such kernels are compiled without what only those need.
const uint kSmoothConstant = 7u;
// Likewise of kernels that scatter: not 0 where a material of the scene has layers.
const uint kLayersConstant = 8u;
// Likewise of the kernel that finds shading normals: not 0 where a material of the scene has a normal map.
const uint kNormalMapsConstant = 9u;
// Likewise of kernels that draw lights or meet them: not 0 where there is a light tree.
const uint kLightTreeConstant = 10u;
// The same: not 0 where a light lights some objects only.
const uint kLightLinksConstant = 11u;
// The same: not 0 where a light has a texture.
const uint kLightTexturesConstant = 12u;
// Of kernels that add light to paths (light_sums.glsl): kKindCount where the picture has layers of kinds of
// light, else 0; the number of groups of lights that it has layers of.
const uint kLightKindsConstant = 13u;
const uint kLightGroupsConstant = 14u;
// Of the latter, that of lights without one, and that of the environment; kNone: not asked for.
const uint kDefaultGroupConstant = 15u;
const uint kEnvironmentGroupConstant = 16u;
// Of kernels that know of glass: not 0 where a material of the scene lets light through.
const uint kGlassConstant = 17u;
// Of the kernel that draws lights: PreparedScene::terminators.
const uint kTerminatorsConstant = 18u;
// Of kernels that shade: not 0 where the scene has shadow catchers.
const uint kShadowCatchersConstant = 19u;
// Kernels that use materials get a number other than 0 if a texture changes numbers that points do not store
// themselves (InputNumbers).
const uint kVertexNumbersConstant = 20u;
// Of kernels that add light to paths: not 0 where the picture has guides of a denoiser.
const uint kGuidesConstant = 21u;
// Of kernels that scatter or find shading normals: not 0 where the roughness of a material has a direction.
const uint kAnisotropyConstant = 22u;
// Of kernels that evaluate patches: not 0 where the base of a surface is bicubic.
const uint kBicubicConstant = 23u;
// Of kernels that walk the scene trees: not 0 where a surface has no displacement; where a patch is above
// level 5; where each ray has its own levels.
const uint kPolygonsConstant = 24u;
const uint kTilesConstant = 25u;
const uint kRayLodConstant = 26u;
// Of the walk of a round that collects: not 0.
const uint kCollectsConstant = 27u;
// Of kernels that know of materials: not 0 where a texture of one lies on another uv set than its mesh's own.
const uint kUvSetsConstant = 28u;
// Of kernels that walk the scene trees: nodes that the walk through the tiles of a patch has on its stack at
// most.
const uint kTileStackConstant = 29u;
// Kernels that read maps get a number other than 0 if tiles of a map continue each other.
const uint kTileBordersConstant = 30u;
// Kernels that read textures of materials get a number other than 0 if one of them has tiles or does not
// repeat.
const uint kPlacedTexturesConstant = 31u;

#include "formulas/end.h"
#endif
