// Refuses subdivisions that the machine cannot hold.
#pragma once

#include <cstdint>
#include <string>

namespace relief {

/// Throws out_of_memory if `count` patches are too many, or need more memory than there is. `what` makes
/// them; `where` names file and mesh.
void check_patch_count(uint64_t count, const std::string& where, const std::string& what);

} // namespace relief
