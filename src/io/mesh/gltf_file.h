// The container of glTF 2.0, text or GLB: its JSON, its buffers, and the numbers of its accessors.
#pragma once

#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/scene/json_node.h"

namespace relief {

/// Returns the bytes of a file that lies in the folder of the glTF file or below, by its relative path.
using ReadBeside = std::function<std::string(const std::string& path)>;

/// All functions throw bad_input with file and place. Nothing outside of its buffers is read.
class GltfFile {
  public:
    /// `bytes` and `name`, which is for messages, must outlive it. Buffers are read when they are requested.
    GltfFile(std::string_view bytes, const std::string& name, ReadBeside read_beside);
    GltfFile(const GltfFile&) = delete;
    GltfFile& operator=(const GltfFile&) = delete;

    const std::string& name() const { return name_; }
    JsonNode root() const { return JsonNode(document_, "", name_); }
    /// Elements of an array of the root; empty where it has none.
    std::vector<JsonNode> list(std::string_view key) const;
    /// The element of a list that an index stands for.
    static const JsonNode& resolve(const JsonNode& index, const std::vector<JsonNode>& list,
                                   const char* what);

    /// Values of an accessor, `width` a vertex, integers scaled to [0, 1] or [-1, 1] where it says so.
    /// They live as long as the file: many parts may share them.
    std::span<const float> read_floats(const JsonNode& accessor_index, size_t width);
    std::vector<uint32_t> read_indices(const JsonNode& accessor_index);
    /// Returns the largest integer of an accessor whose integers are parts of it; nothing for other
    /// accessors.
    std::optional<float> find_largest(const JsonNode& accessor_index) const;
    /// Whether the values of an accessor are integers that mean themselves, not parts of the largest one.
    bool has_whole_numbers(const JsonNode& accessor_index) const;
    /// The bytes of a bufferView, decompressed.
    std::string_view read_view(const JsonNode& view_index);
    /// Values that live as long as the file.
    std::span<const float> keep(std::vector<float> values);

  private:
    struct Values;
    Values find_values(const JsonNode& accessor, size_t width);
    /// Finds the values whose view and offset `place` names.
    Values locate(const JsonNode& place, const JsonNode& component_type, size_t count, size_t width);
    static std::vector<float> load_floats(const Values& values);
    static std::vector<uint32_t> load_indices(const Values& values, const JsonNode& place);
    void apply_sparse(const JsonNode& accessor, const JsonNode& sparse, size_t width,
                      std::vector<float>& floats);
    std::string_view find_view(const JsonNode& view);
    std::string_view find_bytes(const JsonNode& place);
    std::string_view find_buffer(const JsonNode& index);
    std::string load_buffer(const JsonNode& buffer) const;
    void open_glb(std::string_view bytes);

    const std::string& name_;
    ReadBeside read_beside_;
    Json document_;
    std::string_view text_, glb_buffer_;
    bool has_glb_buffer_ = false;
    std::vector<JsonNode> accessors_, views_, buffers_;
    std::map<const JsonNode*, std::string> loaded_;        ///< bytes of buffers that are not in the GLB file
    std::map<const JsonNode*, std::vector<float>> floats_; ///< of accessors that were read
    std::map<const JsonNode*, std::string> decompressed_;  ///< bufferViews
    std::deque<std::vector<float>> kept_;
};

} // namespace relief
