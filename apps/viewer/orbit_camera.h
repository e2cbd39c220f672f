// A camera that is turned, moved and flown by hand. Angles in radians, shifts in heights of the picture.
#pragma once

#include "relief/scene.h"

namespace relief::viewer {

class OrbitCamera {
  public:
    explicit OrbitCamera(const Camera& camera) { set(camera); }

    const Camera& get() const { return camera_; }
    /// A camera that looks nowhere (`from` equals `to`) looks along -z.
    void set(const Camera& camera);

    /// Turns about `to`: to the right about `up`, and upwards, but never over a pole.
    void orbit(float right, float up);
    /// Turns about `from`, as one looks around.
    void look(float right, float up);
    /// Moves what is seen at the distance of `to` by so many heights of the picture.
    void pan(float right, float up);
    /// Brings the camera to `factor` times its distance from `to`, above 0.
    void dolly(float factor);
    /// Moves along the axes of the view, in units of the distance from `to`.
    void fly(float right, float up, float forward);
    /// Puts a point into the middle of the picture, seen from the same side and distance, and the focus
    /// there.
    void focus(const Vec3f& point);
    /// Degrees, kept within [1, 170].
    void set_fov(float degrees);

    Vec3f right() const;
    Vec3f forward() const;
    Vec3f upward() const; ///< of the picture
    float distance() const;

  private:
    /// The angle upwards that keeps the view from the poles.
    float limit_turn(const Vec3f& direction, float up) const;
    void move(const Vec3f& shift);
    void keep_focus();

    Camera camera_;
    bool has_focus_at_target_ = true;
};

} // namespace relief::viewer
