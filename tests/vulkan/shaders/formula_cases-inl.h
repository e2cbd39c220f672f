// Every formula of src/formulas with a value that a device can get wrong, run on one set of numbers. For GLSL
// and for C++ inside relief::scalar, like the formulas.

struct FormulaInput {
    uint a, b, c, d;
    float u[12]; ///< in [0, 1)
};

/// Equal on every device.
struct ExactResults {
    uint hash, pixel_seed;
    UintPair sobol;
    uint unit, cell, cell_column, cell_row, cell_is_upper;
    uint blend_quad, blend_cubic, filter_texels, decode_row, carried, moved,
        lost;      ///< bits of floats that decide topology
    uint vanished; ///< of the area of a triangle of which two corners are one: 0
};

struct WarpResults {
    Vec2 disk, triangle;
    Vec3 hemisphere, cone, sphere;
    Basis basis;
    Vec3 there_and_back;
    float pdf;
};

struct CameraResults {
    CameraFrame frame;
    CameraRay pinhole, lens;
    CameraProjection projection;
};

struct ShadingResults {
    Vec3 f0;
    float specular_probability;
    Vec3 value;
    float pdf;
    Vec3 direction, weight;
    GgxAlbedo albedo;
    Vec3 diffuse_shares;
};

struct LayerResults {
    Vec3 value;
    float pdf;
    Vec3 direction, weight;
    Vec3 diffuse, diffuse_shares;
    float power, logarithm;
};

struct GlassResults {
    Vec3 value;
    float pdf;
    Vec3 direction, weight;
    Vec3 left, passed;
    Vec3 drawn_weight;
    float drawn_u, drawn_metallic;
};

struct FacetResults {
    Vec2 value, seen;
    Vec3 direction;
    Basis basis;
    Vec2 rest;
};

struct LightResults {
    float weight;
    Vec2 place;
    Vec3 direction;
    float cone_height, distance;
    Vec3 normal;
};

struct ToneResults {
    Vec3 shown;
    float encoded, decoded;
};

struct SourceResults {
    LightDraw sun, point_light, emitter, rectangle, disk, spot;
    float irradiance, flat_irradiance, spot_irradiance;
    LightSeen seen, rectangle_seen, disk_seen, spot_seen;
    Vec3 visible;
    Vec3 into, out_of;
    float density, position;
    float node, leaf, tree_share, left; ///< of a light tree
    Vec2 face_uv;
};

struct SurfaceResults {
    Vec3 position, normal;
    float area_per_uv, error;
    Vec2 patch_uv, polygon_uv;
    Vec3 origin, oriented, plain, displaced;
    float lift;
};

struct FormulaOutput {
    ExactResults exact;
    WarpResults warp;
    CameraResults camera;
    ShadingResults shading;
    LightResults light;
    ToneResults tone;
    SourceResults source;
    SurfaceResults surface;
    LayerResults layers;
    GlassResults glass;
    FacetResults facets;
};

FN ExactResults run_exact(FormulaInput from) {
    ExactResults r;
    r.hash = hash_combine(from.a, from.b);
    r.pixel_seed = make_pixel_seed(from.a, from.b, from.c);
    r.sobol = sobol_bits(from.a, from.b, from.c & 31u);
    r.unit = floatBitsToUint(uint_to_unit(from.d));
    r.cell = make_cell_rank(from.a & 0xfffu, from.b & 0xfffu, from.c & 1u);
    r.cell_column = cell_column(r.cell);
    r.cell_row = cell_row(r.cell);
    r.cell_is_upper = cell_is_upper(r.cell);
    r.blend_quad =
        floatBitsToUint(blend_quad(from.u[0], from.u[1], from.u[2], from.u[3], from.u[4], from.u[5]));
    r.blend_cubic =
        floatBitsToUint(blend_cubic(from.u[0], from.u[1], from.u[2], from.u[3], weigh_cubic(from.u[4])));
    r.filter_texels =
        floatBitsToUint(filter_texels(from.u[6], from.u[7], from.u[8], from.u[9], from.u[10], from.u[11]));
    r.decode_row =
        floatBitsToUint(decode_row(from.u[0], from.u[2], from.u[4], from.u[6], from.u[8], from.u[10]));
    r.carried = floatBitsToUint(
        carry_through_frame(from.u[1], from.u[3], from.u[5], from.u[7], from.u[9], from.u[11]));
    // Nearly all of a sum or a difference cancels.
    r.moved = floatBitsToUint(move_origin(-3e5f * from.u[0], 3e5f, from.u[0]));
    Vec3 a = {from.u[1], from.u[2], from.u[3]};
    Vec3 b = {1e3f * from.u[4], from.u[5], 1e-3f * from.u[6]};
    r.lost = floatBitsToUint(dot_exact(find_lost_by_subtraction(a, b, subtract_exact(a, b)), b));
    Vec3 edge = subtract_exact(b, a);
    r.vanished = floatBitsToUint(make_triangle_point(a, edge, edge, 1.0f, 0.5f).area_per_uv);
    return r;
}

