// Files: scenes, meshes, maps in; scenes and pictures out. Links against relief_io; the core works without
// it. Plain EXR is read by relief_io itself; PNG, JPEG, TIFF, HDR and other EXR by the module
// relief_pictures, which lies beside the program and is loaded when the first such picture is opened.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "relief/image.h"
#include "relief/scene.h"

namespace relief {

/// Reads a scene file (JSON, `docs/scene.schema.json`). Paths inside are relative to the file.
/// Throws Error{bad_input} with file, line and column, object and hint; for its pictures as read_image.
Scene load_scene(const std::filesystem::path& file);

/// What is said of a displacement map beside its file. Unset values come from the preset, then from the file;
/// docs/formats.md lists the names.
struct MapOptions {
    std::string preset; ///< empty: none
    std::optional<std::string> type, space, axes, frame, lengths, encoding, wrap, filter;
    std::optional<Vec3f> midlevel, scale; ///< a channel each; of the values after the encoding
    bool flip_v = false;
    bool dilate = true, autobump = false; ///< see Displacement
};

/// The tiles of a map and what they mean. `file` may hold `<UDIM>`, `<UVTILE>` or `<uvtile>`. Values that are
/// not finite are kept, for inspect_map; a render refuses them. What had to be assumed is added to
/// `warnings`. Throws Error{bad_input}.
Displacement load_map(const std::filesystem::path& file, const MapOptions& options,
                      std::vector<std::string>& warnings);

/// What the options say of a map, without its tiles: as load_map does for a file of floats.
Displacement make_map_meaning(const MapOptions& options);

/// Samples of a map file that is written.
enum class MapSamples { float16, float32, uint16 };

/// Writes the tiles of a map by the extension of the name: .exr (float16 or float32) or .png (uint16, which
/// keeps [0, 1] only). A map with tiles takes a name with `<UDIM>`, `<UVTILE>` or `<uvtile>`; folders must be
/// there. Files appear whole or not at all. Throws Error{usage} for another extension, samples that it does
/// not hold, or a name with a token too many or too few; Error{bad_input} for values that do not fit.
void write_map(const Displacement& map, const std::filesystem::path& file, MapSamples samples);

/// Writes .obj, or .ply (binary): faces as they are, with uvs. Throws Error{usage} for another extension,
/// Error{bad_input} for a mesh that is not sound, Error{failed}.
void write_mesh(const Mesh& mesh, const std::filesystem::path& file);

/// For the plain name of a file that is one tile of several that lie in its folder ("head.1001.exr"): the
/// name with the token that takes them all ("head.`<UDIM>`.exr"). Else empty.
std::string find_tile_pattern(const std::filesystem::path& file);

/// What a mesh is rendered with that comes without a scene file.
struct MeshSceneOptions {
    std::filesystem::path displacement_map; ///< empty: none; may hold `<UDIM>`
    MapOptions map;
    std::optional<std::string> subdivision; ///< scheme: none, bilinear or catmark
    std::optional<int> subdivision_level;   ///< [0, kMaxSubdivisionLevel]
    std::filesystem::path environment;      ///< empty: a soft sky and a sun
};

/// A mesh alone: automatic camera (from above, front; the object fills about 85 % of the height of a square
/// or wider picture) and light. The brightness of an environment given here is set so that the brightest
/// white diffuse surface that the camera can see, whatever way it is turned, has radiance 1.
Scene load_mesh_scene(const std::filesystem::path& mesh, const MeshSceneOptions& options);

/// A mesh in memory, displaced by `map` unless that is null, with the same kind of camera and light.
Scene make_mesh_scene(Mesh mesh, const Displacement* map);

/// A map alone, on a plane two units wide that faces +z, with the same kind of camera and light. Throws
/// Error{bad_input}.
Scene make_map_scene(const Displacement& map);

/// True when the file name ends like a mesh that load_mesh reads (.obj .ply .gltf .glb .fbx).
bool is_mesh_file(const std::filesystem::path& file);

struct MeshReadOptions {
    int uv_set = 0; ///< of glTF and FBX, counted from 0; OBJ and PLY have the first one only
};

/// Polygons of a file, quads and n-gons kept. Throws Error{bad_input} with file, place and hint.
Mesh load_mesh(const std::filesystem::path& file, const MeshReadOptions& options = {});

/// Writes scene.json, meshes (OBJ) and maps (EXR) into a folder, so that load_scene gives the same scene.
/// Throws Error{bad_input} for a map that goes through tangents of its mesh, since OBJ holds none.
void save_scene(const Scene& scene, const std::filesystem::path& folder);

/// Reads all channels of the first part as floats, data window and metadata included. Throws
/// Error{bad_input} for a file that is missing, damaged, too large or of an unknown kind, Error{failed} where
/// it takes the module relief_pictures and that is missing or of another version, Error{out_of_memory} where
/// its pixels do not fit.
Image read_image(const std::filesystem::path& file);

/// Texels as stored: no colour conversion, no flip. Throws as read_image.
Texture read_texture(const std::filesystem::path& file);

/// Writes by extension: .exr (all channels, ZIP, float), .hdr (R, G, B), .png (tone mapped, 8 bit sRGB).
/// The file appears whole or not at all: it is written beside its place and renamed. Throws Error{usage} for
/// another extension, Error{failed} where it cannot be written, std::bad_alloc.
void write_image(const Image& image, const std::filesystem::path& file);

/// Throws now if write_image to this file would fail for its name, folder or rights.
void check_writable(const std::filesystem::path& file);

/// Calls `body`, in which all of the above takes at most `threads` threads; 0: all cores, as outside.
void with_io_threads(int threads, const std::function<void()>& body);

/// Writes any text; the file appears whole or not at all. Throws Error{failed}.
void write_text_file(const std::filesystem::path& file, std::string_view text);

/// Throws now if write_text_file to this file would fail for its folder or rights.
void check_text_writable(const std::filesystem::path& file);

} // namespace relief
