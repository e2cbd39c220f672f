// The records of an FBX file, binary or text: changed here and there, then written anew as bytes.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace relief {

/// A value is kept as the file has it: in binary files its type and its bytes, little-endian; in text files
/// its characters. Arrays of text files are one value, the list between their braces.
struct FbxRecord {
    std::string_view name;
    std::vector<std::string_view> values;
    std::vector<FbxRecord> children;
    bool has_scope = false; ///< braces, also empty ones

    const FbxRecord* find(std::string_view child) const;
    FbxRecord* find(std::string_view child);
};

/// Refers to the bytes it was parsed from, which must outlive it.
class FbxDocument {
  public:
    /// Returns nothing if the records cannot be followed to their end.
    static std::optional<FbxDocument> parse(std::string_view bytes);

    FbxRecord& root() { return root_; }
    const FbxRecord& root() const { return root_; }

    /// Returns the version that `FBXVersion` or the head of a binary file states: 7400 for 7.4.
    uint32_t get_version() const;

    /// Return a text without quotes, or a name without its class, such as 'Cube' of "Model::Cube". Other
    /// values give an empty text.
    std::string_view read_text(std::string_view value) const;
    std::string_view read_name(std::string_view value) const;
    std::optional<double> read_number(std::string_view value) const;
    std::optional<int64_t> read_id(std::string_view value) const;

    /// The numbers of an array, narrowed as the importer of text files narrows them. Empty where it cannot be
    /// read.
    std::vector<float> read_floats(const FbxRecord& array) const;
    std::vector<int64_t> read_integers(const FbxRecord& array) const;

    /// Replaces a number by 0, of the same type.
    void clear_number(std::string_view& value);
    /// Replaces an array, or adds it.
    void set_floats(FbxRecord& parent, std::string_view array, std::span<const float> values);
    /// Replaces the name in front of the class.
    void rename(std::string_view& value, const std::string& name);

    /// A whole file: text, or binary and little-endian.
    std::string write() const;

  private:
    friend class FbxBinaryParser;
    friend class FbxTextParser;

    std::string_view keep(std::string bytes) { return kept_.emplace_back(std::move(bytes)); }

    bool is_binary_ = false;
    uint32_t head_version_ = 0; ///< of binary files
    FbxRecord root_;
    std::deque<std::string> kept_; ///< values that are not in the file
};

inline constexpr int kMostFbxNesting = 64;
inline constexpr std::string_view kFbxMagic = "Kaydara FBX Binary";

/// The bytes of an array of a binary file; nothing where they are damaged.
std::optional<std::string> inflate_fbx_array(std::string_view value);

std::string pack_fbx_floats(std::span<const float> values);

/// Parse the records into `document`. False where they do not hold together.
bool parse_fbx_binary(std::string_view bytes, FbxDocument& document);
bool parse_fbx_text(std::string_view bytes, FbxDocument& document);

std::string write_fbx_binary(const FbxRecord& root);
std::string write_fbx_text(const FbxRecord& root);

} // namespace relief
