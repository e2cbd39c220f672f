// Files of other programs that Relief does not read, and how to export them: the one table of them.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace relief {

/// An error in two parts, as relief::Error takes them.
struct ForeignFile {
    std::string message; ///< "a Blender file is not read: export OBJ, PLY or glTF"
    std::string hint;    ///< "Blender: File > Export > Wavefront (.obj)"
};

/// What a file name's extension says; nothing where no other program's own format is known by it.
std::optional<ForeignFile> find_foreign_file(std::string_view name);

/// The same for a required extension of glTF that stands in the way of reading the mesh.
std::optional<ForeignFile> find_foreign_gltf(std::string_view extension);

} // namespace relief