FN Vec2 make_pair(float x, float y) {
    Vec2 r = {x, y};
    return r;
}

FN Vec3 make_triple(float x, float y, float z) {
    Vec3 r = {x, y, z};
    return r;
}

FN WarpResults run_warp(FormulaInput from) {
    Vec2 u = make_pair(from.u[0], from.u[1]);
    WarpResults r;
    r.disk = square_to_disk(u);
    r.triangle = square_to_triangle(u);
    r.hemisphere = square_to_cosine_hemisphere(u);
    r.cone = square_to_cone(u, 0.01f + from.u[2]);
    r.sphere = square_to_sphere(make_pair(from.u[3], from.u[4]));
    r.basis = make_basis(r.sphere);
    r.there_and_back = from_local(r.basis, to_local(r.basis, r.hemisphere));
    r.pdf = cosine_hemisphere_pdf(r.hemisphere.z) + cone_pdf(0.01f + from.u[2]) + sphere_pdf();
    return r;
}

FN CameraResults run_camera(FormulaInput from) {
    CameraResults r;
    r.frame = make_camera_frame(make_triple(from.u[0], from.u[1], 2.0f + from.u[2]),
                                make_triple(from.u[3], from.u[4], from.u[5]), make_triple(0.0f, 1.0f, 0.0f),
                                0.3f + from.u[6], make_pair(640.0f, 360.0f));
    r.frame.aperture_radius = 0.1f * from.u[7];
    r.frame.focus_distance = 1.0f + from.u[8];
    Vec2 pixel = make_pair(640.0f * from.u[9], 360.0f * from.u[10]);
    r.pinhole = make_pinhole_ray(r.frame, pixel);
    r.lens = make_camera_ray(r.frame, pixel, make_pair(from.u[11], from.u[0]));
    r.projection = project_point(r.frame, r.lens.origin + r.lens.direction);
    return r;
}

FN ShadingResults run_shading(FormulaInput from) {
    BsdfParameters p;
    p.base_color = make_triple(from.u[0], from.u[1], from.u[2]);
    p.roughness = 0.2f + 0.8f * from.u[3];
    p.metallic = from.u[4];
    p.ior = 1.0f + from.u[5];
    Vec3 wo = square_to_cone(make_pair(from.u[6], from.u[7]), 0.95f);
    Vec3 wi = square_to_cone(make_pair(from.u[8], from.u[9]), 0.95f);
    Bsdf b = make_bsdf(p, wo.z);
    BsdfValue v = evaluate_bsdf(b, wo, wi);
    BsdfSample s = sample_bsdf(b, wo, 0.5f, make_pair(from.u[10], from.u[11]));
    ShadingResults r;
    r.f0 = b.f0;
    r.specular_probability = b.specular_probability;
    r.value = v.value;
    r.pdf = v.pdf;
    r.direction = s.direction;
    r.weight = s.weight;
    r.albedo = lookup_ggx_albedo(p.roughness, wo.z);
    r.diffuse_shares = find_shares(evaluate_diffuse(b, wo, wi), v.value);
    return r;
}

FN LayerParameters make_test_parameters(FormulaInput from) {
    LayerParameters l;
    l.specular_color = make_triple(from.u[4], from.u[5], 1.0f);
    l.specular_weight = from.u[6];
    l.metallic = from.u[7];
    l.dielectric_f0 = 0.1f * from.u[8];
    l.dielectric_f90 = 1.0f;
    l.diffuse_roughness = from.u[9];
    l.coat_weight = from.u[10];
    l.coat_roughness = 0.3f + 0.7f * from.u[11];
    l.coat_f0 = 0.05f;
    l.coat_f90 = 1.0f;
    l.coat_inverse_ior2 = 0.4f;
    l.coat_depth = make_triple(from.u[0], 2.0f * from.u[1], 3.0f * from.u[2]);
    l.coat_darkening = from.u[3];
    l.coat_inside = 0.6f;
    l.fuzz_color = make_triple(from.u[4], from.u[6], from.u[8]);
    l.fuzz_weight = from.u[5];
    l.fuzz_exponent = 1.0f + 10.0f * from.u[7];
    l.fuzz_scale = 0.9f;
    l.specular_anisotropy = from.u[10];
    l.coat_anisotropy = from.u[9];
    // Not constant: glslc -O of shaderc 2023.2 crashes where it can see that there is one azimuth.
    l.azimuth_scale = from.u[0] < 0.5f ? 0.0f : 2.0f;
    l.row_scale = 1.0f;
    l.first_entry = 32u;
    return l;
}

