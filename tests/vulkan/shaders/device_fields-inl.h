// Every field of the structs that cross between host and device, in one list for both languages: FIELD(path).
struct AllStructs {
    InstanceData instance;
    SurfaceData surface;
    MapData map;
    TextureData texture;
    MaterialData material;
    MaterialInputData material_input;
    InputTextureData input_texture;
    TileRecord tile;
    RayData ray;
    HitData hit;
    CursorData cursor;
    CandidateData candidate;
    CounterData counter;
    RequestData request;
    DirectoryData directory;
    TreeRecord tree;
    CastPush cast_push;
    ArgumentsPush arguments_push;
    PathData path;
    SurfacePointData point;
    FilmSumsData film;
    EmitterData emitter;
    LightSourceData light;
    LightNodeData light_node;
    CameraPush camera_push;
    PathPush path_push;
    SortPush sort_push;
    TreeNode tree_node;
    KdNode kd_node;
    KdBox kd_box;
    HeapBlock heap_block;
    HeapBrick heap_brick;
    HeapKey heap_key;
    TreeRay tree_ray;
    TreeHit tree_hit;
    RayCounts ray_counts;
    WalkState walk_state;
    WalkPush walk_push;
    BuildState build_state;
    BuildPush build_push;
    RasterItem raster_item;
    RasterPush raster_push;
};

// clang-format off
#define FIELD2(path) FIELD(path.x) FIELD(path.y)
#define FIELD3(path) FIELD(path.x) FIELD(path.y) FIELD(path.z)
#define FIELDS_INSTANCE(s) \
    FIELD3(s.object_from_origin.x) FIELD3(s.object_from_origin.y) FIELD3(s.object_from_origin.z) \
    FIELD3(s.object_from_origin.t) FIELD3(s.origin) FIELD(s.reach) FIELD3(s.world_from_object.x) FIELD3(s.world_from_object.y) \
    FIELD3(s.world_from_object.z) FIELD3(s.world_from_object.t) FIELD(s.surface) FIELD(s.material) \
    FIELD(s.root) FIELD(s.levels) FIELD(s.visibility_mask)
#define FIELDS_SURFACE(s) \
    FIELD(s.first_vertex) FIELD(s.dominant_count) FIELD(s.first_uv) FIELD(s.first_frame) FIELD(s.first_dominant) \
    FIELD(s.first_vertex_tile) FIELD(s.first_quad) FIELD(s.first_quad_texel) FIELD(s.has_wide_quads) FIELD(s.first_override) FIELD(s.override_count) \
    FIELD(s.first_override_word) FIELD(s.map) FIELD(s.first_control) FIELD(s.first_height) FIELD(s.first_mip) \
    FIELD(s.first_derivative) FIELD(s.has_bilinear_uvs) FIELD(s.first_tangent) FIELD(s.first_uv_set)
#define FIELDS_MAP(s) \
    FIELD3(s.row0) FIELD3(s.row1) FIELD3(s.row2) FIELD3(s.midlevel) FIELD(s.wrap) FIELD(s.flip_v) \
    FIELD(s.is_tangent) FIELD(s.first_tile) FIELD(s.tile_count) FIELD(s.is_smooth) FIELD(s.first_neighbour)
#define FIELDS_TEXTURE(s) \
    FIELD(s.first_texel) FIELD(s.width) FIELD(s.height) FIELD(s.channel_count) FIELD(s.is_half)
#define FIELDS_LAYERS(s) \
    FIELD3(s.specular_color) FIELD(s.specular_weight) FIELD(s.metallic) FIELD(s.dielectric_f0) \
    FIELD(s.dielectric_f90) FIELD(s.diffuse_roughness) FIELD(s.coat_weight) FIELD(s.coat_roughness) \
    FIELD(s.coat_f0) FIELD(s.coat_f90) FIELD(s.coat_inverse_ior2) FIELD3(s.coat_depth) FIELD(s.coat_darkening) \
    FIELD(s.coat_inside) FIELD3(s.fuzz_color) FIELD(s.fuzz_weight) FIELD(s.fuzz_exponent) FIELD(s.fuzz_scale) \
    FIELD(s.specular_anisotropy) FIELD(s.coat_anisotropy) FIELD(s.azimuth_scale) FIELD(s.row_scale) FIELD(s.first_entry)
