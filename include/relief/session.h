// Interactive rendering and shots: a scene that stays prepared between pictures while its displacement maps
// are edited, its camera moves, or time goes on.
#pragma once

#include <cstdint>
#include <functional>
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
/// `scenes`: the scene at other times, whose maps are shared and take no edits; meshes are kept.
enum class SessionUse { edits, views, scenes };

/// The scene at a frame, which may lie between two, as it differs from that of the call before.
using UpdateScene = std::function<SceneUpdate(double frame)>;

/// When sample k of a picture of a frame sees the scene: frames, while the camera's shutter is open. Evenly
/// spread for any run of samples: multiples of the golden ratio (Weyl 1916), the first in the middle.
double find_sample_time(const Camera& camera, double frame, int sample);

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
    /// Copies the maps of the scene. Throws as render(), Error{usage} for SurfaceMode::tessellated, and
    /// Error{failed} where `observer` cancels, which may be null.
    Session(Scene scene, const RenderSettings& settings, SessionUse use = SessionUse::edits,
            RenderObserver* observer = nullptr);
    ~Session();
    Session(Session&&) noexcept;
    Session& operator=(Session&&) noexcept;

    /// Renders the next picture. Its `prepare_s` covers the work since the last one: construction, or edits.
    /// Rays, trees and stage times accumulate over the session. Throws as relief::render(), and Error{failed}
    /// where the observer cancels while trees that a change has cost are built.
    RenderResult render(RenderObserver* observer = nullptr);

    /// Replaces texels in all displacements that share the image. Throws Error{bad_input}, and changes
    /// nothing, for an unknown name or tile, a rectangle outside the map, and values that are not finite or
    /// displace by more than 1e18 scene units.
    EditReport edit(const MapEdit& edit);

    /// The next picture is of another view of the scene, all of it traced anew. The CPU engine's default
    /// traversal keeps its trees; others are made anew. `image` may differ from that of the session in all
    /// but its layers; `scene_hash` names what it shows as Scene::hash does, 0: made of the old one and the
    /// camera. Throws as render(), and Error{usage} for other layers; nothing changes then, but that an
    /// engine which failed is made anew by the next call. Error{failed} where `observer` cancels: another
    /// change has to come then. The picture is that of a fresh session bit for bit; where is_far_away(), up
    /// to rounding.
    /// Subdivision surfaces with automatic levels are made anew if the view needs other patches; until then
    /// an edit of their map leaves their patches as they were.
    void change_view(const Camera& camera, const ImageSettings& image, uint64_t scene_hash = 0,
                     RenderObserver* observer = nullptr);

    /// The next picture is of the scene at another time; of a session for `scenes`. What has not changed
    /// stays prepared, on the CPU engine's default traversal with its trees; meshes, displacements and
    /// materials are known by their names. `image` as for change_view(), as is what the picture is bit for
    /// bit. Throws as render(), Error{usage} for another use, Error{failed} where `observer` cancels before
    /// the scene is there. After an error of the scene or a cancel the session keeps what it had prepared,
    /// and "as before" goes on to mean the scene before; it has no picture until another call, with
    /// SceneUpdate::scene, has succeeded.
    void change_scene(SceneUpdate update, const ImageSettings& image, RenderObserver* observer = nullptr);

    /// Renders a picture with motion blur: all rays of sample k see the scene at
    /// find_sample_time(camera, frame, k), so that the picture is the mean of still ones at these times, bit
    /// for bit. The session shows the scene of `frame` now, and that of the last sample afterwards. Patches
    /// that move are built for each time, others keep their trees. A picture that was cancelled has whole
    /// samples, but for the last one, which blocks of pixels may lack. Throws as change_scene().
    RenderResult render_moving(double frame, const UpdateScene& update, RenderObserver* observer = nullptr,
                               const Checkpoints& checkpoints = {});

    /// Some object lies so far from the world's origin that places may be taken relative to the first camera.
    bool is_far_away() const;

    /// Surfaces that have been made from meshes so far: objects that share a mesh and a displacement share
    /// one, and what a change keeps is not made again.
    uint64_t made_surfaces() const;

    /// Throws what edit() would throw; changes nothing.
    void check(const MapEdit& edit) const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

} // namespace relief
