// Diagnostics: properties of a scene, mesh or map, its cost, and what is wrong with it. docs/inspect.md lists
// the codes of all findings. All functions are thread safe.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "relief/image.h"
#include "relief/progress.h"
#include "relief/render.h"
#include "relief/scene.h"

namespace relief {

enum class Severity { note, warning, error };

struct Finding {
    Severity severity = Severity::note;
    std::string code; ///< stable, e.g. "W-8BIT"
    std::string text; ///< message, with the remedy
};

/// A number that the text of a fact is made of.
struct FactNumber {
    std::string part; ///< stable key of one of several, e.g. "mirrored"; empty: what the fact is named after
    double value = 0; ///< may be NaN or infinite where texels are
    std::string unit; ///< one of those that docs/inspect.schema.json lists
};

struct Fact {
    std::string name;                     ///< stable key, e.g. "patches"
    std::string value;                    ///< formatted, with its unit
    std::vector<FactNumber> numbers = {}; ///< empty where the fact is words only
};

struct Inspection {
    std::vector<Fact> facts;
    std::vector<Finding> findings;
};

/// Memory of a scene whose displaced patches are all pre-tessellated into micro-quads: the baseline for
/// direct ray tracing.
struct TessellationCost {
    uint64_t micro_quads = 0;
    uint64_t geometry_bytes = 0;   ///< exact
    uint64_t structures_bytes = 0; ///< estimated from measured trees, within 10 %
    uint64_t peak_bytes = 0;       ///< peak while the displaced surfaces are built; a render reserves as much
};

/// Cost at the levels of `settings`, computed without tessellating. Throws Error{bad_input}.
TessellationCost estimate_tessellation(const Scene& scene, const RenderSettings& settings);

/// Counts, bytes, the estimated render time with `settings` (measured on a few windows of the picture), and
/// the findings of all meshes and maps. Throws as render().
Inspection inspect_scene(const Scene& scene, const RenderSettings& settings,
                         const ProgressFunction& on_progress = {});

/// Checks faces, edges and uvs; with its displacement also whether the two match: UDIM tiles, texel density,
/// uv range.
Inspection inspect_mesh(const Mesh& mesh, const Displacement* displacement = nullptr);

/// Warnings about open edges of the displaced and subdivided meshes of a scene that nearly lie on each other
/// and are not joined (Mesh::weld). render() warns of them by itself. Indices of objects must be valid.
std::vector<std::string> find_edge_warnings(const Scene& scene);

/// Whether the convention of a Displacement (all but its tiles) was stated by the user or consists of
/// defaults.
enum class MapMeaning { declared, unknown };

/// Statistics of a map's texels, its probable convention and the reasons, and common mistakes. With the mesh
/// that the map belongs to, tangent and object space can be distinguished and lengths compared with its size.
/// Non-finite values are reported as findings, not as errors.
Inspection inspect_map(const Displacement& map, MapMeaning meaning, const Mesh* mesh = nullptr,
                       const ProgressFunction& on_progress = {});

/// The same map with the most probable space, axes and midlevel; what cannot be determined is unchanged. In
/// tangent space the values do not show t from b: these two may be turned by quarters.
Displacement guess_map_meaning(const Displacement& map, const Mesh* mesh = nullptr);

/// What speaks against the assumptions about the maps of a scene (Displacement::assumed): warnings; and a
/// note where the values of a map clearly speak against axes that were declared, or where a map has tiles
/// under no face of its meshes. Each finding names the setting that mends it, "displacement.axes". At most
/// 2^18 texels a map are looked at. Seams are left to find_seam_warnings. The scene must be valid.
std::vector<Finding> find_doubtful_assumptions(const Scene& scene);

/// Returns warnings about maps that are read as tangent space while the seams of their meshes speak for
/// object space. It prepares the surfaces of the scene; render() warns of them by itself. Throws as render().
std::vector<std::string> find_seam_warnings(const Scene& scene);

/// Warnings about the UDIM tiles of the maps of a scene: files that are missing for a mesh, faces across
/// tiles or outside of all of them. render() warns of them by itself. Indices of objects must be valid.
std::vector<std::string> find_tile_warnings(const Scene& scene);

/// Contact sheet of a scene seen by its camera, four pictures of `settings.image.width` x
/// `settings.image.height` each: the base (with the displacement axes as red, green and blue arrows), the
/// displaced surface, the displacement as colours (red, green, blue along t, b, n or x, y, z; grey is zero),
/// and folds: where the surface faces away from its base, in red. Captions say so. Values are meant for a
/// tone-mapped file. Throws as render().
Image make_check_picture(const Scene& scene, const RenderSettings& settings,
                         const ProgressFunction& on_progress = {});

} // namespace relief
