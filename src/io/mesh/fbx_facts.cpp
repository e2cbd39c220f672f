#include "io/mesh/fbx_facts.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <optional>
#include <system_error>

#include <fmt/format.h>

#include "io/mesh/fbx_creases.h"
#include "io/mesh/fbx_objects.h"
#include "io/mesh/name_list.h"

namespace relief {

namespace {

constexpr char kNodeLetter = 'n', kChannelLetter = 'c'; ///< before the number in a name

/// The number behind the letter, below `end`.
std::optional<size_t> parse_name(std::string_view name, char letter, size_t end) {
    if (const size_t colons = name.find("::"); colons != std::string_view::npos) // a class
        name.remove_prefix(colons + 2);
    size_t number = 0;
    if (!name.starts_with(letter)) return {};
    const auto [stop, code] = std::from_chars(name.data() + 1, name.data() + name.size(), number);
    const bool is_whole = stop == name.data() + name.size() || *stop == '_'; // a part of a chain
    return code == std::errc() && is_whole && number < end ? std::optional(number) : std::nullopt;
}

/// Weights of the shapes of a channel, which blend from one to the next as the percentage grows. `full`: the
/// percentage at which each is seen alone.
std::vector<float> share_weight(double percent, const std::vector<float>& full, size_t shape_count) {
    constexpr float kWhole = 100;
    std::vector<float> weights(shape_count, 0.0f);
    if (shape_count == 1) {
        const bool has_full = full.size() == 1 && full[0] > 0;
        weights[0] = float(percent) / (has_full ? full[0] : kWhole);
        return weights;
    }
    if (full.size() != shape_count) return weights;
    std::vector<size_t> order;
    for (const bool is_negative : {percent < 0, !(percent < 0)}) {
        if (!order.empty()) break; // else the other side goes on beyond 0
        for (size_t k = 0; k < shape_count; ++k)
            if (std::isfinite(full[k]) && full[k] != 0 && (full[k] < 0) == is_negative) order.push_back(k);
        std::ranges::sort(order, {}, [&](size_t k) { return std::abs(full[k]); });
        if (is_negative != (percent < 0)) order.resize(std::min<size_t>(order.size(), 1));
    }
    if (order.empty()) return weights;
    size_t next = 0;
    while (next + 1 < order.size() && std::abs(percent) > std::abs(full[order[next]])) ++next;
    const double before = next == 0 ? 0 : full[order[next - 1]], behind = full[order[next]];
    if (before == behind) return weights;
    const double share = (percent - before) / (behind - before);
    weights[order[next]] = float(share);
    if (next > 0) weights[order[next - 1]] = float(1 - share);
    return weights;
}

class FactFinder {
  public:
    explicit FactFinder(FbxDocument& document) : document_(document), objects_(document) {}

    FbxFacts find() {
        for (const FbxObject& model : objects_.list("Model")) add_node(model);
        find_hidden();
        for (const FbxObject& deformer : objects_.list("Deformer")) add_deformer(deformer);
        // The names of the file have been read by now.
        const std::vector<FbxObject>& models = objects_.list("Model");
        for (size_t k = 0; k < models.size(); ++k)
            document_.rename(models[k].record->values[1], fmt::format("{}{}", kNodeLetter, k));
        return std::move(facts_);
    }

  private:
    void add_node(const FbxObject& model) {
        FbxNode node;
        node.name = std::string(model.name);
        if (const auto* values = objects_.find_values(model, "GeometricRotation"))
            for (size_t k = 0; k < 3 && kFirstFbxValue + k < values->size(); ++k)
                node.geometric_rotation[k] = document_.read_number((*values)[kFirstFbxValue + k]).value_or(0);
        for (const FbxObject* geometry : objects_.list_sources("Geometry", model.id)) {
            if (geometry->kind == "Mesh") {
                std::ranges::copy(find_creases(*geometry), std::back_inserter(node.creases));
                if (geometry->record->find("Shape"))
                    facts_.warnings.push_back(
                        fmt::format("node '{}' has blend shapes of an old kind, which are not read: export "
                                    "it as FBX 2020 (7.x), or with the shapes applied",
                                    node.name));
            }
            if (geometry->kind.find("Surface") != std::string_view::npos || geometry->kind == "Nurbs" ||
                geometry->kind == "Patch")
                facts_.surfaces.push_back(node.name);
        }
        const double inherit = objects_.find_number(model, "InheritType").value_or(1);
        if (inherit == 0) node.inherit = FbxInherit::behind_rotation;
        if (inherit == 2) node.inherit = FbxInherit::no_scale;
        mend_rotation(model, node.name);
        facts_.nodes.push_back(std::move(node));
    }

    const std::vector<FbxCrease>& find_creases(const FbxObject& geometry) {
        const auto [found, is_new] = creases_.try_emplace(geometry.id);
        if (is_new) found->second = read_fbx_creases(document_, *geometry.record);
        return found->second;
    }

    /// Without RotationActive a node has neither an order of its own nor rotations before and behind it. The
    /// importer does not know that, and reads no spheric order.
    void mend_rotation(const FbxObject& model, const std::string& name) {
        constexpr double kSpheric = 6;
        const auto clear = [&](std::string_view property) {
            if (auto* values = objects_.find_values(model, property))
                for (size_t k = kFirstFbxValue; k < values->size(); ++k) document_.clear_number((*values)[k]);
        };
        if (objects_.find_number(model, "RotationActive").value_or(1) == 0 ||
            objects_.find_number(model, "RotationSpaceForLimitOnly").value_or(0) != 0) {
            for (const char* property : {"RotationOrder", "PreRotation", "PostRotation"}) clear(property);
        } else if (objects_.find_number(model, "RotationOrder").value_or(0) == kSpheric) {
            clear("RotationOrder");
            facts_.warnings.push_back(
                fmt::format("node '{}' rotates in the order 'spheric XYZ', which is read "
                            "as XYZ: apply the rotation before the export",
                            name));
        }
    }

