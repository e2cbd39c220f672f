// Damage to parts of a mesh that nothing needs: it makes no file unreadable.
#pragma once

#include <string>
#include <vector>

#include "relief/scene.h"

namespace relief {

/// Makes normals anew that are not finite or have no length, from the faces around their points; takes the
/// uvs of faces away that are not finite; and moves positions of no face that are not finite or farther out
/// than a scene reaches. All that was changed is added to `warnings`, after `name`. The indices of the mesh
/// must be valid.
void mend_mesh(Mesh& mesh, const std::string& name, std::vector<std::string>& warnings);

} // namespace relief
