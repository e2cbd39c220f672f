// The parts of a scene document that can be read one by one: a member of a section, or a section that has
// none.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "io/scene/json_node.h"

namespace relief {

struct ScenePart {
    std::string section;         ///< key in the root
    size_t index = 0;            ///< of a member or element
    std::string name;            ///< of a member
    std::string path;            ///< for messages: "materials.clay", "objects[3]", "camera"
    const Json* value = nullptr; ///< in the document
};

/// Calls visit(part) for all parts of a document, in its order.
void visit_parts(const Json& document, const std::function<void(const ScenePart& part)>& visit);

/// Those that depend on the frame.
std::vector<ScenePart> list_moving_parts(const Json& document);

/// Whether sections come and go, or their members: nothing can be read for itself then.
bool has_moving_sections(const Json& document);

/// Of what a part says of the picture. The sum of those of all parts stands for the document, whatever the
/// order of keys. Size, samples and frames of the picture may change without its being another picture.
uint64_t hash_part(const std::string& path, const Json& value);
uint64_t hash_document(const Json& document);

/// Scene::hash of a document and its files.
uint64_t join_hashes(uint64_t document_hash, uint64_t content_hash);

} // namespace relief
