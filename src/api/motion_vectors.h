// The layer motion: how far what is seen moves over the picture while the shutter is open.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/engine.h"
#include "formulas/camera.h"
#include "prepare/prepared_scene.h"

namespace relief {

/// What the middles of the pixels of a window see at the time of the picture, and where it is at others.
class MotionVectors {
  public:
    static constexpr size_t kRaysOfACall = size_t(1) << 20; ///< 64 bytes each

    /// By an engine of the scene as it is then, pinhole rays, as many rows at a time as have about so many
    /// rays: it keeps 16 bytes a pixel.
    MotionVectors(const Engine& engine, const PreparedScene& scene, const Window& window,
                  size_t rays_of_a_call = kRaysOfACall);

    /// Where it is on the picture of the scene at another time, pixels; NaN: that scene has it no longer, or
    /// it lies behind its camera.
    std::vector<Vec2f> find_places(const PreparedScene& scene) const;

  private:
    /// Where a ray ends; kNoIndex: nowhere.
    struct Place {
        uint32_t object = kNoIndex, patch = kNoIndex;
        Vec2f uv{};
    };

    Vec3f find_direction(size_t pixel) const;

    Window window_;
    scalar::CameraFrame camera_; ///< at the time of the picture
    std::vector<Place> seen_;    ///< row by row
};

} // namespace relief