#define FIELDS_GLASS(s) \
    FIELD(s.weight) FIELD(s.ior) FIELD3(s.specular_color) FIELD3(s.tint) FIELD3(s.depth) FIELD(s.anisotropy) FIELD(s.kind)
#define FIELDS_MATERIAL(s) \
    FIELD3(s.base_color) FIELD(s.roughness) FIELD3(s.emission) FIELD(s.metallic) FIELD(s.ior) \
    FIELD(s.opacity) FIELD2(s.normal_scale) FIELD(s.light_group) FIELD(s.has_layers) FIELDS_LAYERS(s.layers) \
    FIELD(s.has_glass) FIELDS_GLASS(s.glass) FIELD(s.inputs) FIELD(s.has_vertex_numbers)
#define FIELD4(s) FIELD(s[0]) FIELD(s[1]) FIELD(s[2]) FIELD(s[3])
#define FIELDS_WORDS(s, k) FIELD(s.word[k]) FIELD(s.word[k + 1]) FIELD(s.word[k + 2]) FIELD(s.word[k + 3])
#define FIELDS_NUMBERS(s) \
    FIELDS_WORDS(s, 0) FIELDS_WORDS(s, 4) FIELDS_WORDS(s, 8) FIELDS_WORDS(s, 12) FIELDS_WORDS(s, 16) FIELDS_WORDS(s, 20) \
    FIELDS_WORDS(s, 24) FIELDS_WORDS(s, 28)
#define FIELDS_GRID(s) \
    FIELD(s.axis_count) FIELD4(s.place) FIELD4(s.stride) FIELD4(s.lower) FIELD4(s.scale) FIELD4(s.last) \
    FIELD(s.row_count) FIELD(s.azimuth_count) FIELD(s.fuzz_lower) FIELD(s.fuzz_scale) FIELD(s.fuzz_last)
#define FIELDS_MATERIAL_INPUT(s) \
    FIELDS_NUMBERS(s.numbers) FIELD(s.constants.ior) FIELD(s.constants.coat_ior) FIELD(s.constants.is_absorbing) \
    FIELDS_GRID(s.grid) FIELD(s.places) FIELD(s.first_texture) FIELD(s.texture_count)
#define FIELDS_INPUT_TEXTURE(s) \
    FIELD(s.place) FIELD(s.count) FIELD(s.is_number) FIELD(s.is_udim) FIELD(s.wrap) FIELD2(s.uv_scale) \
    FIELD2(s.uv_offset) FIELD(s.first_tile) FIELD(s.tile_count) FIELD(s.uv_set)
#define FIELDS_TILE(s) \
    FIELD(s.instance) FIELD(s.patch_index) FIELD(s.levels) FIELD(s.cell_x) FIELD(s.cell_y)
#define FIELDS_RAY(s) \
    FIELD3(s.origin) FIELD(s.t_min) FIELD3(s.direction) FIELD(s.t_max) FIELD(s.lod_bias)
#define FIELDS_HIT(s) \
    FIELD(s.t) FIELD(s.instance) FIELD(s.patch_index) FIELD(s.u) FIELD(s.v) FIELD(s.cell) FIELD(s.levels)
#define FIELDS_CURSOR(s) \
    FIELD(s.entry) FIELD(s.instance) FIELD(s.tree)
#define FIELDS_CANDIDATE(s) \
    FIELD(s.instance) FIELD(s.tree) FIELD(s.patch_index) FIELD(s.levels) FIELD(s.entry)
