#include "io/mesh/mesh_gltf.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <set>

#include <fmt/format.h>

#include "formulas/basis.h"
#include "io/mesh/further_uvs.h"
#include "io/mesh/gltf_animation.h"
#include "io/mesh/gltf_extensions.h"
#include "io/mesh/gltf_primitive.h"
#include "io/mesh/gltf_transform.h"
#include "io/mesh/gltf_uv_transform.h"
#include "io/mesh/welder.h"
#include "math/affine.h"
#include "relief/error.h"

namespace relief {

namespace {

/// Returns the weights of morph targets: those of the animation, of the node, or of the mesh.
std::vector<float> read_weights(const JsonNode& node, const JsonNode& mesh, const GltfPose& pose) {
    if (pose.weights) return *pose.weights;
    auto list = node.find("weights");
    if (!list) list = mesh.find("weights");
    std::vector<float> weights;
    if (list)
        for (const JsonNode& weight : list->elements()) weights.push_back(weight.as_float());
    return weights;
}

/// Carries vectors of an object into the world, also where its transform flattens it.
class VectorTransform {
  public:
    explicit VectorTransform(const Affine& world_from_node)
        : world_from_node_(world_from_node), is_mirrored_(compute_determinant(world_from_node) < 0) {
        const auto& rows = world_from_node.rows;
        const float sign = is_mirrored_ ? -1.0f : 1.0f;
        // Rows of cofactors are the inverse transpose times the determinant, and exist for every matrix.
        cofactors_.rows = {cross(rows[1], rows[2]) * sign, cross(rows[2], rows[0]) * sign,
                           cross(rows[0], rows[1]) * sign};
    }
    bool is_mirrored() const { return is_mirrored_; }
    Vec3f carry_normal(const Vec3f& n) const { return normalize(transform_vector(cofactors_, n)); }
    Vec3f carry_tangent(const Vec3f& t) const { return normalize(transform_vector(world_from_node_, t)); }

  private:
    const Affine& world_from_node_;
    Affine cofactors_;
    bool is_mirrored_;
};

class GltfBuilder {
  public:
    GltfBuilder(GltfFile& file, const std::string& name, const MeshReadOptions& options)
        : file_(file),
          name_(name),
          uv_set_(options.uv_set),
          further_(options),
          nodes_(file.list("nodes")),
          meshes_(file.list("meshes")),
          uv_transforms_(file),
          positions_(mesh_.positions),
          normals_(mesh_.normals),
          uvs_(mesh_.uvs) {
        if (!options.animation.empty()) poses_ = read_gltf_poses(file, options.animation, options.time);
    }

    Mesh build() {
        check_gltf_extensions(file_, warnings_);
        find_instances();
        std::set<const JsonNode*> morphed; // of others targets are not read
        for (const Instance& instance : instances_)
            if (std::ranges::any_of(instance.weights, [](float weight) { return weight != 0; }))
                morphed.insert(instance.mesh);
        for (const Instance& instance : instances_)
            read_parts(*instance.mesh, morphed.contains(instance.mesh) ? Targets::read : Targets::left_out);
        check_uvs();
        for (const Instance& instance : instances_)
            for (const GltfPrimitive& part : parts_.at(instance.mesh))
                add_part(MorphedPrimitive(part, instance.weights).get(), instance.world_from_node);
        mesh_.uv_set = uv_set_;
        mesh_.further_uvs = further_.take();
        return std::move(mesh_);
    }

    /// Lists the contents of the file that the mesh does not show.
    std::vector<std::string> list_warnings() const {
        std::vector<std::string> warnings = warnings_;
        std::ranges::move(losses_.list_warnings(name_), std::back_inserter(warnings));
        std::ranges::move(uv_transforms_.list_warnings(), std::back_inserter(warnings));
        for (const int set : whole_uv_sets_)
            warnings.push_back(
                fmt::format("{}: uvs of set {} are whole numbers, and no KHR_texture_transform makes parts "
                            "of a picture of them: export them as floats (gltfpack -noq)",
                            name_, set));
        if (skinned_.empty()) return warnings;
        constexpr size_t kMostNamed = 4;
        std::string names;
        for (size_t k = 0; k < std::min(skinned_.size(), kMostNamed); ++k)
            names += (k == 0 ? "" : ", ") + skinned_[k];
        if (skinned_.size() > kMostNamed) names += fmt::format(" and {} more", skinned_.size() - kMostNamed);
        warnings.push_back(
            fmt::format("{}: {} would be bent by a skin, which is not read: it is seen in its bind pose; "
                        "export it posed, or for an animation as a file a frame, and name these with ####",
                        name_, names));
        return warnings;
    }

