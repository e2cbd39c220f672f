// Reading and writing of files: scenes, meshes, maps and images. The core does not need it (library
// relief_io). relief_io reads HDR, TIFF, PNG, JPEG and EXR itself, except EXR with subsampled channels: such
// a file is read by the module relief_pictures beside the program, which is loaded when it is first needed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <iosfwd>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "relief/image.h"
#include "relief/progress.h"
#include "relief/scene.h"

namespace relief {

/// Where meshes are read whose format a third-party library parses (FBX): in this process, or in a child
/// process with limits, so that whatever the library does with a file ends in an Error.
struct MeshReaderSettings {
    /// Started for each file; a program whose main() calls run_mesh_reader() first: the command `relief`, or
    /// "/proc/self/exe" for the running program itself. Empty: files are read in this process.
    std::filesystem::path program;
    uint64_t memory_bytes = 0;          ///< of the child; 0: half of what the machine has available
    uint64_t stack_bytes = 64ull << 20; ///< of the child's thread
    double seconds = 60;                ///< of the clock; in proportion for files above 64 MiB
    /// Returning true ends the child and throws Error{failed}. Called every few milliseconds by the thread
    /// that reads. May be empty.
    std::function<bool()> is_cancelled;
};

/// For the first line of main() of a program that is named as MeshReaderSettings::program: does the work of
/// the child process where the arguments ask for it, and returns its exit code. Else nothing.
std::optional<int> run_mesh_reader(int argument_count, const char* const* arguments);

/// Whether a file is a picture by its extension, in any case: of those that read_image reads.
bool is_picture_name(const std::filesystem::path& file);

/// Reads a scene file (JSON, `docs/scene.schema.json`). Paths inside are relative to the file. Throws
/// Error{bad_input} with file, line and column, object and hint; for meshes as load_mesh, for images as
/// read_image.
Scene load_scene(const std::filesystem::path& file, const MeshReaderSettings& reader = {});

/// Meshes and pictures in memory, by the names that a scene text calls their files by. Those of pictures may
/// hold a token for tiles in the text ("hide.`<UDIM>`") and the number of a tile here ("hide.1001").
struct SceneAssets {
    std::map<std::string, Mesh>
        meshes; ///< with their normals, tangents and creases; each for one mesh of the text
    std::map<std::string, std::shared_ptr<const Texture>> textures; ///< as read_texture reads them
    /// Names of meshes of the text that are left out of the scene, as SceneUpdate::scene may have them, and
    /// their hash_mesh().
    std::map<std::string, uint64_t> kept_meshes;
};

/// The share of a mesh in Scene::hash.
uint64_t hash_mesh(const Mesh& mesh);

/// Reads the text of a scene file. A name of a mesh or picture that is in `assets` stands for what is there;
/// other names are files, relative to `folder`. `frame`: of values with keys and of files with `####`, as
/// Shot::load takes it; unset: the first of `render.frames`, or 1. The rest as load_scene.
Scene parse_scene_text(std::string_view text, const std::filesystem::path& folder, SceneAssets assets = {},
                       std::optional<double> frame = {}, const MeshReaderSettings& reader = {});

/// Convention of a displacement map. Unset values come from the preset, then from the file; docs/formats.md
/// lists the names.
struct MapOptions {
    std::string preset; ///< empty: none
    std::optional<std::string> type, space, axes, frame, lengths, encoding, wrap, filter;
    std::optional<Vec3f> midlevel, scale; ///< one per channel; of decoded values
    bool flip_v = false;
    bool dilate = true, autobump = false, dequantize = false; ///< see Displacement
};

/// Reads the tiles of a map. `file` may contain `<UDIM>`, `<UVTILE>` or `<uvtile>`. Non-finite values are
/// kept for inspect_map; render() rejects them. Assumptions made about the convention are added to
/// `warnings`. Throws Error{bad_input}.
Displacement load_map(const std::filesystem::path& file, const MapOptions& options,
                      std::vector<std::string>& warnings);

/// The convention that load_map would derive from the options for a file of floats, without tiles.
Displacement make_map_meaning(const MapOptions& options);

/// The options of a map's convention, each of them set that counts for its space: no preset, no encoding, and
/// frame and lengths in tangent space alone.
MapOptions describe_map_meaning(const Displacement& map);

/// Sample type of a written map file.
enum class MapSamples { float16, float32, uint16 };

/// Writes the tiles of a map. The extension selects the format: .exr (float16 or float32) or .png (uint16,
/// values in [0, 1]). A map with tiles needs a name with `<UDIM>`, `<UVTILE>` or `<uvtile>`; folders must
/// exist. Each file is replaced atomically. Throws Error{usage} for another extension, a sample type that the
/// format lacks, or a name with a missing or superfluous token; Error{bad_input} for values out of range.
void write_map(const Displacement& map, const std::filesystem::path& file, MapSamples samples,
               const ProgressFunction& on_progress = {});

/// Writes .obj, or binary .ply: faces unchanged, with uvs. Throws Error{usage} for another extension,
/// Error{bad_input} for an invalid mesh, Error{failed} where the file cannot be written.
void write_mesh(const Mesh& mesh, const std::filesystem::path& file,
                const ProgressFunction& on_progress = {});

/// For a file that is one of several tiles in its folder ("head.1001.exr"): the name with the token that
/// matches all of them ("head.`<UDIM>`.exr"). Else empty.
std::string find_tile_pattern(const std::filesystem::path& file);

/// An axis of a mesh file that points up, where y does in a scene.
enum class UpAxis { x, y, z };

/// How to render a mesh without a scene file.
struct MeshSceneOptions {
    std::filesystem::path displacement_map; ///< empty: none; may hold `<UDIM>`
    MapOptions map;
    std::optional<std::string> subdivision; ///< scheme: none, bilinear or catmark
    std::optional<int> subdivision_level;   ///< [0, kMaxSubdivisionLevel], or kAutoSubdivisionLevel (default)
    std::optional<float> weld;              ///< see Mesh::weld
    UpAxis up = UpAxis::y;                  ///< the object is turned so that it becomes y
    std::filesystem::path environment;      ///< empty: a studio, see load_mesh_scene
    MeshReaderSettings reader;
};

/// A mesh with automatic camera (from above, front; the object fills about 85 % of the height of a square or
/// wider picture) and light. A given environment is turned so that most light comes from the camera's left
/// and above, and its strength is normalised so that a white diffuse surface of the brightest orientation
/// that the camera can see has radiance 1. Without one a studio lights the mesh: a key light from the
/// camera's upper left, and an environment that holds a fill from its right, a rim from behind and a soft
/// backdrop. aim_scene() places the studio for another camera. Throws as load_mesh, load_map and read_image.
Scene load_mesh_scene(const std::filesystem::path& mesh, const MeshSceneOptions& options);

/// A mesh in memory, displaced by `map` unless that is null, with automatic camera and light.
Scene make_mesh_scene(Mesh mesh, const Displacement* map);

/// Camera and light of a scene with one object, as load_mesh_scene chooses them: the picture of its
/// environment lights it, where there is one. An object without a material gets one of clay. Throws as
/// render().
void complete_mesh_scene(Scene& scene);

/// A map on a plane two units wide that faces +z, with automatic camera and light. Throws Error{bad_input}.
Scene make_map_scene(const Displacement& map);

/// Whether load_mesh reads files with this extension (.obj .ply .gltf .glb .fbx).
bool is_mesh_file(const std::filesystem::path& file);

/// Throws Error{bad_input} where the extension is that of a program's own format which nothing here reads
/// (.blend .usd .abc .stl .ma .ztl .psd .ptx ...), with the menu path by which that program exports another.
/// The functions that read files call it themselves.
void refuse_foreign_file(const std::filesystem::path& file);

struct MeshReadOptions {
    int uv_set = 0; ///< of glTF and FBX, from 0; OBJ and PLY have only set 0
    /// Those that are there become Mesh::further_uvs; the mesh's own number is passed over.
    std::vector<int> further_uv_sets;
    /// Of glTF: name or number, from 0, of the animation that moves nodes and morph targets; empty: they
    /// rest.
    std::string animation;
    double time = 0; ///< in it, seconds
    MeshReaderSettings reader;
};

/// Reads a polygon mesh; quads and n-gons are kept. Throws Error{bad_input} with file, place and hint, also
/// where a child process was ended by a signal or reached a limit; Error{failed} where it cannot be started.
Mesh load_mesh(const std::filesystem::path& file, const MeshReadOptions& options = {});

/// The same; what of the file does not show in the mesh, as skins of glTF, is added to `warnings`, with the
/// name of the file.
Mesh load_mesh(const std::filesystem::path& file, const MeshReadOptions& options,
               std::vector<std::string>& warnings);

/// Turns positions, normals and tangents so that `up` becomes y.
void turn_upright(Mesh& mesh, UpAxis up);

/// Writes scene.json, meshes (OBJ) and maps (EXR) into a folder; load_scene restores the same scene. Throws
/// Error{bad_input} for a map in the mesh's own tangent frames, since OBJ has no tangents.
void save_scene(const Scene& scene, const std::filesystem::path& folder,
                const ProgressFunction& on_progress = {});

/// The same for a scene that moves: values become keys, maps files with the numbers of their frames. Throws
/// also Error{usage} for lists of other lengths and for unknown names.
void save_shot(const Scene& scene, const SceneMotion& motion, const std::filesystem::path& folder,
               const ProgressFunction& on_progress = {});

/// What of a scene differs from the file that it was read from, beside what aim_scene changes.
struct SceneChanges {
    std::set<std::string> displacements; ///< names: all of their conventions are written, presets resolved
    std::set<std::string> materials;     ///< names: base_color, roughness and metallic are written
    std::map<std::string, std::filesystem::path> maps; ///< files that hold the texels of displacements now
    std::filesystem::path environment;                 ///< its picture; empty: as it was
    std::optional<double> frame; ///< of a scene with keys: it is written as it is there, without them
};

/// Writes `scene`, which was read from `input` (a scene file, or a mesh with these options) and changed by
/// aim_scene and as `changes` says, as a scene file that names the files of `input`; load_scene restores the
/// same scene. Comments
/// say what each section means, and `picture_options`: what its picture had beside. A mesh of the scene that
/// came from no file is written beside it; what `file` held before is kept as FILE.bak, or
/// FILE.bak2 and so on where others are. Throws as
/// write_text_file.
void save_scene_copy(const Scene& scene, const std::filesystem::path& input, const MeshSceneOptions& options,
                     const std::filesystem::path& file, const std::vector<std::string>& picture_options = {},
                     const SceneChanges& changes = {});

/// Reads all channels of the first part as floats, with data window and metadata. Throws Error{bad_input} for
/// a file that is missing, damaged, too large or of an unknown format, Error{failed} where the module
/// relief_pictures is needed but missing or of another version, Error{out_of_memory} where the pixels do not
/// fit.
Image read_image(const std::filesystem::path& file);

/// Reads texels as stored: no colour conversion; the orientation that a TIFF or JPEG file names is followed.
/// `file` may name a layer or a part of an EXR file, as split_picture_name() reads it; otherwise the RGB
/// channels of the first part are read, or its first layer. Layers that are left out then are in
/// Texture::warnings. Throws as read_image, and Error{bad_input} with the names that there are.
Texture read_texture(const std::filesystem::path& file);

/// A picture by its file and, of EXR files, the layer and the part that are meant; empty: not named.
struct PictureName {
    std::string file, part, layer;
};

/// Splits "FILE.exr:LAYER" and "FILE.exr:PART:LAYER". A name without a colon after ".exr" is that of a file.
PictureName split_picture_name(const std::string& name);

/// The name that split_picture_name() takes apart.
std::string join_picture_name(const PictureName& name);

/// A part of a picture; files of other kinds than EXR have one without a name.
struct PicturePart {
    struct Layer {
        std::string name;                  ///< empty: channels without a layer
        std::vector<std::string> channels; ///< in the order in which a map reads them, without the layer
        std::vector<std::string> types;    ///< of each: "half", "float" or "uint"
    };
    std::string name;
    int x = 0, y = 0, width = 0, height = 0;                     ///< data window
    int full_x = 0, full_y = 0, full_width = 0, full_height = 0; ///< display window
    std::vector<Layer> layers;
    bool is_deep = false;
};

/// The parts of an EXR file; none for files of other kinds. Throws as read_image.
std::vector<PicturePart> list_picture_parts(const std::filesystem::path& file);

/// Writes an image; the extension selects .exr (all channels, ZIP, float), .hdr (R, G, B) or .png (tone
/// mapped, 8-bit sRGB). The file is replaced atomically: written beside its place, then renamed. Throws
/// Error{usage} for another extension, Error{failed} where it cannot be written, std::bad_alloc.
void write_image(const Image& image, const std::filesystem::path& file);

/// Throws Error{usage} for an unknown display transform of PNG files, Error{failed} where its libraries
/// cannot be loaded: agx, aces, filmic, standard, raw, as the header entry "relief:display" names them.
void check_tone_map(const std::string& name);

/// Throws what write_image to this file would throw because of its name, folder or permissions.
void check_writable(const std::filesystem::path& file);

/// Calls `body`, within which the functions above use at most `threads` threads; 0: all cores, the default.
void with_io_threads(int threads, const std::function<void()>& body);

/// Writes a text file, replaced atomically. Throws Error{failed}.
void write_text_file(const std::filesystem::path& file, std::string_view text);

/// The same of what `write` writes to a binary stream.
void write_file(const std::filesystem::path& file, const std::function<void(std::ostream&)>& write);

/// What a symbolic link, or a chain of them, leads to, be it there or not; other names as they are. Files are
/// written there. Thread safe.
std::filesystem::path find_link_end(std::filesystem::path file);

/// Throws what write_text_file to this file would throw because of its folder or permissions.
void check_text_writable(const std::filesystem::path& file);

} // namespace relief
