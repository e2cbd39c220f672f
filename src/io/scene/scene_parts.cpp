#include "io/scene/scene_parts.h"

#include <algorithm>
#include <array>
#include <string_view>

#include <fmt/format.h>

#include "base/content_hash.h"
#include "io/scene/keyed_values.h"

namespace relief {

namespace {

constexpr std::array<std::string_view, 5> kSectionsOfParts = {"materials", "displacements", "meshes",
                                                              "objects", "lights"};

bool has_parts(const std::string& section, const Json& value) {
    return value.is_structured() && std::ranges::find(kSectionsOfParts, section) != kSectionsOfParts.end();
}

} // namespace

void visit_parts(const Json& document, const std::function<void(const ScenePart& part)>& visit) {
    if (!document.is_object()) return;
    for (const auto& [section, value] : document.items()) {
        if (!has_parts(section, value)) {
            visit({section, 0, {}, section, &value});
            continue;
        }
        size_t index = 0;
        for (const auto& [name, member] : value.items()) {
            const bool is_list = value.is_array();
            visit({section, index, is_list ? std::string() : name,
                   is_list ? fmt::format("{}[{}]", section, index) : section + "." + name, &member});
            ++index;
        }
    }
}

std::vector<ScenePart> list_moving_parts(const Json& document) {
    std::vector<ScenePart> parts;
    visit_parts(document, [&](const ScenePart& part) {
        const bool is_section = part.path == part.section;
        if (depends_on_frame(*part.value, is_section ? part.section : "")) parts.push_back(part);
    });
    return parts;
}

bool has_moving_sections(const Json& document) {
    if (has_keys(document)) return true;
    return document.is_object() && std::ranges::any_of(kSectionsOfParts, [&](std::string_view section) {
               const auto found = document.find(std::string(section));
               return found != document.end() && has_keys(*found);
           });
}

uint64_t hash_part(const std::string& path, const Json& value) {
    nlohmann::json canonical = value; // sorts the keys
    if (path == "render" && canonical.is_object())
        for (const char* key : {"width", "height", "spp", "frames", "fps"}) canonical.erase(key);
    ContentHash hash;
    hash.add(path), hash.add(canonical.dump());
    return hash.value();
}

uint64_t hash_document(const Json& document) {
    uint64_t sum = 0;
    visit_parts(document, [&](const ScenePart& part) { sum += hash_part(part.path, *part.value); });
    return sum;
}

uint64_t join_hashes(uint64_t document_hash, uint64_t content_hash) {
    ContentHash hash(content_hash);
    hash.add(std::vector{document_hash});
    return hash.value();
}

} // namespace relief
