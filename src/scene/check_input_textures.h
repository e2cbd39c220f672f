// Checks of Material::textures.
#pragma once

#include <string>

#include "relief/scene.h"

namespace relief {

/// All but the sizes of the textures. Throws bad_input; `where` names the material.
void check_input_textures(const Material& material, const std::string& where);

} // namespace relief