/// Of a material with all layers. The table of rests is one of numbers in [0, 1]: make_test_layers().
FN LayerResults run_layers(FormulaInput from) {
    LayeredSurface s;
    s.base_color = make_triple(from.u[0], from.u[1], from.u[2]);
    s.roughness = 0.3f + 0.7f * from.u[3];
    s.layers = make_test_parameters(from);
    Vec3 wo = square_to_cone(make_pair(from.u[6], from.u[7]), 0.95f);
    Vec3 wi = square_to_cone(make_pair(from.u[8], from.u[9]), 0.95f);
    LayeredBsdf b = make_layered_bsdf(s, make_test_layers(), wo);
    BsdfValue v = evaluate_layered_bsdf(b, make_test_layers(), wo, wi);
    BsdfSample drawn =
        sample_layered_bsdf(b, make_test_layers(), wo, from.u[2], make_pair(from.u[10], from.u[11]));
    LayerResults r;
    r.value = v.value;
    r.pdf = v.pdf;
    r.direction = drawn.direction;
    r.weight = drawn.weight;
    r.diffuse = evaluate_eon(s.base_color, from.u[9], wo, wi);
    r.diffuse_shares = find_shares(evaluate_layered_diffuse(b, make_test_layers(), wo, wi), v.value);
    r.power = find_power_of_two(20.0f * from.u[10] - 10.0f);
    r.logarithm = find_logarithm(1e-6f + from.u[11]);
    return r;
}

/// Of all kinds, from both sides.
FN GlassResults run_glass(FormulaInput from) {
    GlassParameters g;
    g.weight = 0.2f + 0.8f * from.u[0];
    g.ior = 1.1f + from.u[1];
    g.specular_color = make_triple(from.u[2], 1.0f, 0.5f);
    g.tint = make_triple(1.0f, from.u[3], 0.5f);
    g.depth = make_triple(0.0f, 3.0f * from.u[4], 1.0f);
    g.anisotropy = from.u[11];
    g.kind = from.u[5] < 0.5f ? kSolidGlass : from.u[5] < 0.8f ? kRoughWall : kClearWall;
    float roughness = 0.3f + 0.7f * from.u[6];
    Vec3 wo = square_to_cone(make_pair(from.u[7], from.u[8]), 0.95f);
    Vec3 wi = square_to_sphere(make_pair(from.u[9], from.u[10]));
    GlassBsdf b = make_glass_bsdf(g, roughness, from.u[11] < 0.5f);
    BsdfValue v = evaluate_glass_bsdf(b, wo, wi);
    // A draw between two lobes may go either way: of one alone.
    BsdfSample drawn = sample_glass_bsdf(b, wo, 0.0f, make_pair(from.u[3], from.u[4]));
    GlassDraw choice = draw_glass(g, from.u[2], wo.z, 0.999f);
    GlassResults r;
    r.value = v.value;
    r.pdf = v.pdf;
    r.direction = drawn.direction;
    r.weight = drawn.weight;
    r.left = absorb_along(g.depth, 2.0f * from.u[1]);
    r.passed = pass_clear_wall(g, from.u[2], from.u[3], wo.z);
    r.drawn_weight = choice.weight;
    r.drawn_u = choice.u;
    r.drawn_metallic = choice.metallic;
    return r;
}

/// Of a direction, and what the table says of it.
FN FacetResults run_facets(FormulaInput from) {
    float roughness = 0.3f + 0.7f * from.u[0];
    Vec3 wo = square_to_cone(make_pair(from.u[1], from.u[2]), 0.95f);
    Vec3 wi = square_to_cone(make_pair(from.u[3], from.u[4]), 0.95f);
    Facets f = make_facets(roughness, 0.9f * from.u[5]);
    LayerParameters l = make_test_parameters(from);
    FacetResults r;
    r.value = evaluate_facets(f, normalize(wo + wi), wo, wi);
    r.seen = make_pair(find_seen_roughness(roughness, from.u[6], wo), find_azimuth(wi));
    r.direction = sample_ggx_reflection(f.alpha, wo, make_pair(from.u[7], from.u[8]));
    r.basis = make_basis_along(wo, square_to_sphere(make_pair(from.u[9], from.u[10])));
    r.rest = lookup_layer_rest(make_test_layers(), l, roughness, wi);
    return r;
}

