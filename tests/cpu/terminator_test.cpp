// Where light ends on coarse surfaces with smooth normals.
#include <optional>
#include <random>

#include <gtest/gtest.h>

#include "cpu/shading/terminator.h"
#include "math/affine.h"
#include "support/coarse_sphere.h"

namespace relief {
namespace {

Image render_sphere(Scene scene, const Light& light, int bounces = 0, int level = kAutoLevel) {
    test::aim_at_sphere(scene, light);
    RenderSettings settings = make_small_settings(96, 16, bounces);
    settings.image.layers = {"N"};
    settings.surface.level = level;
    return render(std::move(scene), settings).image;
}

float find_brightest(const Image& image) {
    float brightest = 0;
    const size_t green = image.find_channel("G").value();
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) brightest = std::max(brightest, image.at(x, y, green));
    return brightest;
}

void record(const char* name, const test::TerminatorError& error) {
    testing::Test::RecordProperty(std::string(name) + "_black", std::to_string(error.black));
    testing::Test::RecordProperty(std::string(name) + "_pixels", std::to_string(error.pixels));
    testing::Test::RecordProperty(std::string(name) + "_relative", std::to_string(error.relative));
}

/// Pixels whose normal is turned towards a sun, and those of them that get no light.
struct LitPixels {
    size_t lit = 0, black = 0;
};

LitPixels count_lit(const Image& image, const Light& sun) {
    const Vec3f to_sun = normalize(-sun.direction);
    const size_t n = image.find_channel("N.X").value(), green = image.find_channel("G").value();
    LitPixels pixels;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const Vec3f normal{image.at(x, y, n), image.at(x, y, n + 1), image.at(x, y, n + 2)};
            // Shorter ones are means over different surfaces.
            if (length(normal) < 0.99f || dot(normal, to_sun) < 0.05f) continue;
            ++pixels.lit, pixels.black += image.at(x, y, green) == 0;
        }
    return pixels;
}

TEST(Terminator, coarse_sphere_fades_like_a_fine_one) {
    for (const Light& light : {test::make_sun_at_right(), test::make_rectangle_at_right()}) {
        const Image right = render_sphere(test::make_sphere_scene(test::make_icosphere(5)), light);
        for (const int splits : {1, 2}) {
            const Image coarse = render_sphere(test::make_sphere_scene(test::make_icosphere(splits)), light);
            const test::TerminatorError error = test::measure_terminator(coarse, right);
            record(light.type == LightType::sun ? splits == 1 ? "sun_80" : "sun_320"
                   : splits == 1                ? "rectangle_80"
                                                : "rectangle_320",
                   error);
            EXPECT_GT(error.pixels, 400u);
            EXPECT_EQ(error.black, 0u) << splits;
            EXPECT_LT(error.relative, splits == 1 ? 0.05 : 0.015) << splits;
        }
    }
}

TEST(Terminator, displaced_patches_at_a_low_level_fade_like_fine_ones) {
    for (const Light& light : {test::make_sun_at_right(), test::make_rectangle_at_right()}) {
        const Image right = render_sphere(test::make_displaced_sphere(), light, 0, 6);
        for (const int level : {1, 2}) {
            const Image coarse = render_sphere(test::make_displaced_sphere(), light, 0, level);
            const test::TerminatorError error = test::measure_terminator(coarse, right);
            record(light.type == LightType::sun ? level == 1 ? "sun_1" : "sun_2"
                   : level == 1                 ? "rectangle_1"
                                                : "rectangle_2",
                   error);
            EXPECT_GT(error.pixels, 200u);
            EXPECT_EQ(error.black, 0u) << level;
            EXPECT_LT(error.relative, level == 1 ? 0.03 : 0.01) << level;
        }
    }
}

