// What every sample scene stands on and is lit by.
#pragma once

#include <string>
#include <vector>

#include "relief/samples.h"
#include "samples/models.h"

namespace relief::samples {

/// A scene while it grows: adds models once and objects that use them.
class Stage {
  public:
    explicit Stage(Instancing instancing) : instancing_(instancing) {}

    /// Takes a model in; returns its index.
    uint32_t add_model(const Model& model);

    /// An object of a model: with Instancing::none its mesh is its own, shaped by `deform`; else shared.
    void add_displaced(uint32_t model, const std::string& name, const Affine& world_from_object,
                       const Deformation& deform);

    /// The last object takes its model's material with colours multiplied by `tint`, in [0, 1].
    void tint_last(uint32_t model, const std::string& name, const Vec3f& tint);

    /// The last object takes a material of its own.
    void paint_last(const Material& material);

    /// A plain object with its mesh.
    void add_plain(Mesh mesh, const std::string& name, const Material& material,
                   const Affine& world_from_object);

    /// Another object with the mesh and material of the plain object added last.
    void repeat_plain(const std::string& name, const Affine& world_from_object);

    struct Sun {
        float azimuth_degrees = 40; ///< from -z towards +x, where the sun stands
        float height_degrees = 35;  ///< above the horizon
        Vec3f color{1.0f, 0.86f, 0.68f};
        float strength = 3.0f;
    };
    /// Sun, the sky that goes with it, and a wide ground at y = `ground_y`.
    void light(const Sun& sun);
    void add_ground(float y, float half_size, const Vec3f& color);

    Scene finish(const Vec3f& from, const Vec3f& to, float fov_degrees);

  private:
    uint32_t add_material(const Material& material);
    uint32_t add_mesh(Mesh mesh, const std::string& name);

    Instancing instancing_;
    Scene scene_;
    struct Entry {
        Model model;
        uint32_t displacement = 0, material = 0, mesh = kNoIndex;
    };
    std::vector<Entry> models_;
};

/// Direction towards a place of the sky, y up; azimuth from -z towards +x.
Vec3f sky_direction(float azimuth_degrees, float height_degrees);

/// Latitude-longitude radiance of a clear evening: warm about the sun, blue above, a soft ground below.
std::shared_ptr<const Texture> make_sky(const Vec3f& to_sun, const Vec3f& sun_color);

/// Small bends and stretches, another for every seed; 0 leaves all as it is.
Deformation make_variation(uint32_t seed, float amount);

/// Translation x rotation about y (then tilt about x) x uniform scale.
Affine place(const Vec3f& position, float scale, float turn_degrees, float tilt_degrees = 0);

} // namespace relief::samples