  private:
    struct Instance {
        const JsonNode* mesh;
        Affine world_from_node;
        std::vector<float> weights; ///< of morph targets
    };

    [[noreturn]] void fail(const std::string& message, const std::string& hint) const {
        throw Error(ErrorKind::bad_input, {message, name_, hint});
    }

    /// The roots of the file's scene; of a file without one, all nodes without a parent.
    std::vector<const JsonNode*> find_roots() const {
        std::vector<const JsonNode*> roots;
        const std::vector<JsonNode> scenes = file_.list("scenes");
        const auto chosen = file_.root().find("scene");
        if (!scenes.empty()) {
            const JsonNode& scene = chosen ? GltfFile::resolve(*chosen, scenes, "scene") : scenes.front();
            if (const auto list = scene.find("nodes"))
                for (const JsonNode& index : list->elements())
                    roots.push_back(&GltfFile::resolve(index, nodes_, "node"));
            return roots;
        }
        std::vector<bool> is_child(nodes_.size(), false);
        for (const JsonNode& node : nodes_)
            if (const auto children = node.find("children"))
                for (const JsonNode& index : children->elements())
                    is_child[size_t(&GltfFile::resolve(index, nodes_, "node") - nodes_.data())] = true;
        for (size_t i = 0; i < nodes_.size(); ++i)
            if (!is_child[i]) roots.push_back(&nodes_[i]);
        return roots;
    }

    void find_instances() {
        struct Item {
            const JsonNode* node;
            Affine world_from_parent;
        };
        std::vector<Item> open;
        const std::vector<const JsonNode*> roots = find_roots();
        for (auto root = roots.rbegin(); root != roots.rend(); ++root) open.push_back({*root, {}});
        std::vector<bool> is_seen(nodes_.size(), false);
        while (!open.empty()) {
            const Item item = open.back();
            open.pop_back();
            const auto index = size_t(item.node - nodes_.data());
            mark_seen(*item.node, is_seen);
            if (is_hidden_gltf_node(*item.node)) {
                mark_descendants(*item.node, is_seen);
                continue;
            }
            const auto posed = poses_.find(index);
            const GltfPose pose = posed == poses_.end() ? GltfPose{} : posed->second;
            const Affine world_from_node =
                compose(item.world_from_parent, read_gltf_transform(*item.node, pose));
            if (const auto mesh_index = item.node->find("mesh")) {
                const JsonNode& mesh = GltfFile::resolve(*mesh_index, meshes_, "mesh");
                for (const Affine& copy : read_gltf_instances(file_, *item.node))
                    instances_.push_back(
                        {&mesh, compose(world_from_node, copy), read_weights(*item.node, mesh, pose)});
                if (item.node->find("skin")) skinned_.push_back(describe_node(*item.node, index));
            }
            const auto children = item.node->find("children");
            if (!children) continue;
            const std::vector<JsonNode> indices = children->elements();
            for (auto child = indices.rbegin(); child != indices.rend(); ++child)
                open.push_back({&GltfFile::resolve(*child, nodes_, "node"), world_from_node});
        }
        if (file_.list("scenes").empty()) check_all_seen(is_seen);
        if (nodes_.empty()) // a library of meshes
            for (const JsonNode& mesh : meshes_)
                instances_.push_back({&mesh, {}, read_weights(mesh, mesh, {})});
    }

    void mark_seen(const JsonNode& node, std::vector<bool>& is_seen) const {
        const auto index = size_t(&node - nodes_.data());
        if (is_seen[index]) node.fail("is listed twice in the tree of nodes", kDamagedHint);
        is_seen[index] = true;
    }