/// Faces of a base that are not subdivided stay as coarse as they are, however fine their cells are.
TEST(Terminator, displaced_faces_that_stay_flat_are_lit_as_their_normals_say_at_all_levels) {
    const Light sun = test::make_sun_at_right();
    for (const SubdivisionScheme scheme : {SubdivisionScheme::none, SubdivisionScheme::bilinear})
        for (const bool has_quads : {false, true})
            for (const int level : {kAutoLevel, 1, 3}) {
                const Mesh mesh = has_quads ? test::make_quad_sphere(4) : test::make_icosphere(1);
                const LitPixels pixels =
                    count_lit(render_sphere(test::make_flat_displaced(mesh, scheme), sun, 0, level), sun);
                EXPECT_GT(pixels.lit, 1500u);
                // Some at the outline; before, up to a tenth.
                EXPECT_LE(pixels.black, pixels.lit / 200) << has_quads << ' ' << level << ' ' << int(scheme);
            }
}

/// Pixels have no steps inside.
TEST(Terminator, automatic_levels_of_smooth_bases_stay_as_they_are) {
    RenderSettings settings = make_small_settings(64, 1, 0);
    const auto find = [&](Scene scene) {
        test::aim_at_sphere(scene, test::make_sun_at_right());
        return prepare_scene(std::move(scene), settings)->terminators;
    };
    const auto make_flat = [](Mesh mesh) {
        return test::make_flat_displaced(std::move(mesh), SubdivisionScheme::none);
    };
    EXPECT_EQ(find(test::make_displaced_sphere()), Terminators::none);
    EXPECT_EQ(find(make_flat(test::make_icosphere(3))), Terminators::all) << "a map of few texels";
    Scene fine = make_flat(test::make_icosphere(0));
    fine.displacements[0] =
        test::make_displacement(test::make_random_map(512, 512, 0, 1), DisplacementSpace::object);
    EXPECT_EQ(find(std::move(fine)), Terminators::bases);
    EXPECT_EQ(find(test::make_sphere_scene(make_floor(1))), Terminators::none);
    EXPECT_EQ(find(test::make_sphere_scene(test::make_icosphere(1))), Terminators::polygons);
    settings.surface.level = 2;
    EXPECT_EQ(find(test::make_displaced_sphere()), Terminators::all);
}

/// Light that a bounce ray finds too is shared between both; from below a triangle none can.
TEST(Terminator, light_is_the_same_whether_paths_go_on_or_not) {
    Scene scene = test::make_sphere_scene(test::make_icosphere(1));
    Light light = test::make_rectangle_at_right();
    light.width = 60, light.height = 50;
    const auto sum = [&](int bounces) {
        const Image image = render_sphere(scene, light, bounces);
        double total = 0;
        for (int y = 0; y < image.height; ++y)
            for (int x = 0; x < image.width; ++x) total += image.at(x, y, image.find_channel("G").value());
        return total;
    };
    const double alone = sum(0);
    EXPECT_NEAR(sum(1), alone, 0.005 * alone);
}

TEST(Terminator, the_dark_side_stays_dark) {
    const Light sun = test::make_sun_at_right();
    const Vec3f to_sun = normalize(-sun.direction);
    const Image image = render_sphere(test::make_sphere_scene(test::make_icosphere(1)), sun);
    size_t dark = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const size_t n = image.find_channel("N.X").value();
            const Vec3f normal{image.at(x, y, n), image.at(x, y, n + 1), image.at(x, y, n + 2)};
            // Normals are means over a pixel.
            if (normal == Vec3f{} || dot(normal, to_sun) > -0.03f) continue;
            ++dark;
            EXPECT_EQ(image.at(x, y, 1), 0) << x << ' ' << y;
        }
    EXPECT_GT(dark, 1000u);
}

TEST(Terminator, no_light_comes_into_a_closed_box_or_sphere) {
    for (const bool is_inside_sphere : {false, true}) {
        Scene scene = test::make_sphere_scene(test::make_icosphere(1));
        add_object(scene, is_inside_sphere ? test::make_icosphere(2) : make_sphere(1, SphereNormals::smooth),
                   make_matte(0.8f));
        for (Vec3f& p : scene.meshes[1].positions) p = p * (is_inside_sphere ? 8.0f : 12.0f);
        scene.environment.emplace();
        const Image image = render_sphere(scene, test::make_sun_at_right(), 2);
        EXPECT_EQ(find_brightest(image), 0) << is_inside_sphere;
    }
}

