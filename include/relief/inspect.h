// What a scene, a mesh or a map is, what it will cost, and what is wrong with it. docs/inspect.md lists the
// codes of what can be found.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "relief/image.h"
#include "relief/render.h"
#include "relief/scene.h"

namespace relief {

enum class Severity { note, warning, error };

struct Finding {
    Severity severity = Severity::note;
    std::string code; ///< stable, e.g. "W-8BIT"
    std::string text; ///< with the remedy
};

struct Fact {
    std::string name;  ///< stable key, e.g. "patches"
    std::string value; ///< with its unit
};

struct Inspection {
    std::vector<Fact> facts;
    std::vector<Finding> findings;
};

/// What a scene would hold with every displaced patch cut into micro-quads up front: the baseline of direct
/// tracing.
struct TessellationCost {
    uint64_t micro_quads = 0;
    uint64_t geometry_bytes = 0;   ///< exact
    uint64_t structures_bytes = 0; ///< from the size of such trees elsewhere: within a tenth
    uint64_t peak_bytes = 0;       ///< of the displaced surfaces while they are made, what a render asks for
};

/// Cost at the levels of `settings`; nothing is tessellated. Throws Error (bad_input).
TessellationCost estimate_tessellation(const Scene& scene, const RenderSettings& settings);

/// Counts, bytes, the time that a render of `settings` would take (measured on a few windows of the picture),
/// and the mistakes of all meshes and maps.
Inspection inspect_scene(const Scene& scene, const RenderSettings& settings);

/// Faces, edges, uvs. With the displacement that is meant for it also what of the two does not fit: tiles,
/// density, range of uvs.
Inspection inspect_mesh(const Mesh& mesh, const Displacement* displacement = nullptr);

/// Whether the values of a Displacement beside its tiles are what somebody said, or only defaults.
enum class MapMeaning { declared, unknown };

/// What the texels of a map are, how they are probably meant and why, and which of the usual mistakes they
/// show. With the mesh that the map is for, tangent and object space can be told apart, and lengths be
/// compared with its size. Values that are not finite are found, not refused.
Inspection inspect_map(const Displacement& map, MapMeaning meaning, const Mesh* mesh = nullptr);

/// The same map with space, axes and midlevel as they are probably meant; what cannot be told stays as it is.
Displacement guess_map_meaning(const Displacement& map, const Mesh* mesh = nullptr);

/// Contact sheet of a scene, seen by its camera, four pictures of `settings.width` x `settings.height` each:
/// the base (with the axes of its displacement as arrows, red, green and blue), displaced, displacement as
/// colours (red, green, blue along t, b, n or x, y, z; grey is none), and folds: where the surface faces away
/// from its base, in red. Values are for a tone-mapped file. Throws as render().
Image make_check_picture(const Scene& scene, const RenderSettings& settings);

} // namespace relief