#define FIELDS_COUNTER(s) \
    FIELD(s.pair_count) FIELD(s.job_count) FIELD(s.next_active_count) FIELD(s.deferred_count) \
    FIELD(s.request_count) FIELD(s.rays_lost) FIELD(s.pool_head) FIELD(s.next_job) FIELD(s.build_count[0]) \
    FIELD(s.build_count[1]) FIELD(s.build_count[2]) FIELD(s.pairs_done) FIELD(s.jobs_done) \
    FIELD(s.pairs_with_hit) FIELD(s.reused) FIELD(s.built[0]) FIELD(s.built[1]) FIELD(s.built[2]) \
    FIELD(s.built[3]) FIELD(s.built[4]) FIELD(s.built[5]) FIELD(s.path_count) FIELD(s.shadow_count)
#define FIELDS_REQUEST(s) \
    FIELD(s.instance) FIELD(s.patch_index) FIELD(s.levels)
#define FIELDS_DIRECTORY(s) \
    FIELD(s.patch_number) FIELD(s.levels) FIELD(s.root)
#define FIELDS_TREE(s) \
    FIELD(s.begin) FIELD(s.end) FIELD(s.need) FIELD(s.coverage) FIELD(s.address) FIELD(s.ready_wave) \
    FIELD(s.build_wave)
#define FIELDS_CAST_PUSH(s) \
    FIELD(s.first) FIELD(s.count) FIELD(s.round) FIELD(s.slots) FIELD(s.is_any) FIELD(s.is_collecting) \
    FIELD(s.is_repeated) FIELD(s.wave) FIELD(s.pool_start) \
    FIELD(s.pool_budget) FIELD(s.pool_capacity) FIELD(s.is_cached) FIELD(s.root) FIELD(s.patch_count) \
    FIELD(s.directory_mask) FIELD(s.request_limit) FIELD(s.is_ray_lod) FIELD(s.pixel_angle) \
    FIELD(s.builds_stride) FIELD(s.visibility_mask)
#define FIELDS_ARGUMENTS_PUSH(s) \
    FIELD(s.group_size) FIELD(s.builds_per_group[0]) FIELD(s.builds_per_group[1]) \
    FIELD(s.builds_per_group[2])
#define FIELDS_PATH(s) \
    FIELD3(s.throughput) FIELD(s.bsdf_pdf) FIELD3(s.previous) FIELD(s.pixel_seed) FIELD3(s.radiance) \
    FIELD(s.cost) FIELD3(s.contribution) FIELD3(s.normal) FIELD(s.instance) FIELD(s.body) \
    FIELD3(s.lifted_direction) FIELD(s.lifted_distance)
#define FIELDS_POINT(s) \
    FIELD3(s.position) FIELD(s.position_error) FIELD3(s.geometric_normal) FIELD(s.area_per_uv) \
    FIELD3(s.bent_normal) FIELD(s.roughness) FIELD3(s.base_color) FIELD(s.metallic) FIELD(s.is_flipped)
#define FIELDS_FILM(s) \
    FIELD3(s.radiance) FIELD3(s.squares) FIELD(s.cost) FIELD(s.hit_count) FIELD(s.light_count) FIELD3(s.shading_normal) \
    FIELD3(s.geometric_normal) FIELD3(s.position) FIELD3(s.albedo) FIELD3(s.shadow) FIELD2(s.uv) FIELD(s.depth) \
    FIELD(s.id)
#define FIELDS_EMITTER(s) \
    FIELD(s.end) FIELD(s.probability)
#define FIELDS_LIGHT(s) \
    FIELD(s.kind) FIELD(s.power) FIELD3(s.color) FIELD(s.strength) FIELD3(s.center) FIELD(s.radius) \
    FIELD(s.radius2) FIELD3(s.basis.t) FIELD3(s.basis.b) FIELD3(s.basis.n) FIELD(s.cone) \
    FIELD(s.edge) FIELD(s.half_width) FIELD(s.half_height) FIELD(s.is_visible) FIELD(s.texture) FIELD(s.link) FIELD(s.group)