/// A sphere that touches a floor with a corner, seen there from close above the floor; light comes from below
/// it.
TEST(Terminator, no_light_comes_through_what_the_surface_touches) {
    Scene scene = test::make_sphere_scene(make_sphere(4, SphereNormals::smooth));
    add_object(scene, make_floor(200), make_matte(0.5f));
    scene.objects[1].world_from_object.translation.y = -1;
    scene.camera.from = {0, -0.96f, 4}, scene.camera.to = {0, -0.97f, 0}, scene.camera.fov_degrees = 10;
    for (const float slope : {0.02f, 0.1f, 0.3f, 0.5f, 3.0f}) {
        scene.lights.resize(1);
        scene.lights[0].direction = {-1, slope, 0.1f}, scene.lights[0].angle_degrees = 0;
        EXPECT_EQ(find_brightest(render(scene, make_small_settings(96, 16, 0)).image), 0) << slope;
        scene.lights[0].direction.y = -slope;
        EXPECT_GT(find_brightest(render(scene, make_small_settings(96, 16, 0)).image), 0) << slope;
    }
}

/// From outside into rough bodies, and from a light in the middle out of them.
TEST(Terminator, closed_displaced_bodies_stay_closed) {
    for (const int level : {kAutoLevel, 1, 2, 3})
        for (const bool is_inside : {false, true}) {
            Scene scene = test::make_body_scene(
                test::make_cube_sphere(2),
                test::make_displacement(test::make_random_map(64, 48, 0.12f, 3), DisplacementSpace::tangent));
            scene.materials.push_back(make_matte(0.8f)), scene.objects[0].material = 0;
            Light light;
            if (is_inside) {
                scene.camera.fov_degrees = 120;
                light.direction = {-1, -0.3f, 0.2f}, light.angle_degrees = 0;
                scene.environment.emplace();
            } else {
                scene.camera.from = {3, 1, 2}, scene.camera.to = {0, 0, 0};
                light.type = LightType::point, light.radius = 0.05f;
            }
            scene.lights = {light};
            RenderSettings settings = make_small_settings(96, 16, is_inside ? 2 : 0);
            settings.surface.level = level;
            EXPECT_EQ(find_brightest(render(scene, settings).image), 0) << level << ' ' << is_inside;
        }
}

/// One hit of a surface, and how far light from there is lifted.
class Lifts {
  public:
    Lifts(Scene scene, int level = kAutoLevel) {
        settings_.surface.level = level;
        prepared_ = prepare_scene(std::move(scene), settings_);
        tracer_.emplace(prepared_, settings_);
    }
    /// Of light from `to_light` at what a ray meets; nothing is met: -1.
    float find(const Vec3f& from, const Vec3f& direction, const Vec3f& to_light) {
        const cpu::TraceRay ray{from, 0, normalize(direction)};
        cpu::TraceHit hit;
        tracer_->closest_hits({&ray, 1}, {&hit, 1});
        if (!hit.is_hit()) return -1;
        point_ = tracer_->make_surface_point(hit);
        const bool is_behind = dot(point_.geometric_normal, ray.direction) > 0;
        const Vec3f lit = is_behind ? -point_.geometric_normal : point_.geometric_normal;
        const float lift = find_light_lift(*prepared_, hit, point_, {normalize(to_light), lit}, patches_);
        if (lift > 0) place_ = point_.position + lit * lift;
        return lift;
    }
    const cpu::SurfacePoint& point() const { return point_; }
    const Vec3f& place() const { return place_; }

  private:
    RenderSettings settings_;
    std::shared_ptr<const PreparedScene> prepared_;
    std::optional<cpu::Tracer> tracer_;
    PatchSamplesCache patches_;
    cpu::SurfacePoint point_;
    Vec3f place_{};
};

Vec3f draw_direction(std::mt19937& random) {
    const auto draw = [&] { return float(random()) / 2147483648.0f - 1; };
    for (;;) {
        const Vec3f v{draw(), draw(), draw()};
        if (dot(v, v) < 1 && dot(v, v) > 0.01f) return normalize(v);
    }
}

/// Light just before the terminator, which some triangles are turned away from.
Vec3f make_grazing_light(const Vec3f& normal, std::mt19937& random) {
    const Vec3f across = cross(normal, draw_direction(random));
    return normalize(across) + normal * 0.05f;
}