FN LightResults run_light(FormulaInput from) {
    Vec3 d = square_to_sphere(make_pair(from.u[0], from.u[1]));
    Vec3 shading = square_to_cone(make_pair(from.u[2], from.u[3]), 0.9f);
    Vec3 wo = square_to_cone(make_pair(from.u[4], from.u[5]), 0.9f);
    LightResults r;
    r.weight = power_heuristic(from.u[6], 0.1f + from.u[7]);
    r.place = direction_to_latlong(d);
    r.direction = latlong_to_direction(make_pair(from.u[0], from.u[1]));
    r.cone_height = sphere_cone_height(from.u[8], from.u[9] + 0.01f);
    r.distance = sphere_distance(d * 3.0f, 3.1f + from.u[10], shading);
    r.normal = bend_normal(shading, make_triple(0.0f, 0.0f, 1.0f), wo);
    return r;
}

FN ToneResults run_tone(FormulaInput from) {
    ToneResults r;
    r.shown = tone_map_filmic(make_triple(10.0f * from.u[0], from.u[1], from.u[2] - 0.2f));
    r.encoded = encode_srgb(from.u[3]);
    r.decoded = decode_srgb(from.u[4]);
    return r;
}

FN LightSourceData make_test_source(FormulaInput from, uint kind) {
    LightSourceData source;
    source.kind = kind;
    source.power = 1.0f + from.u[0];
    source.color = make_triple(from.u[1], from.u[2], 1.0f);
    source.strength = 2.0f;
    source.center = make_triple(3.0f, from.u[3], from.u[4]);
    source.radius = 0.2f + 0.5f * from.u[5];
    source.radius2 = source.radius * source.radius;
    source.basis = make_basis(square_to_sphere(make_pair(from.u[6], from.u[7])));
    source.cone = 0.01f + 0.1f * from.u[8];
    source.edge = 0.0f;
    source.half_width = 0.5f + from.u[1];
    source.half_height = 0.5f + from.u[2];
    source.is_visible = from.b & 1u;
    source.texture = kNone;
    source.link = kNone;
    source.group = 0u;
    return source;
}

/// A light that faces about towards `position`.
FN LightSourceData make_facing_source(FormulaInput from, uint kind, Vec3 position) {
    LightSourceData source = make_test_source(from, kind);
    Vec3 aside = make_triple(from.u[3] - 0.5f, from.u[4] - 0.5f, from.u[5] - 0.5f);
    source.basis = make_basis(normalize(position - source.center + aside));
    source.cone = 0.5f + 0.5f * from.u[8];
    return source;
}

/// A node about a light; its cones are wide and narrow.
FN LightNodeData make_test_node(FormulaInput from, LightSourceData source) {
    LightNodeData node;
    node.center = source.center;
    node.radius = 2.0f * from.u[5];
    node.axis = source.basis.n;
    node.spread_cosine = 2.0f * from.u[6] - 1.0f;
    node.spread_sine = sqrt(max(1.0f - node.spread_cosine * node.spread_cosine, 0.0f));
    node.reach_cosine = 0.0f;
    node.power = source.power;
    node.source = kNone;
    node.end = 1u;
    node.flags = kCanBeMet;
    return node;
}

