// What a mesh is and what stands in the way of displacing it.
#include <set>

#include <fmt/format.h>

#include "analysis/mesh_statistics.h"
#include "inspect/facts.h"
#include "math/box.h"
#include "relief/error.h"
#include "relief/inspect.h"
#include "scene/face_uvs.h"
#include "scene/uv_sets.h"
#include "surface/mesh/degenerate_faces.h"
#include "surface/mesh/polygons.h"

namespace relief {

namespace {

void find_faults(const MeshFaults& faults, std::vector<Finding>& findings) {
    if (faults.has_bad_counts)
        add_error(
            findings, "E-INDEX",
            "faces with fewer than three corners, or lists of different lengths; export the mesh again");
    if (faults.bad_indices > 0)
        add_error(findings, "E-INDEX", "{} indices are out of range; export the mesh again",
                  faults.bad_indices);
    if (faults.bad_position)
        add_error(findings, "E-NAN", "vertex {} is not finite; export the mesh again", *faults.bad_position);
    if (faults.bad_normal)
        add_error(findings, "E-NAN", "normal {} is not finite; export the mesh again", *faults.bad_normal);
    if (faults.bad_uv)
        add_error(findings, "E-NAN", "uv {} is not finite; unwrap the mesh again", *faults.bad_uv);
}

/// Adds the reason why a render would refuse the mesh, if there is one that find_faults() does not know.
void find_refusal(const Mesh& mesh, std::vector<Finding>& findings) {
    try {
        validate_mesh(mesh);
        make_polygons(mesh, Welding::none);
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::bad_input) throw;
        add_error(findings, "E-SCENE", "{}", error.what());
    }
}

void find_faces_without_area(const Mesh& mesh, std::vector<Finding>& findings) {
    const DegenerateFaces faces = find_degenerate_faces(mesh);
    if (faces.count == 0 || faces.count == mesh.face_sizes.size()) return;
    add_warning(findings, "W-AREA",
                "{} of {} faces have no area and are left out, the first is face {}: remove them, or merge "
                "their corners",
                faces.count, mesh.face_sizes.size(), faces.first);
}

void find_face_mistakes(const Mesh& mesh, const MeshShape& shape, std::vector<Finding>& findings) {
    if (shape.triangles > shape.faces() / 2)
        add_warning(findings, "W-TRI",
                    "{} of {} faces are triangles: probably a triangulated export, whose diagonals a "
                    "subdivision keeps; export quads (Blender: untick Triangulated Mesh)",
                    shape.triangles, shape.faces());
    if (shape.others > 0)
        add_warning(findings, "W-NGON",
                    "{} of {} faces have more than four corners: displaced, they are split into quads, which "
                    "a baker may have split otherwise; make them quads",
                    shape.others, shape.faces());
    const Subdivision& subdivision = mesh.subdivision;
    const bool is_by_view =
        subdivision.scheme == SubdivisionScheme::catmark && subdivision.level == kAutoSubdivisionLevel;
    if (shape.triangles + shape.others > 0 && !is_by_view)
        add_note(findings, "I-REFINE",
                 "{} of {} faces are not quads: displaced, the whole mesh is refined once to quads; plain, "
                 "n-gons are cut into triangles",
                 shape.triangles + shape.others, shape.faces());
}

void find_edge_mistakes(const MeshShape& shape, std::vector<Finding>& findings) {
    if (shape.near_edges.count > 0)
        add_warning(findings, "W-NEAR", "{}", describe_near_edges(shape.near_edges));
    if (shape.crowded_edges > 0)
        add_warning(findings, "W-NONMANIF",
                    "{} edges have more than two faces (one is of face {}): the surface has no two sides "
                    "there; remove inner or doubled faces",
                    shape.crowded_edges, *shape.crowded_face);
    if (shape.turned_edges > 0)
        add_warning(findings, "W-NONMANIF",
                    "{} edges are run the same way by both faces (one is face {}): normals point apart "
                    "there; make normals consistent",
                    shape.turned_edges, *shape.turned_face);
}

Fact describe_bounds(const Box& box) {
    return {"bounds",
            fmt::format("({:.6g}, {:.6g}, {:.6g}) to ({:.6g}, {:.6g}, {:.6g})", box.lower.x, box.lower.y,
                        box.lower.z, box.upper.x, box.upper.y, box.upper.z),
            {{"low_x", box.lower.x, "scene units"},
             {"low_y", box.lower.y, "scene units"},
             {"low_z", box.lower.z, "scene units"},
             {"high_x", box.upper.x, "scene units"},
             {"high_y", box.upper.y, "scene units"},
             {"high_z", box.upper.z, "scene units"}}};
}

std::string list_valences(const MeshShape& shape) {
    std::string text;
    for (size_t valence = 1; valence < shape.valences.size(); ++valence)
        if (shape.valences[valence] > 0)
            text += fmt::format("{}{} of {}", text.empty() ? "" : ", ", shape.valences[valence], valence);
    return text;
}

/// Points by the number of edges that meet there.
Fact describe_points(const MeshShape& shape) {
    Fact fact{"points", "by number of edges: " + list_valences(shape), {}};
    double count = 0;
    for (size_t valence = 1; valence < shape.valences.size(); ++valence) {
        if (shape.valences[valence] == 0) continue;
        count += double(shape.valences[valence]);
        fact.numbers.push_back(
            {fmt::format("of_{}_edges", valence), double(shape.valences[valence]), "count"});
    }
    fact.numbers.insert(fact.numbers.begin(), {"", count, "count"});
    return fact;
}

/// Points on edges that lay on each other.
Fact describe_joined(const JoinedPoints& joined) {
    Fact fact{"joined_points", "0", {{"", double(joined.moved_points), "count"}}};
    if (joined.moved_points == 0) return fact;
    fact.value = fmt::format("{} on {} edges that were open, within {:.3g} of each other",
                             joined.moved_points, joined.joined_edges, joined.farthest);
    fact.numbers.push_back({"edges", double(joined.joined_edges), "count"});
    fact.numbers.push_back({"farthest", double(joined.farthest), "scene units"});
    return fact;
}

std::string describe_tangents(const Mesh& mesh) {
    if (!mesh.tangents.empty()) return "in the file";
    return mesh.uvs.empty() ? "none: no uvs" : "made from uvs";
}

void describe_shape(const Mesh& mesh, const MeshShape& shape, Inspection& result) {
    Box box; // of the points that faces have
    for (const uint32_t point : mesh.position_indices) box.extend(mesh.positions[point]);
    result.facts.insert(result.facts.end(),
                        {make_count("vertices", mesh.positions.size()),
                         {"faces",
                          fmt::format("{}: {} quads, {} triangles, {} with more corners", shape.faces(),
                                      shape.quads, shape.triangles, shape.others),
                          {{"", double(shape.faces()), "count"},
                           {"quads", double(shape.quads), "count"},
                           {"triangles", double(shape.triangles), "count"},
                           {"others", double(shape.others), "count"}}},
                         describe_points(shape),
                         make_count("open_edges", shape.open_edges),
                         describe_joined(shape.joined),
                         describe_bounds(box),
                         {"base", describe_base(mesh), {}},
                         {"normals", mesh.normal_indices.empty() ? "none" : "in the file", {}},
                         {"tangents", describe_tangents(mesh), {}}});
}

void add_frame(const Mesh& mesh, const Displacement& map, Inspection& result) {
    if (std::string frame = describe_frame(map, &mesh); !frame.empty())
        result.facts.push_back({"frame", std::move(frame), {}});
    const bool uses_frames = map.type == DisplacementType::height || map.space == DisplacementSpace::tangent;
    if (map.frame != FrameKind::file || !uses_frames) return;
    if (mesh.normal_indices.empty())
        add_error(result.findings, "E-NONORM",
                  "no normals, and the frame of its map is that of the file; export the mesh with normals, "
                  "or say frame mikk");
    if (mesh.subdivision.scheme != SubdivisionScheme::none)
        add_error(result.findings, "E-NONORM",
                  "subdivided, which leaves the normals of the file behind; say frame mikk, or scheme none");
}

/// Tiles in runs: "1001-1004, 1011".
std::string list_tiles(const std::set<int>& tiles) {
    std::string text;
    for (auto it = tiles.begin(); it != tiles.end();) {
        const int first = *it;
        int last = first;
        for (++it; it != tiles.end() && *it == last + 1; ++it) ++last;
        if (!text.empty()) text += ", ";
        text += first == last ? fmt::format("{}", first) : fmt::format("{}-{}", first, last);
    }
    return text;
}

/// Where there are several.
void add_uv_sets(const Mesh& mesh, Inspection& result) {
    if (mesh.further_uvs.empty()) return;
    const size_t count = mesh.further_uvs.size() + (mesh.uv_indices.empty() ? 0 : 1);
    result.facts.push_back({"uv_sets", describe_uv_sets(mesh), {{"", double(count), "count"}}});
}

void describe_uvs(const MeshUvs& uvs, const Displacement* map, Inspection& result) {
    result.facts.push_back(
        {"uv_range",
         fmt::format("u {:.6g} to {:.6g}, v {:.6g} to {:.6g}", uvs.low.x, uvs.high.x, uvs.low.y, uvs.high.y),
         {{"low_u", uvs.low.x, "uv"},
          {"high_u", uvs.high.x, "uv"},
          {"low_v", uvs.low.y, "uv"},
          {"high_v", uvs.high.y, "uv"}}});
    result.facts.push_back(
        {"uv_islands",
         fmt::format("{}, {} of them mirrored", uvs.islands, uvs.mirrored_islands),
         {{"", double(uvs.islands), "count"}, {"mirrored", double(uvs.mirrored_islands), "count"}}});
    result.facts.push_back({"uv_overlap",
                            fmt::format("{:.2f} % of the covered area", 100 * uvs.overlap),
                            {{"", 100 * uvs.overlap, "%"}}});
    result.facts.push_back({"uv_tiles",
                            uvs.tile_use.tiles.empty() ? "none" : list_tiles(uvs.tile_use.tiles),
                            {{"", double(uvs.tile_use.tiles.size()), "count"}}});
    if (!map || !map->is_udim) return;
    std::set<int> found;
    for (const MapTile& tile : map->tiles) found.insert(tile.udim);
    result.facts.push_back({"map_tiles", list_tiles(found), {{"", double(found.size()), "count"}}});
}

void find_missing_tiles(const MeshUvs& uvs, const Displacement& map, std::vector<Finding>& findings) {
    const std::set<int> missing = find_missing_tiles(uvs.tile_use.tiles, map.tiles);
    if (missing.empty()) return;
    std::set<int> found;
    for (const MapTile& tile : map.tiles) found.insert(tile.udim);
    add_warning(findings, "W-GAP",
                "no file for tile(s) {} of the mesh, which will not be displaced there; found {}; export the "
                "missing ones, or look at their names",
                list_tiles(missing), list_tiles(found));
}

/// Uvs outside of the unit square need tiles or a map that repeats.
void find_range_mistakes(const MeshUvs& uvs, const Displacement* map, std::vector<Finding>& findings) {
    const bool has_tiles = map && map->is_udim;
    const bool is_repeated = map && (map->wrap == WrapMode::repeat || map->wrap == WrapMode::mirror);
    const bool is_outside = uvs.low.x < 0 || uvs.low.y < 0 || uvs.high.x > 1 || uvs.high.y > 1;
    if (has_tiles)
        for (const std::string& text : describe_misplaced_faces(uvs.tile_use))
            add_warning(findings, "W-UVRANGE", "{}", text);
    if (has_tiles || is_repeated || !is_outside) return;
    if (!map && uvs.tile_use.crossing == 0 && uvs.tile_use.outside == 0) {
        add_note(findings, "I-UDIM", "uvs fill the tiles {}: name the map with <UDIM>",
                 list_tiles(uvs.tile_use.tiles));
        return;
    }
    add_warning(findings, "W-UVRANGE",
                "uvs leave the unit square: the map needs <UDIM> tiles or wrap repeat");
}

void find_uv_mistakes(const MeshUvs& uvs, const Displacement* map, std::vector<Finding>& findings) {
    find_range_mistakes(uvs, map, findings);
    if (map && map->is_udim) find_missing_tiles(uvs, *map, findings);
    if (uvs.overlap > kMuchOverlap)
        add_warning(findings, "W-UVOVER",
                    "faces share {:.1f} % of the uv area: what is sculpted on one shows on the others; lay "
                    "the islands apart unless this is meant",
                    100 * uvs.overlap);
    const bool uses_frames =
        !map || map->type == DisplacementType::height || map->space == DisplacementSpace::tangent;
    if (uvs.mirrored_islands > 0 && uses_frames)
        add_warning(
            findings, "W-MIRROR",
            "{} of {} uv islands are mirrored ({} faces): their bitangent is turned, so that a tangent-space "
            "map is mirrored there; bake and render with the same tangents, or use object space",
            uvs.mirrored_islands, uvs.islands, uvs.mirrored_faces);
    if (uvs.flat_faces > 0)
        add_note(findings, "I-UVFLAT", "{} faces have no area in uv: one texel displaces all of each",
                 uvs.flat_faces);
}

} // namespace