TEST(Terminator, rays_start_on_the_sphere_that_triangles_stand_for) {
    std::mt19937 random(5);
    Lifts sphere(test::make_sphere_scene(test::make_icosphere(1)));
    size_t lifted = 0;
    for (int k = 0; k < 4000; ++k) {
        const Vec3f p = draw_direction(random), to_light = make_grazing_light(p, random);
        const float lift = sphere.find(p * 3.0f, -p, to_light);
        ASSERT_GE(lift, 0);
        const bool is_below = dot(sphere.point().geometric_normal, to_light) <= 0;
        if (!is_below) EXPECT_EQ(lift, 0);
        if (lift == 0) continue;
        ++lifted;
        // Never below the sphere, and above it by no more than the fourth power of the half angle, 0.37.
        EXPECT_GE(length(sphere.place()), 1 - 2e-6f);
        EXPECT_LT(length(sphere.place()), 1.004f);
        // Inside, the surface is hollow.
        EXPECT_EQ(sphere.find({0, 0, 0}, p, -to_light), 0);
        EXPECT_EQ(sphere.find({0, 0, 0}, p, to_light), 0);
    }
    EXPECT_GT(lifted, 400u);
}

TEST(Terminator, places_follow_the_transform_of_an_object) {
    const Vec3f scale{2, 0.3f, -1};
    Scene scene = test::make_sphere_scene(test::make_icosphere(1)), stretched = scene;
    scene.objects[0].world_from_object = make_scale(scale);
    Mesh& mesh = stretched.meshes[0];
    for (Vec3f& p : mesh.positions) p = p * scale;
    for (Vec3f& n : mesh.normals) n = normalize(Vec3f{n.x / scale.x, n.y / scale.y, n.z / scale.z});
    Lifts by_transform(std::move(scene)), by_mesh(std::move(stretched));
    std::mt19937 random(6);
    size_t lifted = 0;
    for (int k = 0; k < 4000; ++k) {
        const Vec3f d = draw_direction(random), p = d * scale;
        const Vec3f n = normalize(Vec3f{d.x / scale.x, d.y / scale.y, d.z / scale.z});
        const Vec3f to_light = make_grazing_light(n, random);
        const float a = by_transform.find(p * 3.0f, -p, to_light), b = by_mesh.find(p * 3.0f, -p, to_light);
        if (a == 0 || b == 0) continue; // rounding decides for the very last light
        ++lifted;
        EXPECT_NEAR(a, b, 1e-3f * a + 1e-6f);
    }
    EXPECT_GT(lifted, 300u);
}

TEST(Terminator, flat_triangles_stay_as_they_are) {
    std::mt19937 random(7);
    Mesh mesh = test::make_icosphere(1);
    mesh.normals.clear(), mesh.normal_indices.clear();
    test::add_flat_normals(mesh);
    Scene scene = test::make_sphere_scene(mesh);
    Lifts flat(scene);
    for (int k = 0; k < 2000; ++k) {
        const Vec3f p = draw_direction(random);
        EXPECT_EQ(flat.find(p * 3.0f, -p, draw_direction(random)), 0);
    }
}

/// With the normals of a map the surface is as flat as without.
TEST(Terminator, normal_maps_lift_nothing) {
    Scene scene;
    Mesh floor = make_floor(1);
    test::add_flat_normals(floor);
    Material material = make_matte(0.8f);
    auto texture = std::make_shared<Texture>();
    texture->width = texture->height = 1, texture->channel_count = 3;
    texture->floats = {0.85f, 0.5f, 0.85f, 1};
    set_input_texture(material, MaterialInput::normal, texture);
    add_object(scene, std::move(floor), material);
    Light sun;
    sun.direction = {-1, 0.1f, 0}, sun.angle_degrees = 0;
    scene.lights = {sun};
    scene.camera.from = {0, 5, 1}, scene.camera.fov_degrees = 10;
    EXPECT_EQ(find_brightest(render(scene, make_small_settings(8, 4, 0)).image), 0);
    scene.lights[0].direction.y = -0.1f;
    EXPECT_GT(find_brightest(render(scene, make_small_settings(8, 4, 0)).image), 0);
}

} // namespace
} // namespace relief
