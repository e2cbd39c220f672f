// Objects of an FBX document by their ids, with properties and connections.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "io/mesh/fbx_document.h"

namespace relief {

inline constexpr size_t kFirstFbxValue = 4; ///< of a property, behind its name, types and flags

struct FbxObject {
    int64_t id = 0;
    FbxRecord* record = nullptr;
    std::string_view name, kind; ///< the last: "Mesh", "Shape", "Cluster" ...
};

/// Refers to the document, whose records must stay where they are.
class FbxObjects {
  public:
    explicit FbxObjects(FbxDocument& document);

    /// Lists the objects of records with this name, in the order of the file.
    const std::vector<FbxObject>& list(std::string_view record) const;

    /// List objects that `list(record)` has and that are connected, in the order of their connections.
    std::vector<const FbxObject*> list_sources(std::string_view record, int64_t destination) const;
    std::vector<const FbxObject*> list_destinations(std::string_view record, int64_t source) const;

    /// The first number of a property: of the object, or of the template of its records.
    std::optional<double> find_number(const FbxObject& object, std::string_view property) const;

    /// The values of a property of the object itself; null where it has none.
    std::vector<std::string_view>* find_values(const FbxObject& object, std::string_view property) const;

  private:
    std::vector<std::string_view>* find_values(FbxRecord& owner, std::string_view property) const;
    void add_objects(FbxRecord& objects);
    void add_connections(const FbxRecord& connections);
    void add_templates(FbxRecord& definitions);

    FbxDocument& document_;
    std::unordered_map<std::string_view, std::vector<FbxObject>> objects_;
    std::unordered_map<std::string_view, std::unordered_map<int64_t, size_t>> places_;
    std::unordered_map<std::string_view, FbxRecord*> templates_; ///< by the name of the records
    std::unordered_map<int64_t, std::vector<int64_t>> sources_, destinations_;
};

} // namespace relief
