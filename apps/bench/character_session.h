// A session of the library with a character: pictures after a turned camera, a moved object, a changed map.
#pragma once

#include "bench/character_inputs.h"
#include "bench/character_programs.h"

namespace relief::bench {

inline constexpr float kSessionTurnDegrees = 15; ///< of the camera, about what it looks at

/// In this process: {first_s, turned_s, moved_s, changed_s}; the first from the scene in memory, the last
/// with the reading of the map, and missing where the object has none.
Measures run_character_session(const CharacterInput& input, const CharacterTask& task);

} // namespace relief::bench
