#include "api/instance_mattes.h"

#include <algorithm>

#include "image/cryptomatte.h"
#include "scene/object_names.h"

namespace relief {

namespace {

std::string name_material(const Scene& scene, const Object& object) {
    return object.material == kNoIndex ? "default" : name_item(scene.materials, object.material, "material");
}

/// The id of each object's name, and of all names the entries of the header.
template <class Name>
std::vector<uint32_t> make_ids(const Scene& scene, const char* layer, const Name& name,
                               std::map<std::string, std::string>& entries) {
    std::vector<uint32_t> ids;
    std::map<std::string, uint32_t> named;
    for (const Object& object : scene.objects) {
        const std::string text = name(scene, object);
        ids.push_back(named.try_emplace(text, make_matte_id(text)).first->second);
    }
    add_matte_entries(layer, named, entries);
    return ids;
}

} // namespace

std::shared_ptr<const InstanceMattes> make_instance_mattes(const Scene& scene,
                                                           const std::vector<std::string>& layers) {
    if (!needs_mattes(layers)) return nullptr;
    const auto is_requested = [&](const char* layer) {
        return std::find(layers.begin(), layers.end(), layer) != layers.end();
    };
    auto mattes = std::make_shared<InstanceMattes>();
    if (is_requested(kObjectMattes))
        mattes->objects = make_ids(scene, kObjectMattes, name_object, mattes->entries);
    if (is_requested(kMaterialMattes))
        mattes->materials = make_ids(scene, kMaterialMattes, name_material, mattes->entries);
    return mattes;
}

} // namespace relief
