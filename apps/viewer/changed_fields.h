// What a user changed of a scene, field by field, so that it stays changed at other frames, while all else
// follows its keys.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>

#include "relief/scene.h"

namespace relief::viewer {

class ChangedFields {
  public:
    using Fields = uint32_t; ///< a bit each

    /// `read`: as the file has it at this frame; what is that again counts as changed no more.
    void note(const Displacement& before, const Displacement& after, const Displacement& read);
    void note(const Material& before, const Material& after);
    void note(const Environment& before, const Environment& after);
    void note(size_t light, const Light& before, const Light& after);

    /// Gives `to`, the same scene at another frame, the fields of `from` that were changed: of displacements
    /// and materials by their names, of lights by their numbers where there are as many.
    void carry(const Scene& from, Scene& to) const;
    /// Of one of these, or the one with that number, to be put back; of the environment without its texture.
    Fields& of(const Displacement& map, size_t) { return displacements_[map.name]; }
    Fields& of(const Material& material, size_t) { return materials_[material.name]; }
    Fields& of(const Environment&, size_t) { return environment_; }
    Fields& of(const Light&, size_t light) { return lights_[light]; }
    static void copy(const Displacement& from, Displacement& to, Fields fields);
    static void copy(const Material& from, Material& to, Fields fields);
    static void copy(const Environment& from, Environment& to, Fields fields);
    static void copy(const Light& from, Light& to, Fields fields);

  private:
    std::map<std::string, Fields> displacements_, materials_;
    std::map<size_t, Fields> lights_;
    Fields environment_ = 0;
    bool has_own_texture_ = false; ///< the environment
};

} // namespace relief::viewer
