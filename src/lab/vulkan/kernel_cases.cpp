#include "lab/vulkan/kernel_cases.h"

#include <cmath>
#include <functional>
#include <memory>
#include <set>
#include <utility>

#include "prepare/traversals.h"
#include "samples/shapes.h"

namespace relief {

namespace {

/// Levels of the plain scene go up to 5, the finest trees without tiles.
constexpr float kPlainPixelError = 6, kFinePixelError = 1;
constexpr int kManyLights = 64;

std::shared_ptr<const Texture> make_texture(float amplitude) {
    auto texture = std::make_shared<Texture>();
    texture->width = texture->height = 16;
    texture->channel_count = 3;
    for (uint32_t k = 0; k < texture->width * texture->height; ++k) {
        const float value = amplitude * (0.5f + 0.5f * std::sin(float(k)));
        texture->floats.insert(texture->floats.end(), {value, 0.5f * value, value, 1});
    }
    return texture;
}

Light make_lamp(float x) {
    Light light;
    light.type = LightType::point;
    light.position = {x, 4, 2};
    light.strength = 20;
    return light;
}

/// A displaced ring.
Scene make_plain_scene() {
    Scene scene;
    scene.meshes.push_back(
        samples::make_torus({.major_cells = 12, .minor_cells = 6}, [](const Vec3f& p) { return p; }));
    Displacement map;
    map.name = "map";
    map.tiles.push_back({1001, make_texture(0.1f)});
    scene.displacements.push_back(map);
    scene.materials.emplace_back();
    Object object;
    object.name = "ring";
    object.displacement = 0, object.material = 0;
    scene.objects.push_back(object);
    scene.lights.push_back(make_lamp(1));
    return scene;
}

void add_smooth_ball(Scene& scene) {
    scene.meshes.push_back(samples::make_icosphere(1, samples::Shading::smooth));
    Object object;
    object.name = "ball";
    object.mesh = uint32_t(scene.meshes.size() - 1);
    scene.objects.push_back(object);
}

void add_layers(Material& material) { material.coat_weight = 0.5f, material.fuzz_weight = 0.3f; }

void add_glass(Scene& scene) {
    Material glass;
    glass.transmission_weight = 1, glass.transmission_depth = 1;
    scene.materials.push_back(glass);
    Object object = scene.objects[0];
    object.name = "glass ring";
    object.material = uint32_t(scene.materials.size() - 1);
    scene.objects.push_back(object);
}

void add_input_texture(Material& material) {
    material.textures.push_back({MaterialInput::specular_color, {{1001, make_texture(1)}}});
}

void add_textured_light(Scene& scene) {
    Light light;
    light.type = LightType::rectangle;
    light.position = {0, 4, 0};
    light.color_texture = make_texture(1);
    scene.lights.push_back(light);
}

void add_many_lights(Scene& scene) {
    for (int k = 0; k < kManyLights; ++k) scene.lights.push_back(make_lamp(0.1f * float(k)));
}

void add_light_layers(Scene& scene, RenderSettings& settings) {
    scene.lights[0].light_group = "key";
    settings.image.layers = {"diffuse_direct", "light_key", "light_default"};
}

void catch_shadows(Scene& scene, RenderSettings& settings) {
    scene.objects[0].is_shadow_catcher = true;
    settings.image.background = Vec3f{0, 0, 0};
}

void add_sky(Scene& scene) {
    scene.environment.emplace();
    scene.environment->texture = make_texture(1);
}

using Change = std::function<void(Scene&, RenderSettings&)>;

struct NamedChange {
    const char *name, *meaning;
    Change apply;
};

std::vector<NamedChange> list_material_changes() {
    return {
        {"layers", "a coat and fuzz", [](Scene& s, RenderSettings&) { add_layers(s.materials[0]); }},
        {"glass", "a body of glass", [](Scene& s, RenderSettings&) { add_glass(s); }},
        {"input textures", "an input of a material has a texture",
         [](Scene& s, RenderSettings&) { add_input_texture(s.materials[0]); }},
        {"normal maps", "a material has a normal map",
         [](Scene& s, RenderSettings&) {
             set_input_texture(s.materials[0], MaterialInput::normal, make_texture(1));
         }},
        {"anisotropy", "roughness with a direction",
         [](Scene& s, RenderSettings&) { s.materials[0].specular_roughness_anisotropy = 0.5f; }},
        {"cut-outs", "opacity below 1", [](Scene& s, RenderSettings&) { s.materials[0].opacity = 0.5f; }},
    };
}

std::vector<NamedChange> list_surface_changes() {
    return {
        {"cubic", "maps with a cubic filter",
         [](Scene& s, RenderSettings&) { s.displacements[0].filter = MapFilter::cubic; }},
        {"subdivided", "the displaced base is bicubic",
         [](Scene& s, RenderSettings&) {
             s.meshes[0].subdivision.scheme = SubdivisionScheme::catmark;
             s.meshes[0].subdivision.level = 1;
         }},
        {"tiles", "patches finer than 32 x 32 cells",
         [](Scene&, RenderSettings& settings) { settings.surface.pixel_error = kFinePixelError; }},
        {"polygons", "coarse smooth polygons: shadow rays may start above them",
         [](Scene& s, RenderSettings&) { add_smooth_ball(s); }},
        {"fixed level", "the same for displaced patches",
         [](Scene&, RenderSettings& settings) { settings.surface.level = 4; }},
        {"box leaves", "surface.leaf = box",
         [](Scene&, RenderSettings& settings) { settings.surface.leaf = LeafKind::box; }},
        {"fused", "experiment.bottom = fused",
         [](Scene&, RenderSettings& settings) { settings.experiment.bottom = BottomForm::fused; }},
        {"fused, cubic", "the same with a cubic filter",
         [](Scene& s, RenderSettings& settings) {
             s.displacements[0].filter = MapFilter::cubic;
             settings.experiment.bottom = BottomForm::fused;
         }},
    };
}

std::vector<NamedChange> list_light_changes() {
    return {
        {"many lights", "a light tree", [](Scene& s, RenderSettings&) { add_many_lights(s); }},
        {"light links", "a light for one object",
         [](Scene& s, RenderSettings&) { s.lights[0].link_includes = {"ring"}; }},
        {"light textures", "a light has a texture", [](Scene& s, RenderSettings&) { add_textured_light(s); }},
        {"light layers", "light by kinds and groups", add_light_layers},
        {"guides", "guides of a denoiser",
         [](Scene&, RenderSettings& settings) {
             settings.image.layers = {"guide_albedo", "guide_N"};
         }},
        {"shadow catchers", "an object catches shadows", catch_shadows},
    };
}

/// Box leaves, a fixed level and the fused form are settings, not scenes.
void add_everything(Scene& scene, RenderSettings& settings) {
    scene.displacements[0].filter = MapFilter::cubic;
    settings.surface.pixel_error = kFinePixelError;
    for (const NamedChange& change : list_material_changes()) change.apply(scene, settings);
    for (const NamedChange& change : list_light_changes()) change.apply(scene, settings);
    add_smooth_ball(scene);
    add_sky(scene);
    settings.image.layers = {"diffuse_direct", "light_key", "light_default", "guide_albedo"};
}

RenderSettings make_plain_settings(RenderSettings settings) {
    settings.device.engine = EngineKind::vulkan;
    settings.surface.pixel_error = kPlainPixelError;
    return settings;
}

} // namespace

std::vector<SceneCase> make_scene_cases(const RenderSettings& settings) {
    std::vector<NamedChange> changes = {
        {"plain", "a displaced surface under one light", [](Scene&, RenderSettings&) {}}};
    for (auto list : {list_surface_changes(), list_material_changes(), list_light_changes()})
        changes.insert(changes.end(), list.begin(), list.end());
    changes.push_back({"all", "all of these in one scene, under a sky", add_everything});
    std::vector<SceneCase> cases;
    for (const NamedChange& change : changes) {
        cases.push_back({change.name, change.meaning, make_plain_scene(), make_plain_settings(settings)});
        change.apply(cases.back().scene, cases.back().settings);
    }
    return cases;
}

std::vector<SceneCase> make_walk_cases(const RenderSettings& settings) {
    std::vector<SceneCase> cases;
    std::set<TraversalKind> seen;
    for (const StructureKind structure : {StructureKind::bvh, StructureKind::lbvh, StructureKind::kdtree})
        for (const TraversalKind traversal : available_traversals(EngineKind::vulkan, structure)) {
            SceneCase walk{traversal_name(traversal), "a scene traversal of the laboratory",
                           make_plain_scene(), make_plain_settings(settings)};
            walk.settings.experiment.structure = structure, walk.settings.experiment.traversal = traversal;
            if (!is_default_traversal(walk.settings, EngineKind::vulkan) && seen.insert(traversal).second)
                cases.push_back(std::move(walk));
        }
    return cases;
}

} // namespace relief