Inspection inspect_mesh(const Mesh& mesh, const Displacement* displacement) {
    Inspection result;
    const MeshFaults faults = find_mesh_faults(mesh);
    find_faults(faults, result.findings);
    if (!faults.is_sound()) {
        result.facts = {make_count("vertices", mesh.positions.size()),
                        make_count("faces", mesh.face_sizes.size())};
        return result;
    }
    find_refusal(mesh, result.findings);
    find_faces_without_area(mesh, result.findings);
    const MeshShape shape = measure_shape(mesh);
    describe_shape(mesh, shape, result);
    if (displacement) add_frame(mesh, *displacement, result);
    if (mesh.uv_indices.empty()) {
        if (displacement)
            add_error(result.findings, "E-NOUV",
                      "no uvs, and the map cannot be laid onto it; unwrap the mesh, or export it with uvs "
                      "(many exporters leave them out unless told)");
        else
            add_warning(result.findings, "W-NOUV",
                        "no uvs: the mesh cannot be displaced by a map; export it with uvs");
    } else {
        if (const FacesWithoutUvs missing = find_faces_without_uvs(mesh); missing.count > 0)
            add_warning(result.findings, "W-NOUV",
                        "{} of {} faces have no uvs and are not displaced, the first is face {}: unwrap them "
                        "too, or export them with uvs",
                        missing.count, mesh.face_sizes.size(), missing.first);
        const MeshUvs uvs = measure_uvs(mesh);
        describe_uvs(uvs, displacement, result);
        find_uv_mistakes(uvs, displacement, result.findings);
    }
    add_uv_sets(mesh, result);
    find_face_mistakes(mesh, shape, result.findings);
    find_edge_mistakes(shape, result.findings);
    return result;
}

} // namespace relief
