// A scene that stays ready between pictures while its displacement maps are painted.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "relief/render.h"
#include "relief/scene.h"

namespace relief {

/// New texels for a rectangle of a displacement map.
struct MapEdit {
    std::string displacement; ///< its name in the scene
    int udim = 1001;          ///< its tile
    uint32_t x = 0, y = 0;    ///< where the first texel goes: column and row, row 0 at the top
    Texture texels;           ///< raw values, as in the map's file
};

/// What an edit cost.
struct EditReport {
    uint64_t patches = 0; ///< patches that were made ready anew, of all surfaces with that map
    double seconds = 0;
};

/// Keeps surfaces, trees and the cache of fine geometry from picture to picture. After an edit only what the
/// rectangle reaches is made anew: its part of the bounds of the map, levels and boxes of the patches that
/// read it, the nodes above them and their fine geometry; and of the next picture the blocks of pixels whose
/// rays came near them. The CPU engine's own walk does so; engines and structures asked for by name make
/// their trees, device buffers and pictures anew. Pictures are those that the edited map gives when it is
/// loaded, bit for bit, as long as what lies between its uv islands keeps its background, which is found when
/// the session begins (Displacement::dilate). Not thread safe.
class Session {
  public:
    /// Maps are held as copies of the scene's. Throws as render(), and Error{usage} for tessellated surfaces.
    Session(Scene scene, const RenderSettings& settings);
    ~Session();
    Session(Session&&) noexcept;
    Session& operator=(Session&&) noexcept;

    /// The next picture. Its `prepare_s` is what came since the last one: making the session, or edits. Rays,
    /// trees and times of stages are counted from the session's start.
    RenderResult render(RenderObserver* observer = nullptr);

    /// Every displacement that uses the same image follows. Throws Error{bad_input} for a name or tile that
    /// is not there, a rectangle that leaves the map, a value that is not finite or displaces beyond 1e18:
    /// nothing is changed then.
    EditReport edit(const MapEdit& edit);

    /// Throws what edit() would; nothing is changed.
    void check(const MapEdit& edit) const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

} // namespace relief
