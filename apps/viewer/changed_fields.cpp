#include "viewer/changed_fields.h"

#include <algorithm>
#include <tuple>
#include <vector>

#include "relief/material_inputs.h"

namespace relief::viewer {

namespace {

// All that panels and scripts change.
constexpr auto kDisplacementFields =
    std::tuple(&Displacement::type, &Displacement::space, &Displacement::axes, &Displacement::midlevel,
               &Displacement::has_midlevel, &Displacement::scale, &Displacement::flip_v, &Displacement::wrap,
               &Displacement::filter, &Displacement::assumed);
constexpr auto kEnvironmentFields =
    std::tuple(&Environment::color, &Environment::strength, &Environment::rotate_degrees);
constexpr auto kLightFields =
    std::tuple(&Light::direction, &Light::position, &Light::color, &Light::strength);

template <class Item, class Members>
uint32_t find_changes(const Item& before, const Item& after, const Members& members) {
    uint32_t fields = 0, bit = 1;
    const auto look = [&](auto member) {
        if (!(before.*member == after.*member)) fields |= bit;
        bit <<= 1;
    };
    std::apply([&](auto... member) { (look(member), ...); }, members);
    return fields;
}

template <class Item, class Members>
void copy_fields(const Item& from, Item& to, uint32_t fields, const Members& members) {
    const auto copy = [&](auto member) {
        if (fields & 1) to.*member = from.*member;
        fields >>= 1;
    };
    std::apply([&](auto... member) { (copy(member), ...); }, members);
}

/// Calls visit(member) for each number, colour and flag of materials. Emission comes once.
template <class Visit> void visit_members(const Visit& visit) {
    for (const MaterialInputKind& kind : list_material_fields()) {
        if (kind.number) visit(kind.number);
        if (kind.is_color()) visit(kind.color);
        if (kind.flag) visit(kind.flag);
    }
}

uint32_t find_changes(const Material& before, const Material& after) {
    uint32_t fields = 0, bit = 1;
    visit_members([&](auto member) {
        if (!(before.*member == after.*member)) fields |= bit;
        bit <<= 1;
    });
    return fields;
}

void copy_fields(const Material& from, Material& to, uint32_t fields) {
    visit_members([&](auto member) {
        if (fields & 1) to.*member = from.*member;
        fields >>= 1;
    });
}

/// `members`: those of copy_fields, where it needs some.
template <class Item, class... Members>
void copy_named(const std::vector<Item>& from, std::vector<Item>& to,
                const std::map<std::string, uint32_t>& fields, const Members&... members) {
    for (Item& item : to) {
        const auto changed = fields.find(item.name);
        if (changed == fields.end()) continue;
        const auto source = std::ranges::find(from, item.name, &Item::name);
        if (source != from.end()) copy_fields(*source, item, changed->second, members...);
    }
}

} // namespace

void ChangedFields::note(const Displacement& before, const Displacement& after, const Displacement& read) {
    const Fields touched = find_changes(before, after, kDisplacementFields);
    const Fields changed = find_changes(read, after, kDisplacementFields);
    Fields& fields = displacements_[after.name];
    fields = (fields & ~touched) | (touched & changed);
}

void ChangedFields::copy(const Displacement& from, Displacement& to, Fields fields) {
    copy_fields(from, to, fields, kDisplacementFields);
}

void ChangedFields::copy(const Material& from, Material& to, Fields fields) { copy_fields(from, to, fields); }

void ChangedFields::copy(const Environment& from, Environment& to, Fields fields) {
    copy_fields(from, to, fields, kEnvironmentFields);
}

void ChangedFields::copy(const Light& from, Light& to, Fields fields) {
    copy_fields(from, to, fields, kLightFields);
}

void ChangedFields::note(const Material& before, const Material& after) {
    materials_[after.name] |= find_changes(before, after);
}

void ChangedFields::note(const Environment& before, const Environment& after) {
    environment_ |= find_changes(before, after, kEnvironmentFields);
    has_own_texture_ |= before.texture != after.texture;
}

void ChangedFields::note(size_t light, const Light& before, const Light& after) {
    lights_[light] |= find_changes(before, after, kLightFields);
}

void ChangedFields::carry(const Scene& from, Scene& to) const {
    copy_named(from.displacements, to.displacements, displacements_, kDisplacementFields);
    copy_named(from.materials, to.materials, materials_);
    if (from.lights.size() == to.lights.size())
        for (const auto& [light, fields] : lights_)
            if (light < to.lights.size()) copy(from.lights[light], to.lights[light], fields);
    if ((!environment_ && !has_own_texture_) || !from.environment) return;
    if (!to.environment) to.environment.emplace();
    copy(*from.environment, *to.environment, environment_);
    if (has_own_texture_) to.environment->texture = from.environment->texture;
}

} // namespace relief::viewer