    void find_hidden() {
        const std::vector<FbxObject>& models = objects_.list("Model");
        std::vector<size_t> open;
        std::map<int64_t, size_t> places;
        for (size_t k = 0; k < models.size(); ++k) {
            places.try_emplace(models[k].id, k);
            const bool is_seen = objects_.find_number(models[k], "Visibility").value_or(1) != 0 &&
                                 objects_.find_number(models[k], "Show").value_or(1) != 0;
            facts_.nodes[k].is_hidden = !is_seen;
            if (!is_seen) open.push_back(k);
        }
        while (!open.empty()) {
            const int64_t id = models[open.back()].id;
            open.pop_back();
            for (const FbxObject* child : objects_.list_sources("Model", id)) {
                const size_t place = places.at(child->id);
                if (facts_.nodes[place].is_hidden) continue;
                if (objects_.find_number(*child, "Visibility Inheritance").value_or(1) == 0) continue;
                facts_.nodes[place].is_hidden = true;
                open.push_back(place);
            }
        }
    }

    void add_deformer(const FbxObject& deformer) {
        if (deformer.kind == "BlendShapeChannel") add_channel(deformer);
        if (deformer.kind == "VertexCacheDeformer")
            facts_.warnings.push_back(
                fmt::format("{} would be moved by a cache of points, which is not read: "
                            "export the mesh with the deformer applied",
                            describe_meshes(deformer)));
        const FbxRecord* skinning = deformer.kind == "Skin" ? deformer.record->find("SkinningType") : nullptr;
        if (!skinning || skinning->values.empty()) return;
        const std::string_view type = document_.read_text(skinning->values[0]);
        const FbxRecord* blend = deformer.record->find("BlendWeights");
        const bool is_blended =
            type == "Blend" && blend &&
            std::ranges::any_of(document_.read_floats(*blend), [](float weight) { return weight != 0; });
        if (type == "DualQuaternion" || is_blended)
            facts_.warnings.push_back(fmt::format("{} is bent by a skin of the type '{}', which is read as a "
                                                  "linear one: export the mesh with the skin applied",
                                                  describe_meshes(deformer), type));
    }

    std::string describe_meshes(const FbxObject& deformer) const {
        std::vector<std::string> names;
        for (const FbxObject* geometry : objects_.list_destinations("Geometry", deformer.id))
            for (const FbxObject* model : objects_.list_destinations("Model", geometry->id))
                names.emplace_back(model->name);
        return names.empty() ? std::string("a mesh") : "node " + list_names(names);
    }

    void add_channel(const FbxObject& channel) {
        double percent = objects_.find_number(channel, "DeformPercent").value_or(0);
        const FbxRecord* old = channel.record->find("DeformPercent");
        if (old && !old->values.empty() && !objects_.find_values(channel, "DeformPercent"))
            percent = document_.read_number(old->values[0]).value_or(0);
        const FbxRecord* full = channel.record->find("FullWeights");
        std::vector<const FbxObject*> shapes;
        for (const FbxObject* shape : objects_.list_sources("Geometry", channel.id))
            if (shape->kind == "Shape") shapes.push_back(shape);
        const std::vector<float> full_weights = full ? document_.read_floats(*full) : std::vector<float>();
        const std::string name = fmt::format("{}{}", kChannelLetter, facts_.channel_weights.size());
        document_.rename(channel.record->values[1], name);
        for (const FbxObject* shape : shapes) {
            document_.rename(shape->record->values[1], name);
            mend_shape(*shape->record, shapes.size() == 1 ? full_weights : std::vector<float>());
        }
        facts_.channel_weights.push_back(share_weight(percent, full_weights, shapes.size()));
    }

    /// The importer reads no shape without normals. `percents`: from some writers the weights of the points.
    void mend_shape(FbxRecord& shape, const std::vector<float>& percents) {
        const FbxRecord *moves = shape.find("Vertices"), *normals = shape.find("Normals");
        if (!moves) return;
        std::vector<float> values = document_.read_floats(*moves);
        if (!normals) document_.set_floats(shape, "Normals", std::vector<float>(values.size()));
        const bool is_weighted = percents.size() > 1 && percents.size() * 3 == values.size() &&
                                 std::ranges::any_of(percents, [](float p) { return p != 100; });
        if (!is_weighted) return;
        for (size_t k = 0; k < values.size(); ++k) values[k] *= percents[k / 3] / 100;
        document_.set_floats(shape, "Vertices", values);
    }

    FbxDocument& document_;
    FbxObjects objects_;
    FbxFacts facts_;
    std::map<int64_t, std::vector<FbxCrease>> creases_; ///< by geometry
};

} // namespace

const FbxNode* FbxFacts::find_node(std::string_view name) const {
    const auto number = parse_name(name, kNodeLetter, nodes.size());
    return number ? &nodes[*number] : nullptr;
}

const std::vector<float>* FbxFacts::find_channel(std::string_view name) const {
    const auto number = parse_name(name, kChannelLetter, channel_weights.size());
    return number ? &channel_weights[*number] : nullptr;
}

FbxFacts prepare_fbx(FbxDocument& document) { return FactFinder(document).find(); }

} // namespace relief