    /// Marks the descendants of a hidden node, which are hidden, too.
    void mark_descendants(const JsonNode& node, std::vector<bool>& is_seen) const {
        std::vector<const JsonNode*> open{&node};
        while (!open.empty()) {
            const JsonNode& parent = *open.back();
            open.pop_back();
            if (const auto children = parent.find("children"))
                for (const JsonNode& child : children->elements()) {
                    open.push_back(&GltfFile::resolve(child, nodes_, "node"));
                    mark_seen(*open.back(), is_seen);
                }
        }
    }

    static std::string describe_node(const JsonNode& node, size_t index) {
        const auto name = node.find("name");
        return name ? fmt::format("node '{}'", name->as_string()) : fmt::format("node {}", index);
    }

    /// A node below none of the roots has only itself above it.
    void check_all_seen(const std::vector<bool>& is_seen) const {
        const auto unseen = std::find(is_seen.begin(), is_seen.end(), false);
        if (unseen != is_seen.end())
            nodes_[size_t(unseen - is_seen.begin())].fail("is a descendant of itself", kDamagedHint);
    }

    enum class Targets { left_out, read };

    void read_parts(const JsonNode& mesh, Targets targets) {
        const auto [found, is_new] = parts_.try_emplace(&mesh);
        if (!is_new) return;
        for (const JsonNode& primitive : mesh.get("primitives").elements()) {
            GltfPrimitive part = read_gltf_primitive(file_, primitive, uv_set_, further_.numbers(), losses_);
            if (part.face_sizes.empty()) continue;
            if (targets == Targets::read) read_gltf_targets(file_, primitive, part, losses_);
            place_uvs(primitive, part);
            with_uv_ += part.uvs.empty() ? 0 : 1;
            most_uv_sets_ = std::max(most_uv_sets_, part.uv_set_count);
            if (part.normals.empty()) has_normals_ = false;
            if (part.tangents.empty()) has_tangents_ = false;
            found->second.push_back(std::move(part));
        }
    }

    /// Uvs as the textures of the material are read, KHR_texture_transform applied.
    void place_uvs(const JsonNode& primitive, GltfPrimitive& part) {
        const auto place = [&](std::span<const float>& uvs, int set) {
            if (uvs.empty()) return;
            const auto transform = uv_transforms_.find(primitive, set);
            if (transform)
                uvs = file_.keep(transform_uvs(uvs, *transform));
            else if (file_.has_whole_numbers(
                         primitive.get("attributes").get(fmt::format("TEXCOORD_{}", set))))
                whole_uv_sets_.insert(set);
        };
        place(part.uvs, uv_set_);
        for (size_t n = 0; n < part.further_uvs.size(); ++n)
            place(part.further_uvs[n], further_.numbers()[n]);
    }

    void check_uvs() const {
        if (uv_set_ > 0 && with_uv_ == 0)
            fail(fmt::format("has no uv set {}", uv_set_),
                 fmt::format("it has {}, counted from 0", most_uv_sets_));
    }

    /// Indices in the mesh of a vertex of a part.
    struct Corner {
        uint32_t copy = 0; ///< of which part, counted from 1: parts may share vertices by the million
        uint32_t position = kNoIndex, uv = kNoIndex, normal = kNoIndex;
        std::array<float, 4> tangent{};
    };

    void add_part(const GltfPrimitive& part, const Affine& world_from_node) {
        const VectorTransform vectors(world_from_node);
        if (mesh_.position_indices.size() + part.corners.size() >= kNoIndex)
            fail("has more than 2^32 corners with all its copies", "split the file");
        corners_.resize(std::max(corners_.size(), part.positions.size() / 3));
        ++copy_count_;
        size_t begin = 0;
        for (const uint32_t size : part.face_sizes) {
            // A mirror turns the winding round; the corners are walked backwards to keep the outside outside.
            for (uint32_t k = 0; k < size; ++k) {
                const uint32_t vertex = part.corners[begin + (vectors.is_mirrored() ? size - 1 - k : k)];
                Corner& corner = corners_[vertex];
                if (corner.copy != copy_count_) corner = weld(part, vertex, world_from_node, vectors);
                add_corner(corner);
                add_further_uvs(part, vertex);
            }
            mesh_.face_sizes.push_back(size);
            begin += size;
        }
    }

