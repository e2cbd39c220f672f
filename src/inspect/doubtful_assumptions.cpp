// Conventions of maps, assumed or declared, compared with what their values look like.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/map_convention.h"
#include "analysis/map_statistics.h"
#include "analysis/mesh_statistics.h"
#include "base/parallel.h"
#include "image/texel_layout.h"
#include "inspect/facts.h"
#include "inspect/map_mistakes.h"
#include "relief/convert.h"
#include "relief/inspect.h"
#include "scene/face_uvs.h"
#include "scene/tile_use.h"

namespace relief {

namespace {

constexpr uint64_t kMostTexels = uint64_t(1) << 18; ///< 512 x 512: a few hundredths of a second
constexpr size_t kMostFaces = 50000; ///< of a mesh on which a map is tried; else the map alone is looked at
constexpr size_t kMostOverlapFaces = size_t(1) << 20;
constexpr size_t kMostOverlapMeshes = 16; ///< of one map: each takes some hundredths of a second

uint64_t count_texels(const Displacement& map) {
    uint64_t count = 0;
    for (const MapTile& tile : map.tiles) count += uint64_t(tile.texture->width) * tile.texture->height;
    return count;
}

/// Every `step`th texel of every `step`th row.
std::shared_ptr<const Texture> thin_out(const Texture& texture, uint32_t step) {
    auto result = std::make_shared<Texture>();
    result->width = std::max(1u, texture.width / step), result->height = std::max(1u, texture.height / step);
    result->file = texture.file, result->colour_tag = texture.colour_tag;
    make_values_like(texture, *result);
    for (uint32_t y = 0; y < result->height; ++y)
        for (uint32_t x = 0; x < result->width; ++x) {
            const size_t from = texture.find_texel((size_t(x) * step + step / 2) % texture.width,
                                                   (size_t(y) * step + step / 2) % texture.height);
            copy_values(texture, from, *result, result->find_texel(x, y), texture.stride);
        }
    return result;
}

/// The map, thinned out where it has more texels than can be read in a moment.
Displacement thin_out(const Displacement& map) {
    Displacement result = map;
    const uint64_t count = count_texels(map);
    if (count <= kMostTexels) return result;
    const auto step = uint32_t(std::ceil(std::sqrt(double(count) / double(kMostTexels))));
    for (MapTile& tile : result.tiles) tile.texture = thin_out(*tile.texture, step);
    return result;
}

/// The setting that mends a mistake of the texels; null: no setting does.
const char* find_setting(const std::string& code) {
    if (code == "E-NONEG") return "displacement.encoding = signed";
    if (code == "W-GRAY") return "displacement.type = height";
    if (code == "W-BORDER") return "displacement.midlevel = R,G,B";
    return nullptr;
}

/// What the reader of files has warned of already.
bool is_told(const std::string& code) { return code == "W-8BIT" || code == "W-INT16" || code == "W-1CH"; }

void add_mistakes(const Displacement& map, const MapStatistics& statistics, std::vector<Finding>& findings) {
    std::vector<Finding> found;
    find_map_mistakes(map, MapMeaning::declared, statistics, found);
    for (Finding& finding : found) {
        if (finding.severity == Severity::note || is_told(finding.code)) continue;
        if (const char* setting = find_setting(finding.code)) finding.text += fmt::format(": {}", setting);
        findings.push_back(std::move(finding));
    }
}

void add_convention(const Displacement& map, const MapConvention& convention,
                    std::vector<Finding>& findings) {
    if (map.space != DisplacementSpace::tangent) return;
    const bool is_object = convention.space.is_clear && convention.space.value == DisplacementSpace::object;
    if (is_object && map.assumed.space && !convention.is_space_by_seams)
        add_warning(
            findings, "I-SPACE",
            "tangent space is assumed, but it looks like object space: {}; write displacement.space = object",
            convention.space.reason);
    if (is_object || !convention.axes.is_clear) return;
    if (map.assumed.axes && !agrees_on_axes(convention, map))
        add_warning(findings, "I-AXES", "axes {} are assumed, but {}; {}",
                    format_map_axes(map.axes, map.space), convention.axes.reason,
                    advise_axes(convention, map.space));
    else if (!map.assumed.axes && contradicts_axes(convention, map))
        add_note(findings, "I-AXES", "axes {} are declared, but {}; if the relief looks wrong, {}",
                 format_map_axes(map.axes, map.space), convention.axes.reason,
                 advise_axes(convention, map.space));
}

/// One image that does not repeat is stretched from its edge over uvs outside of it.
void add_range(const Displacement& map, const Mesh& mesh, std::vector<Finding>& findings) {
    constexpr float kRounding = 1e-3f;
    if (map.is_udim || !map.assumed.wrap) return;
    const bool is_outside = std::ranges::any_of(mesh.uvs, [](const Vec2f& uv) {
        return std::min(uv.x, uv.y) < -kRounding || std::max(uv.x, uv.y) > 1 + kRounding;
    });
    if (is_outside)
        add_warning(findings, "W-UVRANGE",
                    "the uvs of mesh '{}' leave the unit square, where one image ends: name all tiles as "
                    "<UDIM>, or write displacement.wrap = repeat",
                    mesh.name);
}

/// What was sculpted on one face shows on another; a map that was said to repeat, or not to, is shared on
/// purpose.
void add_overlap(const Displacement& map, const Mesh& mesh, std::vector<Finding>& findings) {
    constexpr double kCells = 1 << 18; ///< as many as texels: some hundredths of a second
    if (!map.assumed.wrap || mesh.uv_indices.empty() || mesh.face_sizes.size() > kMostOverlapFaces) return;
    if (!find_mesh_faults(mesh).is_sound()) return;
    const double overlap = find_faces_without_uvs(mesh).count > 0
                               ? measure_uv_overlap(drop_faces_without_uvs(mesh), kCells)
                               : measure_uv_overlap(mesh, kCells);
    if (overlap > kMuchOverlap)
        add_warning(findings, "W-UVOVER",
                    "faces of mesh '{}' share {:.1f} % of the uv area: what is sculpted on one shows on the "
                    "others; lay the islands apart, or write displacement.wrap = clamp if this is meant",
                    mesh.name, 100 * overlap);
}

/// What one pass over the corners of a sound mesh tells.
void add_mesh_doubts(const Displacement& map, const Mesh& mesh, std::vector<Finding>& findings) {
    if (mesh.uv_indices.empty()) return;
    size_t triangles = 0, mirrored = 0, first = 0;
    for (const uint32_t size : mesh.face_sizes) {
        triangles += size == 3, mirrored += compute_uv_area(mesh, first, size) < 0;
        first += size;
    }
    if (triangles > mesh.face_sizes.size() / 2)
        add_warning(findings, "W-TRI",
                    "{} of {} faces of mesh '{}' are triangles: probably a triangulated export; export the "
                    "quads that the map was baked on",
                    triangles, mesh.face_sizes.size(), mesh.name);
    const bool is_tangent =
        map.type == DisplacementType::vector && map.space == DisplacementSpace::tangent && map.assumed.space;
    if (is_tangent && mirrored > 0)
        add_warning(findings, "W-MIRROR",
                    "tangent space is assumed, and the uvs of {} of {} faces of mesh '{}' are mirrored: the "
                    "map is mirrored there; write displacement.space = tangent if it was baked so",
                    mirrored, mesh.face_sizes.size(), mesh.name);
}

/// A set of tiles may serve several meshes, so that tiles without faces are a note.
void add_unused_tiles(const Displacement& map, const Scene& scene, const std::set<uint32_t>& meshes,
                      std::vector<Finding>& findings) {
    if (!map.is_udim) return;
    std::set<int> unused;
    for (const MapTile& tile : map.tiles) unused.insert(tile.udim);
    for (const uint32_t index : meshes)
        for (const int udim : find_tile_use(scene.meshes.at(index)).tiles) unused.erase(udim);
    if (!unused.empty())
        add_note(findings, "I-TILES",
                 "no face of its meshes uses {} of its {} tiles ({}): the map may belong to another mesh",
                 unused.size(), map.tiles.size(), fmt::join(unused, ", "));
}

/// What the values of the map say; the convention is tried on one of its meshes.
void check_values(const Displacement& map, const Mesh& mesh, std::vector<Finding>& findings) {
    const bool has_axes = map.type == DisplacementType::vector && map.space == DisplacementSpace::tangent;
    if (!has_axes && !map.assumed.midlevel) return;
    const Displacement thin = thin_out(map);
    const MapStatistics statistics = measure_map(thin.tiles, find_known_midlevel(map, MapMeaning::declared));
    if (map.assumed.midlevel) add_mistakes(thin, statistics, findings);
    if (!has_axes) return;
    const bool has_few = mesh.face_sizes.size() <= kMostFaces && find_mesh_faults(mesh).is_sound();
    add_convention(map, guess_convention(thin, statistics, has_few ? &mesh : nullptr), findings);
}

std::vector<Finding> check_map(const Displacement& map, const Scene& scene,
                               const std::set<uint32_t>& meshes) {
    std::vector<Finding> findings, of_values;
    if (!has_all_textures(map)) return findings;
    const auto check_meshes = [&] {
        size_t count = 0;
        for (const uint32_t index : meshes) {
            if (map.assumed == AssumedConvention{}) break;
            const Mesh& mesh = scene.meshes.at(index);
            add_range(map, mesh, findings);
            add_mesh_doubts(map, mesh, findings);
            if (++count <= kMostOverlapMeshes) add_overlap(map, mesh, findings);
        }
    };
    parallel_invoke(check_meshes, [&] { check_values(map, scene.meshes.at(*meshes.begin()), of_values); });
    std::ranges::move(of_values, std::back_inserter(findings));
    add_unused_tiles(map, scene, meshes, findings);
    return findings;
}

/// Lists the meshes that each displacement is on.
std::vector<std::set<uint32_t>> list_meshes(const Scene& scene) {
    std::vector<std::set<uint32_t>> meshes(scene.displacements.size());
    for (const Object& object : scene.objects)
        if (object.displacement != kNoIndex) meshes.at(object.displacement).insert(object.mesh);
    return meshes;
}

/// Adds the notes of readers about the pictures of a scene, each once.
void add_reading_notes(const Scene& scene, std::vector<Finding>& findings) {
    std::set<std::string> known;
    const auto add = [&](const std::shared_ptr<const Texture>& texture) {
        for (size_t k = 0; texture && k < texture->notes.size(); ++k)
            if (known.insert(texture->notes[k]).second) add_note(findings, "I-READ", "{}", texture->notes[k]);
    };
    for (const Displacement& map : scene.displacements)
        for (const MapTile& tile : map.tiles) add(tile.texture);
    for (const Material& material : scene.materials)
        visit_textures(material, [&](const char*, const auto& texture, MapFilter) { add(texture); });
    if (scene.environment) add(scene.environment->texture);
}

} // namespace

std::vector<Finding> find_doubtful_assumptions(const Scene& scene) {
    std::vector<Finding> findings;
    add_reading_notes(scene, findings);
    const std::vector<std::set<uint32_t>> meshes = list_meshes(scene);
    for (size_t index = 0; index < meshes.size(); ++index) {
        const Displacement& map = scene.displacements[index];
        if (meshes[index].empty()) continue;
        for (Finding& finding : check_map(map, scene, meshes[index])) {
            finding.text = fmt::format("displacement '{}': {}", map.name, finding.text);
            findings.push_back(std::move(finding));
        }
    }
    return findings;
}

} // namespace relief
