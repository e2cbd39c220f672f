// Points where parts of a surface touch that share no edge there.
#pragma once

#include <cstdint>
#include <vector>

#include "relief/scene.h"

namespace relief {

/// Takes points apart again that were joined and whose faces share no edge about them, neither directly nor
/// by faces between: such parts are smooth each on its own, and no limit surface has both. `representatives`
/// are those of join_points(); points that are one in the file stay one. The indices of the mesh must be
/// valid.
void split_pinched_points(const Mesh& mesh, std::vector<uint32_t>& representatives);

} // namespace relief
