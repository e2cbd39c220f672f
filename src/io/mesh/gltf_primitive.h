// One part of a glTF mesh: its vertices, and its faces as polygons.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "io/mesh/gltf_file.h"
#include "relief/error.h"

namespace relief {

inline constexpr const char* kDamagedHint = "the file is damaged: export it again";

struct GltfPrimitive {
    // Values of the vertices one after another, kept by the file; empty where the part has none of the kind.
    std::span<const float> positions, normals;       ///< 3 a vertex
    std::span<const float> uvs;                      ///< 2 a vertex, v downwards
    std::vector<std::span<const float>> further_uvs; ///< the same of each further set that is asked for
    std::span<const float> tangents;                 ///< 4 a vertex
    /// What a morph target adds to each vertex, 3 numbers a vertex; empty where it adds nothing.
    struct Target {
        std::span<const float> positions, normals, tangents;
    };
    std::vector<Target> targets;
    std::vector<uint32_t> face_sizes, corners;
    size_t uv_set_count = 0; ///< TEXCOORD_0 and so on that the part has
};

/// Counts the parts that are read without an attribute that is damaged.
class GltfLosses {
  public:
    void add(const std::string& attribute, const JsonNode& primitive, const Error& error);
    /// One warning per attribute, with its first part.
    std::vector<std::string> list_warnings(const std::string& file) const;

  private:
    struct Loss {
        size_t parts = 0;
        std::string first, last;    ///< parts
        std::string where, message; ///< of the first
    };
    std::map<std::string, Loss> losses_; ///< by attribute
};

/// Points and lines have no faces; targets are left out. `further_sets`: numbers of uv sets. Normals,
/// tangents and uvs that cannot be read are left out, and added to `losses`. Throws bad_input.
GltfPrimitive read_gltf_primitive(GltfFile& file, const JsonNode& primitive, int uv_set,
                                  std::span<const int> further_sets, GltfLosses& losses);

/// Adds the morph targets to a part; normals and tangents of targets as above. Throws bad_input.
void read_gltf_targets(GltfFile& file, const JsonNode& primitive, GltfPrimitive& part, GltfLosses& losses);

/// A part with its morph targets added, by a weight each; what the weights leave out adds nothing.
class MorphedPrimitive {
  public:
    MorphedPrimitive(const GltfPrimitive& part, const std::vector<float>& weights);
    MorphedPrimitive(const MorphedPrimitive&) = delete;
    MorphedPrimitive& operator=(const MorphedPrimitive&) = delete;

    const GltfPrimitive& get() const { return part_; }

  private:
    GltfPrimitive part_;
    std::vector<float> positions_, normals_, tangents_;
};

} // namespace relief
