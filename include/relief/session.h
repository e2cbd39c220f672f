// Interactive rendering: a scene that stays prepared between pictures while its displacement maps are edited
// and its camera moves.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "relief/render.h"
#include "relief/scene.h"

namespace relief {

/// New texels for a rectangle of a displacement map.
struct MapEdit {
    std::string displacement; ///< name in the scene
    int udim = 1001;          ///< UDIM number of the tile
    uint32_t x = 0, y = 0;    ///< column and row of the first texel, row 0 at the top
    Texture texels;           ///< raw values in the map's encoding
};

/// What comes between pictures. `views`: cameras; pictures cost less then, but an edit costs a whole one.
enum class SessionUse { edits, views };

/// Cost of an edit.
struct EditReport {
    uint64_t patches = 0; ///< patches that were updated, of all surfaces with that map
    double seconds = 0;
};

/// Keeps surfaces, trees and the patch tree cache between pictures. An edit updates only what reads the
/// rectangle: its part of the map's bounds pyramid, levels and boxes of the affected patches, the nodes above
/// them and their patch trees; the next picture traces only the blocks of pixels whose rays came near them.
/// This holds for the CPU engine's default traversal; other engines, structures and traversals rebuild trees,
/// device buffers and the whole picture. Pictures are bit-identical to those of a freshly loaded edited map,
/// as long as the texels between uv islands keep their background value, which is determined when the session
/// begins (Displacement::dilate). Not thread safe.
class Session {
  public:
    /// Copies the maps of the scene. Throws as render(), and Error{usage} for SurfaceMode::tessellated.
    Session(Scene scene, const RenderSettings& settings, SessionUse use = SessionUse::edits);
    ~Session();
    Session(Session&&) noexcept;
    Session& operator=(Session&&) noexcept;

    /// Renders the next picture. Its `prepare_s` covers the work since the last one: construction, or edits.
    /// Rays, trees and stage times accumulate over the session. Throws as relief::render().
    RenderResult render(RenderObserver* observer = nullptr);

    /// Replaces texels in all displacements that share the image. Throws Error{bad_input}, and changes
    /// nothing, for an unknown name or tile, a rectangle outside the map, and values that are not finite or
    /// displace by more than 1e18 scene units.
    EditReport edit(const MapEdit& edit);

    /// The next picture is of another view of the scene, all of it traced anew. The CPU engine's default
    /// traversal keeps its trees; others are made anew. `image` may differ from that of the session in all
    /// but its layers; `scene_hash` names what it shows as Scene::hash does, 0: made of the old one and the
    /// camera. Throws as render(), and Error{usage} for other layers; nothing changes then, but that an
    /// engine which failed is made anew by the next call. The picture is that of a fresh session bit for bit;
    /// where is_far_away(), up to rounding.
    void change_view(const Camera& camera, const ImageSettings& image, uint64_t scene_hash = 0);

    /// Some object lies so far from the world's origin that places may be taken relative to the first camera.
    bool is_far_away() const;

    /// Throws what edit() would throw; changes nothing.
    void check(const MapEdit& edit) const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

} // namespace relief
