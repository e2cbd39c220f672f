// What lies between two frames: textures and meshes, linearly.
#pragma once

#include <memory>

#include "relief/image.h"
#include "relief/scene.h"

namespace relief {

/// (1 - weight) a + weight b of all values, in float. Two textures of halves make one of halves: it is as
/// exact as its files, takes no more memory than they do, and has one form at all times. Throws bad_input
/// where size, channels or kind of samples differ.
std::shared_ptr<const Texture> blend_textures(const Texture& a, const Texture& b, double weight);

/// The same of positions, uvs of all sets, normals and tangents; the rest is that of `a`. Normals may be
/// indexed in another way in each, as exporters merge those that are equal. Throws bad_input where the faces
/// or what belongs to them differ.
Mesh blend_meshes(const Mesh& a, const Mesh& b, double weight);

} // namespace relief