    void add_corner(const Corner& corner) {
        mesh_.position_indices.push_back(corner.position);
        if (with_uv_ > 0) mesh_.uv_indices.push_back(corner.uv);
        if (has_normals_) mesh_.normal_indices.push_back(corner.normal);
        if (has_tangents_) mesh_.tangents.push_back(corner.tangent);
    }

    void add_further_uvs(const GltfPrimitive& part, uint32_t vertex) {
        for (size_t n = 0; n < part.further_uvs.size(); ++n) {
            const std::span<const float> uvs = part.further_uvs[n];
            if (uvs.empty())
                further_.add_corner_without(n);
            else
                further_.add_corner(n, {uvs[2 * vertex], 1 - uvs[2 * vertex + 1]}); // v from the top
        }
    }

    Corner weld(const GltfPrimitive& part, size_t vertex, const Affine& world_from_node,
                const VectorTransform& vectors) {
        const auto load = [vertex](std::span<const float> values, size_t width) {
            const float* at = values.data() + vertex * width;
            return Vec3f{at[0], at[1], at[2]};
        };
        Corner corner;
        corner.copy = copy_count_;
        corner.position = positions_.add(transform_point(world_from_node, load(part.positions, 3)));
        if (!part.uvs.empty())
            corner.uv = uvs_.add({part.uvs[2 * vertex], 1 - part.uvs[2 * vertex + 1]}); // v from the top
        Vec3f normal{};
        if (!part.normals.empty()) normal = vectors.carry_normal(load(part.normals, 3));
        if (has_normals_) corner.normal = normals_.add(normal);
        if (!has_tangents_) return corner;
        Vec3f tangent = vectors.carry_tangent(load(part.tangents, 4));
        // Where the uvs have no direction writers store zeros or NaN: no tangent is more right than another.
        if (tangent == Vec3f{}) tangent = normal == Vec3f{} ? Vec3f{1, 0, 0} : scalar::make_basis(normal).t;
        const bool is_left_handed = (part.tangents[4 * vertex + 3] < 0) != vectors.is_mirrored();
        corner.tangent = {tangent.x, tangent.y, tangent.z, is_left_handed ? -1.0f : 1.0f};
        return corner;
    }

    GltfFile& file_;
    const std::string& name_;
    int uv_set_;
    FurtherUvs further_;
    std::vector<JsonNode> nodes_, meshes_;
    GltfUvTransforms uv_transforms_;
    GltfLosses losses_;
    std::set<int> whole_uv_sets_; ///< sets of integers that are no parts of a picture
    Mesh mesh_;
    PointWelder positions_, normals_;
    UvWelder uvs_;
    std::map<size_t, GltfPose> poses_; ///< of nodes that an animation moves
    std::vector<Instance> instances_;
    std::vector<std::string> skinned_;                            ///< nodes
    std::vector<std::string> warnings_;                           ///< others than of skins
    std::map<const JsonNode*, std::vector<GltfPrimitive>> parts_; ///< of meshes, each read once
    std::vector<Corner> corners_;                                 ///< by vertex
    uint32_t copy_count_ = 0;
    int with_uv_ = 0; ///< parts
    size_t most_uv_sets_ = 0;
    bool has_normals_ = true, has_tangents_ = true;
};

} // namespace

Mesh parse_gltf(std::string_view bytes, const std::string& name, const ReadBeside& read_beside,
                const MeshReadOptions& options, std::vector<std::string>* warnings) {
    try {
        GltfFile file(bytes, name, read_beside);
        GltfBuilder builder(file, name, options);
        Mesh mesh = builder.build();
        if (warnings) std::ranges::move(builder.list_warnings(), std::back_inserter(*warnings));
        return mesh;
    } catch (const Error& error) {
        if (!error.hint().empty()) throw;
        throw Error(error.kind(), {error.message(), error.where(), kDamagedHint});
    }
}

} // namespace relief
