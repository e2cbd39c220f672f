#include "io/mesh/fbx_objects.h"

namespace relief {

FbxObjects::FbxObjects(FbxDocument& document) : document_(document) {
    for (FbxRecord& section : document.root().children) {
        if (section.name == "Objects") add_objects(section);
        if (section.name == "Connections") add_connections(section);
        if (section.name == "Definitions") add_templates(section);
    }
}

void FbxObjects::add_objects(FbxRecord& objects) {
    for (FbxRecord& record : objects.children) {
        if (record.values.size() < 3) continue;
        const auto id = document_.read_id(record.values[0]);
        if (!id) continue;
        std::vector<FbxObject>& list = objects_[record.name];
        places_[record.name].try_emplace(*id, list.size());
        list.push_back(
            {*id, &record, document_.read_name(record.values[1]), document_.read_text(record.values[2])});
    }
}

void FbxObjects::add_connections(const FbxRecord& connections) {
    for (const FbxRecord& record : connections.children) {
        if (record.values.size() < 3 || document_.read_text(record.values[0]) != "OO") continue;
        const auto source = document_.read_id(record.values[1]),
                   destination = document_.read_id(record.values[2]);
        if (!source || !destination) continue;
        sources_[*destination].push_back(*source);
        destinations_[*source].push_back(*destination);
    }
}

void FbxObjects::add_templates(FbxRecord& definitions) {
    for (FbxRecord& type : definitions.children) {
        if (type.name != "ObjectType" || type.values.empty()) continue;
        if (FbxRecord* properties = type.find("PropertyTemplate"))
            templates_.try_emplace(document_.read_text(type.values[0]), properties);
    }
}

const std::vector<FbxObject>& FbxObjects::list(std::string_view record) const {
    static const std::vector<FbxObject> kNone;
    const auto found = objects_.find(record);
    return found == objects_.end() ? kNone : found->second;
}

namespace {

template <class Lists, class Places>
std::vector<const FbxObject*> collect(const Lists& links, int64_t id, const std::vector<FbxObject>& objects,
                                      const Places* places) {
    std::vector<const FbxObject*> found;
    const auto list = links.find(id);
    if (list == links.end() || !places) return found;
    for (const int64_t other : list->second)
        if (const auto place = places->find(other); place != places->end())
            found.push_back(&objects[place->second]);
    return found;
}

template <class Map> const typename Map::mapped_type* find_in(const Map& map, std::string_view key) {
    const auto found = map.find(key);
    return found == map.end() ? nullptr : &found->second;
}

} // namespace

std::vector<const FbxObject*> FbxObjects::list_sources(std::string_view record, int64_t destination) const {
    return collect(sources_, destination, list(record), find_in(places_, record));
}

std::vector<const FbxObject*> FbxObjects::list_destinations(std::string_view record, int64_t source) const {
    return collect(destinations_, source, list(record), find_in(places_, record));
}

std::vector<std::string_view>* FbxObjects::find_values(FbxRecord& owner, std::string_view property) const {
    FbxRecord* properties = owner.find("Properties70");
    if (!properties) return nullptr;
    for (FbxRecord& entry : properties->children)
        if (entry.values.size() > kFirstFbxValue && document_.read_text(entry.values[0]) == property)
            return &entry.values;
    return nullptr;
}

std::vector<std::string_view>* FbxObjects::find_values(const FbxObject& object,
                                                       std::string_view property) const {
    return find_values(*object.record, property);
}

std::optional<double> FbxObjects::find_number(const FbxObject& object, std::string_view property) const {
    const std::vector<std::string_view>* values = find_values(object, property);
    if (!values)
        if (FbxRecord* const* defaults = find_in(templates_, object.record->name))
            values = find_values(**defaults, property);
    if (!values) return {};
    return document_.read_number((*values)[kFirstFbxValue]);
}

} // namespace relief
