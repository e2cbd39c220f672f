// Looking up textures of materials.
#pragma once

#include <memory>

#include "relief/scene.h"

namespace relief::test {

/// The first tile of the texture of an input; null: the input has none.
inline std::shared_ptr<const Texture> get_texture(const Material& material, MaterialInput input) {
    const InputTexture* found = find_input_texture(material, input);
    return found ? found->tiles.at(0).texture : nullptr;
}

/// That of a texture that is there.
inline MapFilter get_filter(const Material& material, MaterialInput input) {
    return find_input_texture(material, input)->filter;
}

} // namespace relief::test