#define FIELDS_LIGHT_NODE(s) \
    FIELD3(s.center) FIELD(s.radius) FIELD3(s.axis) FIELD(s.spread_cosine) FIELD(s.spread_sine) \
    FIELD(s.reach_cosine) FIELD(s.power) FIELD(s.source) FIELD(s.end) FIELD(s.flags)
#define FIELDS_CAMERA_PUSH(s) \
    FIELD3(s.camera.origin) FIELD3(s.camera.right) FIELD3(s.camera.up) FIELD3(s.camera.forward) \
    FIELD3(s.camera.corner) FIELD3(s.camera.step_x) FIELD3(s.camera.step_y) \
    FIELD(s.camera.aperture_radius) FIELD(s.camera.focus_distance) FIELD(s.x0) FIELD(s.y0) FIELD(s.width) FIELD(s.height) \
    FIELD(s.first_pixel) FIELD(s.count) FIELD(s.sample_index) FIELD(s.seed)
#define FIELDS_PATH_PUSH(s) \
    FIELD(s.count) FIELD(s.capacity) FIELD(s.depth) FIELD(s.last_depth) FIELD(s.clamp_indirect) FIELD(s.sample_index) \
    FIELD(s.source_count) FIELD(s.first_light_node) FIELD(s.emitter_count) FIELD(s.emitter_range_count) \
    FIELD(s.has_environment) FIELD(s.has_background) FIELD3(s.background) FIELD3(s.environment.scale) FIELD(s.environment.sin_turn) \
    FIELD(s.environment.cos_turn) FIELD(s.environment.cells_x) FIELD(s.environment.cells_y) \
    FIELD(s.environment.texture_index) FIELD3(s.bounce_lod.camera) FIELD(s.bounce_lod.cell_angle) \
    FIELD(s.first_hit_offset)
#define FIELDS_SORT_PUSH(s) \
    FIELD(s.counter_word) FIELD(s.capacity) FIELD(s.shift) FIELD(s.mask) FIELD(s.is_back)
#define FIELDS_TREE_NODE(s) \
    FIELD3(s.lower) FIELD(s.first) FIELD3(s.upper) FIELD(s.word)
#define FIELDS_KD_NODE(s) \
    FIELD(s.bits) FIELD(s.word)
#define FIELDS_KD_BOX(s) \
    FIELD3(s.lower) FIELD(s.parent) FIELD3(s.upper) FIELD(s.unused)
#define FIELDS_HEAP_BLOCK(s) \
    FIELD(s.inner_low) FIELD(s.inner_high) FIELD(s.rank)
#define FIELDS_HEAP_BRICK(s) \
    FIELD(s.inner_low) FIELD(s.inner_high) FIELD(s.first_pair) FIELD(s.deeper_low) FIELD(s.deeper_high) \
    FIELD(s.first_brick)
#define FIELDS_HEAP_KEY(s) \
    FIELD(s.low) FIELD(s.high)
#define FIELDS_TREE_RAY(s) \
    FIELD3(s.origin) FIELD(s.t_min) FIELD3(s.direction) FIELD(s.t_max)
#define FIELDS_TREE_HIT(s) \
    FIELD(s.t) FIELD(s.primitive) FIELD(s.weight_b) FIELD(s.weight_c)
#define FIELDS_RAY_COUNTS(s) \
    FIELD(s.box_tests) FIELD(s.primitive_tests) FIELD(s.restarts) FIELD(s.bytes)
#define FIELDS_WALK_STATE(s) \
    FIELD(s.rays_lost)
#define FIELDS_WALK_PUSH(s) \
    FIELD(s.ray_count) FIELD(s.root) FIELD(s.is_any) FIELD(s.has_start_keys) FIELD(s.has_leaf_keys) \
    FIELD(s.flat_levels) FIELD(s.flat_pairs) FIELD3(s.cell_lower) FIELD3(s.cell_upper)
