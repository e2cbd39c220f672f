// Compressed meshes of glTF: Draco and meshopt, where this build has their libraries.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/scene/json_node.h"

namespace relief {

/// Whether this is an extension that compresses meshes, and this build has its library.
bool can_decompress_gltf(std::string_view extension);

/// A mesh that Draco has decoded.
class DracoMesh {
  public:
    /// Throws bad_input at `place` for bytes that are no mesh of Draco, and where this build lacks the
    /// library.
    DracoMesh(std::string_view bytes, const JsonNode& place);
    ~DracoMesh();
    DracoMesh(DracoMesh&&) noexcept;

    size_t vertex_count() const;
    std::vector<uint32_t> list_corners() const; ///< three per triangle
    /// Values of an attribute by its unique id, `width` per vertex. Integers become floats as they are, or
    /// parts of `largest` where that is given. Throws bad_input at `place` where there is no such attribute.
    std::vector<float> read_floats(uint32_t id, size_t width, std::optional<float> largest,
                                   const JsonNode& place) const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

/// The bytes of a bufferView that EXT_meshopt_compression describes. Throws bad_input at `extension` for
/// damaged ones, and where this build lacks the library.
std::string decode_meshopt(std::string_view bytes, const JsonNode& extension);

} // namespace relief
