// Triangle meshes of the sizes that papers on structures measure, made from nothing but formulas and a seed.
#pragma once

#include <string>
#include <vector>

#include "relief/scene.h"

namespace relief {

/// full: about the counts below; reduced: at most a hundredth of them, to show that all works.
enum class MeshDetail { full, reduced };

/// body (70 thousand triangles, one closed bumpy body, as the Stanford bunny), hall (280 thousand, huge and
/// tiny ones together, as Crytek Sponza), knot (2.1 million, as the Welsh dragon).
std::vector<std::string> structure_scene_names();

/// One mesh of triangles under one sun, with a camera. Throws Error{usage} for an unknown name.
Scene make_structure_scene(const std::string& name, MeshDetail detail);

} // namespace relief