#define FIELDS_BUILD_STATE(s) \
    FIELD(s.primitive_count) FIELD(s.cut_count) FIELD(s.depth) FIELD(s.loops_ended) \
    FIELD(s.lower[0]) FIELD(s.lower[1]) FIELD(s.lower[2]) \
    FIELD(s.upper[0]) FIELD(s.upper[1]) FIELD(s.upper[2])
#define FIELDS_BUILD_PUSH(s) \
    FIELD(s.primitive_count) FIELD(s.max_leaf_size) FIELD(s.level) FIELD(s.step)
#define FIELDS_RASTER_ITEM(s) \
    FIELD(s.instance) FIELD(s.patch_index) FIELD(s.levels) FIELD(s.first_row) FIELD(s.first_vertex) FIELD(s.first_cell)
#define FIELDS_RASTER_PUSH(s) \
    FIELD3(s.origin) FIELD3(s.corner) FIELD3(s.step_x) FIELD3(s.step_y) FIELD(s.x0) FIELD(s.y0) FIELD(s.width) \
    FIELD(s.height) FIELD(s.first_pixel) FIELD(s.count) FIELD(s.first_row) FIELD(s.row_count) FIELD(s.item_count) \
    FIELD(s.vertex_count)
#define ALL_FIELDS(s) \
    FIELDS_INSTANCE(s.instance) \
    FIELDS_SURFACE(s.surface) \
    FIELDS_MAP(s.map) \
    FIELDS_TEXTURE(s.texture) \
    FIELDS_MATERIAL(s.material) \
    FIELDS_MATERIAL_INPUT(s.material_input) \
    FIELDS_INPUT_TEXTURE(s.input_texture) \
    FIELDS_TILE(s.tile) \
    FIELDS_RAY(s.ray) \
    FIELDS_HIT(s.hit) \
    FIELDS_CURSOR(s.cursor) \
    FIELDS_CANDIDATE(s.candidate) \
    FIELDS_COUNTER(s.counter) \
    FIELDS_REQUEST(s.request) \
    FIELDS_DIRECTORY(s.directory) \
    FIELDS_TREE(s.tree) \
    FIELDS_CAST_PUSH(s.cast_push) \
    FIELDS_ARGUMENTS_PUSH(s.arguments_push) \
    FIELDS_PATH(s.path) \
    FIELDS_POINT(s.point) \
    FIELDS_FILM(s.film) \
    FIELDS_EMITTER(s.emitter) \
    FIELDS_LIGHT(s.light) \
    FIELDS_LIGHT_NODE(s.light_node) \
    FIELDS_CAMERA_PUSH(s.camera_push) \
    FIELDS_PATH_PUSH(s.path_push) \
    FIELDS_SORT_PUSH(s.sort_push) \
    FIELDS_TREE_NODE(s.tree_node) \
    FIELDS_KD_NODE(s.kd_node) \
    FIELDS_KD_BOX(s.kd_box) \
    FIELDS_HEAP_BLOCK(s.heap_block) \
    FIELDS_HEAP_BRICK(s.heap_brick) \
    FIELDS_HEAP_KEY(s.heap_key) \
    FIELDS_TREE_RAY(s.tree_ray) \
    FIELDS_TREE_HIT(s.tree_hit) \
    FIELDS_RAY_COUNTS(s.ray_counts) \
    FIELDS_WALK_STATE(s.walk_state) \
    FIELDS_WALK_PUSH(s.walk_push) \
    FIELDS_BUILD_STATE(s.build_state) \
    FIELDS_BUILD_PUSH(s.build_push) \
    FIELDS_RASTER_ITEM(s.raster_item) \
    FIELDS_RASTER_PUSH(s.raster_push)
// clang-format on
