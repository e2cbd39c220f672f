// Every field of the structs that cross between host and device, in one list for both languages: FIELD(path).
struct AllStructs {
    InstanceData instance;
    SurfaceData surface;
    MapData map;
    TextureData texture;
    MaterialData material;
    TileRecord tile;
    RayData ray;
    HitData hit;
    CursorData cursor;
    CandidateData candidate;
    CounterData counter;
};

// clang-format off
#define FIELD3(path) FIELD(path.x) FIELD(path.y) FIELD(path.z)
#define FIELDS_AFFINE(path) FIELD3(path.x) FIELD3(path.y) FIELD3(path.z) FIELD3(path.t)
#define FIELDS_INSTANCE(s) \
    FIELDS_AFFINE(s.object_from_world) FIELDS_AFFINE(s.world_from_object) FIELD(s.surface) \
    FIELD(s.material) FIELD(s.root) FIELD(s.first_level) FIELD(s.levels) FIELD(s.is_mirrored) \
    FIELD(s.first_emitter)
#define FIELDS_SURFACE(s) \
    FIELD(s.first_vertex) FIELD(s.first_uv) FIELD(s.first_frame) FIELD(s.first_dominant) \
    FIELD(s.first_vertex_tile) FIELD(s.first_quad) FIELD(s.first_override) FIELD(s.override_count) \
    FIELD(s.first_override_word) FIELD(s.map)
#define FIELDS_MAP(s) \
    FIELD3(s.row0) FIELD3(s.row1) FIELD3(s.row2) FIELD3(s.midlevel) FIELD(s.wrap) FIELD(s.flip_v) \
    FIELD(s.is_tangent) FIELD(s.first_tile) FIELD(s.tile_count)
#define FIELDS_TEXTURE(s) \
    FIELD(s.first_texel) FIELD(s.width) FIELD(s.height) FIELD(s.channel_count) FIELD(s.is_half)
#define FIELDS_MATERIAL(s) \
    FIELD3(s.base_color) FIELD(s.roughness) FIELD3(s.emission) FIELD(s.metallic) FIELD(s.ior) \
    FIELD(s.color_texture) FIELD(s.roughness_texture)
#define FIELDS_TILE(s) \
    FIELD(s.instance) FIELD(s.patch_index) FIELD(s.levels) FIELD(s.cell_x) FIELD(s.cell_y)
#define FIELDS_RAY(s) FIELD3(s.origin) FIELD(s.t_min) FIELD3(s.direction) FIELD(s.t_max) FIELD(s.bias)
#define FIELDS_HIT(s) \
    FIELD(s.t) FIELD(s.instance) FIELD(s.patch_index) FIELD(s.u) FIELD(s.v) FIELD(s.cell) FIELD(s.levels)
#define FIELDS_CURSOR(s) FIELD(s.entry) FIELD(s.instance) FIELD(s.tree)
#define FIELDS_CANDIDATE(s) FIELD(s.instance) FIELD(s.tree) FIELD(s.patch_index) FIELD(s.levels)
#define FIELDS_COUNTER(s) \
    FIELD(s.pair_count) FIELD(s.job_count) FIELD(s.next_active_count) FIELD(s.deferred_count) \
    FIELD(s.request_count) FIELD(s.pool_head) FIELD(s.next_job) FIELD(s.build_count[0]) \
    FIELD(s.build_count[1]) FIELD(s.build_count[2]) FIELD(s.build_count[3]) FIELD(s.pairs_done) \
    FIELD(s.jobs_done) FIELD(s.pairs_emitted) FIELD(s.jobs_made) FIELD(s.pairs_with_hit) FIELD(s.reused) \
    FIELD(s.built[0]) FIELD(s.built[1]) FIELD(s.built[2]) FIELD(s.built[3]) FIELD(s.built[4]) \
    FIELD(s.built[5]) FIELD(s.path_count) FIELD(s.shadow_count)
#define ALL_FIELDS(s) \
    FIELDS_INSTANCE(s.instance) FIELDS_SURFACE(s.surface) FIELDS_MAP(s.map) FIELDS_TEXTURE(s.texture) \
    FIELDS_MATERIAL(s.material) FIELDS_TILE(s.tile) FIELDS_RAY(s.ray) FIELDS_HIT(s.hit) \
    FIELDS_CURSOR(s.cursor) FIELDS_CANDIDATE(s.candidate) FIELDS_COUNTER(s.counter)
// clang-format on
