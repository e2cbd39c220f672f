// What a mesh is and what stands in the way of displacing it.
#include <algorithm>

#include <fmt/format.h>

#include "math/box.h"
#include "relief/inspect.h"

namespace relief {

namespace {

struct FaceCounts {
    size_t triangles = 0, quads = 0, others = 0;
    size_t all() const { return triangles + quads + others; }
};

FaceCounts count_faces(const Mesh& mesh) {
    FaceCounts counts;
    for (const uint32_t size : mesh.face_sizes) {
        if (size == 3)
            ++counts.triangles;
        else if (size == 4)
            ++counts.quads;
        else
            ++counts.others;
    }
    return counts;
}

size_t count_out_of_range(const std::vector<uint32_t>& indices, size_t size) {
    return size_t(
        std::count_if(indices.begin(), indices.end(), [size](uint32_t index) { return index >= size; }));
}

void describe_uvs(const Mesh& mesh, Inspection& result) {
    if (mesh.uv_indices.empty()) {
        result.findings.push_back({Severity::warning, "W-NOUV",
                                   "no uvs: the mesh cannot be displaced by a map; export it with uvs"});
        return;
    }
    Box box;
    for (const Vec2f& uv : mesh.uvs) box.extend(Vec3f{uv.x, uv.y, 0});
    result.facts.push_back({"uv_range", fmt::format("u {:.6g} to {:.6g}, v {:.6g} to {:.6g}", box.lower.x,
                                                    box.upper.x, box.lower.y, box.upper.y)});
    if (box.lower.x < 0 || box.lower.y < 0 || box.upper.x > 1 || box.upper.y > 1)
        result.findings.push_back({Severity::warning, "W-UVRANGE",
                                   "uvs leave the unit square: the map needs <UDIM> tiles or wrap 'repeat'"});
}

void find_face_mistakes(const FaceCounts& faces, std::vector<Finding>& findings) {
    if (faces.triangles > faces.all() / 2)
        findings.push_back(
            {Severity::warning, "W-TRI",
             fmt::format("{} of {} faces are triangles: probably a triangulated export; export quads",
                         faces.triangles, faces.all())});
    if (faces.triangles + faces.others > 0)
        findings.push_back(
            {Severity::note, "I-REFINE",
             fmt::format("{} of {} faces are not quads: displaced, the whole mesh is refined once to "
                         "quads; plain, n-gons are cut into triangles",
                         faces.triangles + faces.others, faces.all())});
}

void find_bad_values(const Mesh& mesh, std::vector<Finding>& findings) {
    const size_t bad_indices = count_out_of_range(mesh.position_indices, mesh.positions.size()) +
                               count_out_of_range(mesh.uv_indices, mesh.uvs.size()) +
                               count_out_of_range(mesh.normal_indices, mesh.normals.size());
    if (bad_indices > 0)
        findings.push_back({Severity::error, "E-INDEX",
                            fmt::format("{} indices are out of range; export the mesh again", bad_indices)});
    const auto bad = std::find_if_not(mesh.positions.begin(), mesh.positions.end(), is_finite);
    if (bad != mesh.positions.end())
        findings.push_back(
            {Severity::error, "E-NAN",
             fmt::format("vertex {} is not finite; export the mesh again", bad - mesh.positions.begin())});
}

} // namespace

Inspection inspect_mesh(const Mesh& mesh) {
    const FaceCounts faces = count_faces(mesh);
    Box box;
    for (const Vec3f& position : mesh.positions) box.extend(position);
    Inspection result;
    result.facts = {
        {"vertices", fmt::format("{}", mesh.positions.size())},
        {"faces", fmt::format("{}: {} quads, {} triangles, {} with more corners", faces.all(), faces.quads,
                              faces.triangles, faces.others)},
        {"bounds", fmt::format("({:.6g}, {:.6g}, {:.6g}) to ({:.6g}, {:.6g}, {:.6g})", box.lower.x,
                               box.lower.y, box.lower.z, box.upper.x, box.upper.y, box.upper.z)},
        {"normals", mesh.normal_indices.empty() ? "none" : "in the file"}};
    describe_uvs(mesh, result);
    find_bad_values(mesh, result.findings);
    find_face_mistakes(faces, result.findings);
    return result;
}

} // namespace relief