FN SourceResults run_source(FormulaInput from) {
    Vec2 u = make_pair(from.u[10], from.u[11]);
    Vec3 position = make_triple(-from.u[9], from.u[8], from.u[7]);
    LightSourceData point_light = make_test_source(from, kSourcePoint);
    Vec3 to = make_triple(1.0f + from.u[0], from.u[1], from.u[2]);
    EnvironmentData e = {to, 0.6f, 0.8f, 64u, 32u, kNone};
    SourceResults r;
    r.sun = draw_sun(make_test_source(from, kSourceSun), u);
    r.sun.distance = 0.0f; // infinite, which no difference can be taken of
    r.point_light = draw_point_light(point_light, position, u);
    // Seen from in front: of an edge-on surface the density is the reciprocal of a rounding error.
    Vec3 facing = normalize(normalize(to) + r.sun.direction * 0.9f);
    float pdf = emitter_density(0.1f + from.u[3], 0.5f + from.u[4], facing, to);
    r.emitter = draw_emitter(to, to, max(pdf, 0.1f));
    LightSourceData emitters = make_test_source(from, kSourceEmitters);
    r.irradiance = estimate_irradiance(point_light, position) + estimate_irradiance(emitters, position);
    r.seen = meet_light(point_light, position, normalize(point_light.center - position), 100.0f);
    LightSourceData rectangle = make_facing_source(from, kSourceRectangle, position);
    LightSourceData disk = make_facing_source(from, kSourceDisk, position);
    LightSourceData spot = make_facing_source(from, kSourceSpot, position);
    r.rectangle = draw_listed_light(rectangle, position, u);
    r.disk = draw_listed_light(disk, position, u);
    r.spot = draw_listed_light(spot, position, u);
    r.flat_irradiance = estimate_irradiance(rectangle, position) + estimate_irradiance(disk, position);
    r.spot_irradiance = estimate_irradiance(spot, position);
    Vec3 towards = normalize(rectangle.center - position);
    r.rectangle_seen = meet_light(rectangle, position, towards, 100.0f);
    r.disk_seen = meet_light(disk, position, towards, 100.0f);
    r.spot_seen = meet_light(spot, position, towards, 100.0f);
    r.visible = see_light(spot, position, towards, 100.0f);
    r.face_uv = find_face_uv(rectangle, position, towards, make_pair(4.0f, 8.0f));
    r.into = turn_into_environment(e, to);
    r.out_of = turn_out_of_environment(e, to);
    r.density = environment_cell_density(e, from.u[5], normalize(to));
    r.position = locate_in_interval(from.u[6], 0.0f, 1.0f);
    LitPoint lit = {position, normalize(to), 0u};
    LightNodeData node = make_test_node(from, spot);
    r.node = estimate_node(node, lit);
    r.leaf = estimate_leaf(node, spot, lit);
    r.tree_share = find_tree_share(from.u[0], from.u[1]);
    r.left = stretch_random(0.5f * from.u[2], 0.0f, 0.5f);
    return r;
}

FN SurfaceResults run_surface(FormulaInput from) {
    Vec2 at = make_pair(from.u[0], from.u[1]);
    Vec3 a = make_triple(from.u[2], from.u[3], from.u[4]);
    Vec3 b = make_triple(1.0f + from.u[5], from.u[6], 0.0f);
    Vec3 c = make_triple(from.u[7], 1.0f + from.u[8], 0.0f);
    CellPlace place = locate_cell(false, 4u, at.x, at.y);
    Vec3 inside = blend_corners(a, b, c, weigh_corners(place, 4.0f));
    TrianglePoint point = make_triangle_point(inside, b - a, c - a, -1.0f, triangle_uv_area(false, 4.0f));
    Vec3 wild = make_triple(from.u[9] - 0.5f, from.u[10] - 0.5f, from.u[11] + 0.1f);
    Basis frame = make_basis(normalize(wild));
    SurfaceDerivative along_u = {b, frame, wild * 0.1f};
    SurfaceDerivative along_v = {c, frame, wild * 0.2f};
    SurfaceResults r;
    r.position = leave_edges(point.position, 0.02f, weigh_corners(place, 4.0f), b - a, c - a, 0.5f);
    r.normal = point.normal;
    r.area_per_uv = point.area_per_uv;
    r.error = bound_position_error(largest_coordinate(b), sum_magnitudes(c), 1.0f, 2.0f, from.u[0]);
    r.patch_uv = blend_patch_uv(at, at * 2.0f, at * 3.0f, at * 5.0f, at);
    r.polygon_uv = blend_polygon_uv(at, at * 2.0f, at * 3.0f, at * 5.0f, at);
    r.origin = offset_origin(inside, point.normal, 0.25f, frame.n);
    r.oriented = orient_shading_normal(interpolate_quad(a, b, c, wild, at), point.normal);
    r.plain = make_plain_normal(interpolate_triangle(a, b, c, at), point.normal);
    r.displaced = make_displaced_normal(displace_derivative_through(along_u, frame, a * 0.1f, frame.n),
                                        displace_derivative(along_v, frame.n), frame.n);
    // In no special position: what is at right angles but for rounding is on either side.
    Vec3 aside = square_to_sphere(at);
    Vec3 heights = make_triple(find_tangent_height(a - inside, frame.n, point.normal),
                               find_tangent_height(b - inside, normalize(b), point.normal),
                               is_lost_light(aside, point.normal, frame.n) ? 1.0f : 0.0f);
    r.lift = blend_tangent_heights(heights, weigh_corners(place, 4.0f));
    return r;
}
