// Scenes of the kind that characters are: subdivision surfaces of thousands of quads with vector displacement
// maps in object space, made from formulas and seeds.
#pragma once

#include <string>
#include <vector>

#include "relief/scene.h"

namespace relief {

/// full: the counts below; reduced: a sixteenth of them and small maps, to show that all works.
enum class CharacterDetail { full, reduced };

/// body: 12,992 quads with points of valence 3 and 5, creases and 25 uv islands on one map of 1024 x 1024
/// texels. head: 21,600 quads on four UDIM tiles of 512 x 512. crowd: 20 objects that share the mesh of
/// `body`, each with a map of its own of 512 x 512.
std::vector<std::string> character_scene_names();

/// A Catmull-Clark surface, white and diffuse, lit by a sky alone. Throws Error{usage} for an unknown name.
Scene make_character_scene(const std::string& name, CharacterDetail detail);

/// The sky and the white material of these scenes.
Environment make_character_sky();
Material make_character_material();

} // namespace relief
