// Names of the instances of a scene, for the Cryptomatte layers.
#pragma once

#include <memory>

#include "film/film.h"
#include "relief/scene.h"

namespace relief {

/// Null unless one of the layers is of Cryptomatte. An object without a name goes by that of its mesh, and
/// one without a material by "default"; instances of one name are one matte.
std::shared_ptr<const InstanceMattes> make_instance_mattes(const Scene& scene,
                                                           const std::vector<std::string>& layers);

} // namespace relief
