#include "io/foreign_files.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>

#include <fmt/format.h>

#include "relief/error.h"
#include "relief/io.h"

namespace relief {

namespace {

/// What to export instead.
enum class Instead { mesh, map, picture, scene };

struct Format {
    std::string_view suffixes, what, way; ///< `way`: the menu path of the program that writes such files
    Instead instead = Instead::mesh;
};

constexpr std::string_view kBlender = "Blender: File > Export > Wavefront (.obj)";
constexpr std::string_view kMaya = "Maya: File > Export All, Files of type: OBJexport (plug-in objExport in "
                                   "Windows > Settings/Preferences > Plug-in Manager)";
constexpr std::string_view kZbrush = "ZBrush: Tool > Export, as .obj";
constexpr std::string_view kHoudini = "Houdini: right-click the surface node > Save Geometry, as .obj";
constexpr std::string_view kUsd =
    "relief-usd FILE -o FOLDER/scene.json, of the Python module (pip install \"relief[usd]\"); or, as a mesh "
    "alone, Blender: File > Import > Universal Scene Description, then File > Export > Wavefront (.obj); "
    "Houdini: "
    "right-click the surface node > Save Geometry, as .obj; Maya: File > Export All, OBJexport";
constexpr std::string_view kAlembic =
    "Blender: File > Import > Alembic (.abc), then File > Export > Wavefront (.obj); Houdini: right-click "
    "the surface node > Save Geometry, as .obj; Maya: File > Export All, OBJexport";
constexpr std::string_view kCollada =
    "Blender 4: File > Import > Collada (.dae), then File > Export > Wavefront (.obj); MeshLab: File > "
    "Import Mesh, then File > Export Mesh As";
constexpr std::string_view kMeshlab =
    "MeshLab: File > Import Mesh, then File > Export Mesh As, as .obj or .ply";
constexpr std::string_view k3dsMax = "3ds Max: File > Export > Export, Save as type: OBJ-Exporter";
constexpr std::string_view kPhotoshop =
    "Photoshop: Image > Mode > 32 Bits/Channel, then File > Save As > OpenEXR or TIFF";
constexpr std::string_view kGimp = "GIMP: File > Export As, as .png, .tif or .exr";
constexpr std::string_view kOiiotool = "OpenImageIO's command line: oiiotool FILE -o FILE.exr";
constexpr std::string_view kKtx = "KTX-Software's command line: ktx extract FILE.ktx2 FILE.png (a .ktx file: "
                                  "ktx2ktx2 FILE.ktx first)";
constexpr std::string_view kRaw = "darktable or RawTherapee: export it as .exr or .tif";
constexpr std::string_view kPtex = "Ptex holds a picture a face and Relief reads pictures over uvs: bake it "
                                   "to a mesh with uvs (Mudbox: Maps > Extract Texture Maps > New Operation)";

constexpr Format kFormats[] = {
    {".blend .blend1", "a Blender file", kBlender},
    {".usd .usda .usdc .usdz", "a USD file", kUsd, Instead::scene},
    {".abc", "an Alembic file", kAlembic},
    {".stl", "an STL file, which has no uvs,", kMeshlab},
    {".ma .mb", "a Maya file", kMaya},
    {".ztl", "a ZBrush tool", kZbrush},
    {".zpr", "a ZBrush project", kZbrush},
    {".mud", "a Mudbox file", "Mudbox: File > Export Selection, as .obj"},
    {".hip .hipnc .hiplc", "a Houdini file", kHoudini},
    {".geo .bgeo .bgeo.sc", "a Houdini geometry file", kHoudini},
    {".max", "a 3ds Max file", k3dsMax},
    {".3ds", "a 3D Studio file",
     "3ds Max: File > Import, then File > Export > Export, Save as type: OBJ-Exporter"},
    {".c4d", "a Cinema 4D file", "Cinema 4D: File > Export > Wavefront OBJ (.obj)"},
    {".dae", "a COLLADA file", kCollada},
    {".3dm", "a Rhino file", "Rhino: File > Export Selected, Save as type: OBJ"},
    {".skp", "a SketchUp file", "SketchUp: File > Export > 3D Model, as .obj"},
    {".off", "an OFF file", kMeshlab},
    {".x3d", "an X3D file", kMeshlab},
    {".wrl", "a VRML file", kMeshlab},
    {".ptx .ptex", "a Ptex file", kPtex, Instead::map},
    {".psd .psb", "a Photoshop file", kPhotoshop, Instead::picture},
    {".xcf", "a GIMP file", kGimp, Instead::picture},
    {".kra", "a Krita file", "Krita: File > Export, as .exr, .tif or .png", Instead::picture},
    {".rat", "a Houdini picture", "Houdini's command line: iconvert FILE.rat FILE.exr", Instead::picture},
    {".bmp", "a BMP file", kGimp, Instead::picture},
    {".tga", "a Targa file", kGimp, Instead::picture},
    {".gif", "a GIF file", kGimp, Instead::picture},
    {".webp", "a WebP file", kGimp, Instead::picture},
    {".avif", "an AVIF file", kGimp, Instead::picture},
    {".heic", "a HEIC file", kGimp, Instead::picture},
    {".jp2 .jpx .jpf .j2k .j2c .jph", "a JPEG 2000 file", kGimp, Instead::picture},
    {".dds", "a DDS file", kGimp, Instead::picture},
    {".ktx .ktx2", "a KTX file", kKtx, Instead::picture},
    {".basis", "a Basis Universal file", "its command line: basisu -unpack FILE.basis", Instead::picture},
    {".dpx", "a DPX file", kOiiotool, Instead::picture},
    {".cin", "a Cineon file", kOiiotool, Instead::picture},
    {".jxl", "a JPEG XL file", kGimp, Instead::picture},
    {".jxr .wdp .hdp", "a JPEG XR file", "its command line: JxrDecApp -i FILE -o FILE.tif", Instead::picture},
    {".heif .heics .hif", "a HEIF file", kGimp, Instead::picture},
    {".pfm .ppm .pgm .pbm .pnm .pam", "a Netpbm file", kOiiotool, Instead::picture},
    {".sgi .rgb .rgba .bw", "an SGI file", kOiiotool, Instead::picture},
    {".iff", "a Maya IFF file", kOiiotool, Instead::picture},
    {".pic", "a Softimage file", kOiiotool, Instead::picture},
    {".fits .fit", "a FITS file", kOiiotool, Instead::picture},
    {".ico .cur", "an icon", kGimp, Instead::picture},
    {".svg .svgz", "an SVG drawing", "Inkscape: File > Export, as .png", Instead::picture},
    {".dng .cr2 .cr3 .nef .arw .orf .rw2 .raf", "a camera's raw file", kRaw, Instead::picture},
};

struct GltfExtension {
    std::string_view name, what, way;
};

constexpr std::array<GltfExtension, 3> kGltfExtensions{{
    {"KHR_draco_mesh_compression", "a mesh compressed by Draco",
     "Blender: File > Export > glTF 2.0, untick Data > Compression; or gltf-transform copy IN.glb OUT.glb"},
    {"EXT_meshopt_compression", "a mesh compressed by meshopt",
     "gltfpack without -c and -cc; or gltf-transform copy IN.glb OUT.glb"},
    {"KHR_meshopt_compression", "a mesh compressed by meshopt",
     "gltfpack without -c and -cc; or gltf-transform copy IN.glb OUT.glb"},
}};

/// In the order of Instead.
constexpr std::string_view kAlternatives[] = {
    "export OBJ, PLY or glTF", "export EXR, TIFF or PNG over the mesh's uvs", "export EXR, TIFF or PNG",
    "export OBJ, PLY or glTF, or write a scene file with relief-usd"};

} // namespace

std::optional<ForeignFile> find_foreign_file(std::string_view name) {
    std::string lower(name);
    for (char& c : lower) c = char(std::tolower(static_cast<unsigned char>(c)));
    const auto has_suffix = [&](const Format& format) {
        for (std::string_view rest = format.suffixes; !rest.empty();) {
            const std::string_view suffix = rest.substr(0, rest.find(' '));
            if (lower.size() > suffix.size() && lower.ends_with(suffix)) return true;
            rest.remove_prefix(std::min(suffix.size() + 1, rest.size()));
        }
        return false;
    };
    const auto found = std::find_if(std::begin(kFormats), std::end(kFormats), has_suffix);
    if (found == std::end(kFormats)) return std::nullopt;
    return ForeignFile{fmt::format("{} is not read: {}", found->what, kAlternatives[size_t(found->instead)]),
                       std::string(found->way)};
}

std::optional<ForeignFile> find_foreign_gltf(std::string_view extension) {
    for (const GltfExtension& known : kGltfExtensions)
        if (known.name == extension)
            return ForeignFile{fmt::format("{} ({}) is not read: export OBJ, PLY or glTF without compression",
                                           known.what, known.name),
                               std::string(known.way)};
    return std::nullopt;
}

void refuse_foreign_file(const std::filesystem::path& file) {
    if (std::optional<ForeignFile> foreign = find_foreign_file(file.filename().string()))
        throw Error(ErrorKind::bad_input,
                    {std::move(foreign->message), file.string(), std::move(foreign->hint)});
}

} // namespace relief
