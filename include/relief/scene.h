// Scene description as plain values: build one in memory, or load one with relief/io.h. Right-handed, y up,
// lengths in scene units, angles in degrees where the name says so, colours linear Rec.709.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "relief/image.h"
#include "relief/types.h"

namespace relief {

// Limits enforced by all readers, the command and render(); docs/scene.schema.json holds the same numbers.
inline constexpr int kMaxPictureSize = 65536; ///< pixels per side
inline constexpr int kMaxSamples = 1 << 20;   ///< per pixel
inline constexpr int kMaxBounces = 1000;
inline constexpr int kMaxMapTiles = 10000; ///< images of one displacement map
inline constexpr int kMaxThreads = 4096;
inline constexpr int kMaxSubdivisionLevel = 8;
inline constexpr int kAutoSubdivisionLevel = -1;
inline constexpr float kMaxNormalScale = 1000;
inline constexpr float kMaxLensShift = 100;     ///< either way
inline constexpr float kMaxShutter = 16;        ///< frames from that of the picture, either way
inline constexpr float kInfiniteSharpness = 10; ///< of a crease
inline constexpr size_t kMaxLightGroupName = 64;

/// Lights, emissive materials and the environment may be in a group, whose light is the layer "light_NAME" of
/// a picture (ImageSettings::layers). Its name has letters of ASCII, digits, `_` and `-`, 1 to
/// kMaxLightGroupName of them. What names none, an empty one, is in the group `default`.
bool is_light_group_name(std::string_view name);
inline constexpr const char* kDefaultLightGroup = "default";

/// Semi-sharp crease of a subdivided mesh (DeRose, Kass and Truong 1998) between two positions, given by
/// index; a sharp vertex where `first` equals `second`.
struct Crease {
    uint32_t first = 0, second = 0;
    float sharpness = 0; ///< >= 0; infinitely sharp from kInfiniteSharpness on
    friend bool operator==(const Crease&, const Crease&) = default;
};

enum class SubdivisionScheme { none, bilinear, catmark };
/// Face-varying interpolation of uvs: `smooth` as positions, except that corners and junctions of uv island
/// boundaries stay sharp; `linear` within each face.
enum class UvRule { smooth, linear };
/// Boundary interpolation: boundary edges stay sharp, or also corners that belong to one face only.
enum class BoundaryRule { edge_only, edge_and_corner };
enum class CreaseRule { obey, ignore };

/// How a mesh becomes a smooth base surface.
struct Subdivision {
    SubdivisionScheme scheme = SubdivisionScheme::none;
    /// Every quad becomes 2^level x 2^level patches, [0, kMaxSubdivisionLevel]; a mesh with other faces than
    /// quads is subdivided at least once. kAutoSubdivisionLevel: faces are cut only where the surface would
    /// be more than a tenth of a pixel away from the limit surface otherwise.
    int level = kAutoSubdivisionLevel;
    UvRule uv = UvRule::smooth;
    BoundaryRule boundary = BoundaryRule::edge_and_corner;
    CreaseRule creases = CreaseRule::obey;
    friend bool operator==(const Subdivision&, const Subdivision&) = default;
};

inline constexpr int kOwnUvSet = -1; ///< of a texture: the set that Mesh::uvs are
inline constexpr int kMaxUvSet = 255;

/// Another set of uvs of a mesh, for textures of materials that name it.
struct UvSet {
    int number = 1; ///< [0, kMaxUvSet], as InputTexture::uv_set names it; another one than Mesh::uv_set
    std::vector<Vec2f> uvs;
    std::vector<uint32_t> indices; ///< one a corner; kNoIndex: its face has no uvs in this set
};

/// Polygon mesh with separate indices for positions, uvs and normals, as in OBJ.
struct Mesh {
    std::string name;
    std::string source; ///< source file, for messages; may be empty
    std::vector<Vec3f> positions;
    std::vector<Vec2f> uvs;           ///< may be empty
    std::vector<Vec3f> normals;       ///< may be empty; used by undisplaced faces and by FrameKind::file
    std::vector<uint32_t> face_sizes; ///< corners of each face, >= 3
    std::vector<uint32_t> position_indices; ///< one per corner, face after face, counter-clockwise
    std::vector<uint32_t> uv_indices;       ///< one a corner, or empty; kNoIndex: its face has no uvs
    std::vector<uint32_t> normal_indices;   ///< one a corner, or empty
    std::vector<std::array<float, 4>>
        tangents;                ///< one per corner: unit x, y, z, and the sign of the bitangent; or empty
    std::vector<Crease> creases; ///< used where the mesh is subdivided
    Subdivision subdivision;     ///< of the rendered surface
    /// Open edges whose ends are so near to each other become one edge where the mesh is displaced or
    /// subdivided; units of the mesh, >= 0. 0: only equal positions join. Unset: some rounding errors of the
    /// positions.
    std::optional<float> weld;
    int uv_set = 0; ///< number of the set that `uvs` are, [0, kMaxUvSet]
    /// Other sets, each of its own number. Displacement and tangents go by `uvs` alone.
    std::vector<UvSet> further_uvs;
};

enum class DisplacementType { vector, height };
enum class DisplacementSpace { tangent, object, world };
enum class WrapMode { clamp, repeat, mirror, black };
/// Source of the tangent frames: `mikk` is MikkTSpace, as in most bakers; `dpdu` the mean of dP/du at each
/// vertex; `file` the normals and tangents of the mesh, or MikkTSpace on its normals if it has no tangents.
enum class FrameKind { mikk, dpdu, file };
/// Unit of tangential displacements: scene units along unit axes, or units of dP/du and dP/dv, so that they
/// scale with the faces. Displacements along the normal are always in scene units.
enum class FrameLengths { absolute, relative };
/// Filter of texels. `none` is bilinear; `mip` bilinear on the mip level whose texels are as large as the
/// cells of the surface, for displacements alone. Smooth ones, for close-ups: `cubic` is the bicubic spline
/// through the texels; `bspline` has them as coefficients of a uniform bicubic B-spline, which smooths a
/// little.
enum class MapFilter { none, mip, cubic, bspline };
inline bool is_smooth(MapFilter filter) { return filter == MapFilter::cubic || filter == MapFilter::bspline; }

/// Signed permutation: channel c of the map moves along axis[c] (0, 1, 2 = t, b, n or x, y, z) times sign[c].
struct AxisMap {
    std::array<uint8_t, 3> axis{0, 1, 2};
    std::array<int8_t, 3> sign{1, 1, 1};
    friend bool operator==(const AxisMap&, const AxisMap&) = default;
};

/// One image of a displacement map; `udim` is 1001 + u + 10 v, and 1001 for a map without tiles.
struct MapTile {
    int udim = 1001;
    std::shared_ptr<const Texture> texture;
    friend bool operator==(const MapTile&, const MapTile&) = default; ///< the same image
};

/// What of a map's convention nobody said, so that a reader assumed it; for warnings only.
struct AssumedConvention {
    bool space = false, axes = false, midlevel = false, wrap = false;
    friend bool operator==(const AssumedConvention&, const AssumedConvention&) = default;
};

/// A displacement map and its convention. A texel displaces by A (value - midlevel) scale, A the signed
/// permutation; a height map along n by (R - midlevel.x) scale.x. Row 0 of a map is v = 1 unless `flip_v`.
struct Displacement {
    std::string name;
    DisplacementType type = DisplacementType::vector;
    DisplacementSpace space = DisplacementSpace::tangent;
    FrameKind frame = FrameKind::mikk;             ///< in tangent space; a height map uses only the normals
    FrameLengths lengths = FrameLengths::absolute; ///< in tangent space; not for height maps
    AxisMap axes;
    Vec3f midlevel{0, 0, 0};
    bool has_midlevel = false; ///< stated explicitly, even if 0; for inspection only
    AssumedConvention assumed; ///< of a map read from a file; nothing of one made in memory
    Vec3f scale{1, 1, 1};
    bool flip_v = false;
    bool is_udim = false; ///< tiles are selected by floor(u), floor(v); a missing tile displaces by 0
    WrapMode wrap = WrapMode::clamp;
    /// Dilation: texels in the gutter between uv islands that hold the background value take that of the
    /// nearest texel inside.
    bool dilate = true;
    MapFilter filter = MapFilter::none;
    /// Texels of maps of 8 or 16-bit integers are smoothed, each within half a step; a smooth filter only.
    bool dequantize = false;
    /// Shading normals include detail of the map that is finer than the cells.
    bool autobump = false;
    std::vector<MapTile> tiles;
};

/// What a texture of a material is for. Colours are multiplied by its first three channels, numbers by the
/// first one; the values of all but `emission` and `emission_luminance` end at 1. A normal is one about the
/// shading normal, displacement included, +Y towards growing v: raw values in [0, 1] of three channels or
/// more, direction 2 value - 1. Objects with one need uvs.
enum class MaterialInput : uint8_t {
    base_color,
    base_weight,
    base_diffuse_roughness,
    metallic,
    roughness,
    specular_weight, ///< not of glass
    specular_color,
    coat_weight,
    coat_color,
    coat_roughness,
    coat_darkening,
    fuzz_weight,
    fuzz_color,
    fuzz_roughness,
    transmission_weight,
    transmission_color, ///< not of a body with a transmission_depth
    emission,
    emission_luminance, ///< times all channels of Material::emission
    opacity,
    normal,
};
inline constexpr size_t kMaterialInputCount = 20;

/// A texture of one input of a material, with its place on the uv plane: read at uv_scale uv + uv_offset.
struct InputTexture {
    MaterialInput input = MaterialInput::base_color;
    std::vector<MapTile> tiles; ///< one, unless is_udim; finite values
    bool is_udim = false; ///< tiles are selected by floor(u), floor(v); where there is none, the input's
                          ///< number counts alone
    MapFilter filter = MapFilter::none; ///< not mip
    WrapMode wrap = WrapMode::repeat;   ///< outside [0, 1]^2; each tile of several ends with its own texels
    Vec2f uv_scale{1, 1}, uv_offset{0, 0};
    /// Number of a uv set that the meshes of all objects of the material have; not of a normal, whose frame
    /// goes by the mesh's own.
    int uv_set = kOwnUvSet;
    friend bool operator==(const InputTexture&, const InputTexture&) = default;
};

/// OpenPBR 1.1 without subsurface: fuzz over a coat over a base, which is metal, a diffuse
/// body under a clear dielectric surface, glass, or a mix of them. With what comes after `emission` as
/// it is, a metallic-roughness material. Colours are linear. Textures multiply the constants; row 0 of a
/// texture is v = 1.
struct Material {
    std::string name;
    Vec3f base_color{0.8f, 0.8f, 0.8f}; ///< linear, each in [0, 1]
    float roughness = 0.5f;             ///< [0, 1]; GGX alpha is its square
    float metallic = 0.0f;              ///< [0, 1]
    float ior = 1.5f;                   ///< of the clear surface, >= 1; 1 removes it
    Vec3f emission{0, 0, 0};            ///< radiance, >= 0
    float base_weight = 1;              ///< [0, 1], times base_color
    float base_diffuse_roughness = 0;   ///< [0, 1]; 0 is Lambert's law
    float specular_weight = 1;          ///< [0, 1], times the reflection of the base at normal incidence
    Vec3f specular_color{1, 1, 1};      ///< each in [0, 1]: a factor; of a metal its tint at grazing angles
    /// [0, 1]: facets are rougher along the tangent, by uv, than along the bitangent; 0: alike. Objects with
    /// an anisotropic material need uvs.
    float specular_roughness_anisotropy = 0;
    float coat_weight = 0;               ///< [0, 1]; 0 removes the coat
    Vec3f coat_color{1, 1, 1};           ///< each in [0, 1]: what is left of light straight down and up again
    float coat_roughness = 0;            ///< [0, 1]
    float coat_roughness_anisotropy = 0; ///< [0, 1]
    float coat_ior = 1.6f;               ///< >= 1
    float coat_darkening = 1;            ///< [0, 1]: of the base, by what the coat reflects back onto it
    float fuzz_weight = 0;               ///< [0, 1]; 0 removes the fuzz
    Vec3f fuzz_color{1, 1, 1};           ///< each in [0, 1]
    float fuzz_roughness = 0.5f;         ///< [0, 1]; below 0.07 as 0.07
    /// [0, 1]: part of the dielectric that is glass, of the ior and roughness above; not under a coat or
    /// fuzz. A body of it is closed, with its faces outwards; bodies of glass do not lie inside one another.
    float transmission_weight = 0;
    /// Each in [0, 1]: what is left of light that went through transmission_depth of a body; without a depth,
    /// at each crossing of its surface; straight through a thin wall.
    Vec3f transmission_color{1, 1, 1};
    float transmission_depth = 0; ///< scene units, >= 0; 0: the body itself absorbs nothing
    bool is_thin_walled = false;  ///< glass is a thin wall and no body: it refracts nothing
    /// [0, 1]: the part of rays that the surface stops, a cut-out below 1; not of an emitter. Intersectors
    /// take all surfaces for opaque.
    float opacity = 1;
    float normal_scale = 1;             ///< [0, kMaxNormalScale], of x and y of the normal map's direction
    bool normal_flip_y = false;         ///< +Y of the map points against v, as in DirectX
    std::string light_group;            ///< of what the surface emits; see is_light_group_name()
    std::vector<InputTexture> textures; ///< of any inputs, one each; colours are linear
    friend bool operator==(const Material&, const Material&) = default; ///< with the same images
};

/// The name of an input in scene files and messages.
const char* get_input_name(MaterialInput input);

/// Null: the material has no texture of that input.
const InputTexture* find_input_texture(const Material& material, MaterialInput input);

/// Gives an input a texture that repeats over the whole uv plane, in place of the one it has; null removes
/// it.
void set_input_texture(Material& material, MaterialInput input, std::shared_ptr<const Texture> texture,
                       MapFilter filter = MapFilter::none);

/// Calls visit(name, texture, filter) for each tile of the textures of a material.
template <class AnyMaterial, class Visit> void visit_textures(AnyMaterial& material, const Visit& visit) {
    for (auto& placed : material.textures)
        for (auto& tile : placed.tiles) visit(get_input_name(placed.input), tile.texture, placed.filter);
}

/// Whether some rays pass through a surface of the material as if it were not there.
inline bool is_cut_out(const Material& material) {
    return material.opacity < 1 || find_input_texture(material, MaterialInput::opacity);
}

inline bool has_normal_map(const Material& material) {
    return find_input_texture(material, MaterialInput::normal) != nullptr;
}

/// Whether the roughness of a surface of the material has a direction.
inline bool is_anisotropic(const Material& material) {
    return material.specular_roughness_anisotropy > 0 ||
           (material.coat_weight > 0 && material.coat_roughness_anisotropy > 0);
}

/// Roughness up to which thin walls are clear.
inline constexpr float kClearRoughness = 0.03f;

/// Whether a surface of the material is a thin wall that rays pass straight on, those to lights too.
inline bool is_clear_wall(const Material& material) {
    return material.is_thin_walled && material.transmission_weight > 0 &&
           material.roughness <= kClearRoughness;
}

/// Visibility mask with all bits set. Renders ignore masks and show all objects.
inline constexpr uint32_t kVisibleToAll = 0xffffffff;

struct Object {
    std::string name;
    uint32_t mesh = 0;
    uint32_t displacement = kNoIndex; ///< kNoIndex: not displaced
    uint32_t material = kNoIndex;     ///< kNoIndex: the default material
    Affine world_from_object;
    uint32_t visibility_mask =
        kVisibleToAll; ///< not 0; Intersector rays whose mask shares no bit miss the object
    /// In place of it the camera sees the shadow that it catches: black, with an alpha of the part that other
    /// objects take from the light straight from lights on it. To all other rays it is like any object. Only
    /// before a black ImageSettings::background, which makes films transparent.
    bool is_shadow_catcher = false;
};

struct Camera {
    Vec3f from{0, 0, 5}, to{0, 0, 0}, up{0, 1, 0};
    float fov_degrees = 35;    ///< vertical, in (0, 180)
    float aperture_radius = 0; ///< scene units; 0 is a pinhole
    float focus_distance = 1;  ///< scene units along the view axis, > 0
    /// Of the lens: the middle of the picture lies so far to the right and above of the view axis, in heights
    /// of the picture.
    Vec2f shift{0, 0};
    /// The shutter is open from and to so many frames after that of the picture, in [-kMaxShutter,
    /// kMaxShutter], open <= close; equal: for an instant.
    float shutter_open = 0, shutter_close = 0;
};

/// Latitude-longitude environment map of radiance; the centre of the image is seen along -z, rotated by
/// `rotate_degrees` about +y.
struct Environment {
    std::shared_ptr<const Texture> texture; ///< may be null: constant `color`
    Vec3f color{1, 1, 1};                   ///< multiplies the texture
    float strength = 1;
    float rotate_degrees = 0;
    std::string light_group;                                                  ///< see is_light_group_name()
    friend bool operator==(const Environment&, const Environment&) = default; ///< with the same image
};

enum class LightType { sun, point, rectangle, disk, spot };

struct Light {
    LightType type = LightType::sun;
    /// Sun: direction of travel of the light. Rectangle and disk: where the face looks that shines; the other
    /// is dark. Spot: its axis.
    Vec3f direction{0, -1, 0};
    float angle_degrees = 0.53f; ///< sun: diameter of the disc, [0, 90]; 0 is a delta light
    Vec3f position{0, 0, 0};     ///< centre, of all but suns
    float radius = 0;            ///< of the disk, > 0; of the sphere of a point or spot: 0 is a delta light
    Vec3f color{1, 1, 1};
    /// Sun: irradiance at normal incidence. Others: radiant intensity, of rectangles, disks and spots along
    /// `direction`; that of the former is their radiance times their area, whatever their size.
    float strength = 1;
    /// Rectangle: along its height; of disks with a texture the same. Where parallel to `direction`, -z.
    Vec3f up{0, 1, 0};
    float width = 1, height = 1; ///< rectangle: > 0
    float cone_degrees = 45;     ///< spot: whole angle of its cone, (0, 180]
    float blend = 0; ///< spot: part of the angle from the edge inwards over which it fades, [0, 1]
    /// Whether camera rays see the light itself; only of one with extent. It never hides what is behind it
    /// in the scene, but covers ImageSettings::background: alpha is 1 there.
    bool is_visible_to_camera = false;
    /// Light linking, by the names of objects, or of their meshes where they have none: those that the light
    /// lights (none named: all), but for those that it does not. Shadows fall from all objects.
    std::vector<std::string> link_includes, link_excludes;
    /// Rectangle and disk: linear values that multiply `color`, upright as seen from where the light shines;
    /// a disk shows the circle in the middle. `strength` is that of a white one.
    std::shared_ptr<const Texture> color_texture;
    std::string light_group; ///< see is_light_group_name()
};

/// Image settings stored in a scene file; the command line overrides them.
struct PictureDefaults {
    std::optional<int> width, height, spp, bounces;
    std::optional<uint32_t> seed;
    std::optional<float> fps; ///< frames a second, > 0; for other programs
};

struct Scene {
    std::vector<Mesh> meshes;
    std::vector<Displacement> displacements;
    std::vector<Material> materials;
    std::vector<Object> objects;
    std::vector<Light> lights;
    std::optional<Environment> environment;
    Camera camera;
    PictureDefaults picture;
    std::string source;                ///< scene or mesh file, for messages
    uint64_t hash = 0;                 ///< of the content that determines the picture; 0: built in memory
    std::vector<std::string> warnings; ///< from the reader
};

/// What differs in a scene at another time.
struct SceneUpdate {
    /// All of it, but that meshes which are as they were before are empty; nullopt: nothing but the camera
    /// differs.
    std::optional<Scene> scene;
    Camera camera;
    uint64_t scene_hash = 0; ///< of all that is to be seen then, as Scene::hash
};

/// What changes in a scene from frame to frame: lists have a value a frame.
struct SceneMotion {
    int first_frame = 1;
    size_t frame_count = 0; ///< 0: nothing moves
    /// Scales, then turns about x, y and z, then moves.
    struct Placement {
        Vec3f translate, rotate_degrees, scale{1, 1, 1};
    };
    struct View {
        double frame = 1;
        Vec3f from, to;
    };
    std::map<std::string, std::vector<Placement>> objects; ///< by name; in place of their transforms
    std::map<std::string, std::vector<std::shared_ptr<const Texture>>>
        maps;                ///< of displacements by name, which have one tile
    std::vector<View> views; ///< of the camera, at some frames and smooth between them; empty: it stays
};

/// Checks all indices and ranges, and that values are finite. Throws Error{bad_input} naming the offending
/// object.
void validate_scene(const Scene& scene);

/// The same for a camera.
void validate_camera(const Camera& camera);

/// The same for one mesh, which messages call by its name, or by `index` if it has none.
void validate_mesh(const Mesh& mesh, size_t index = 0);

} // namespace relief
