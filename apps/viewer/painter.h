// Strokes of a brush on the displacement maps of a document.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "relief/session.h"
#include "viewer/brush.h"
#include "viewer/dab.h"
#include "viewer/document.h"
#include "viewer/stroke_history.h"
#include "viewer/surface_point.h"
#include "viewer/texel_frames.h"

namespace relief::viewer {

class Painter {
  public:
    /// The document must outlive this object.
    explicit Painter(Document& document) : document_(document) {}

    /// Begins a stroke where a picture shows a displaced surface; (x, y) in pixels of the whole picture. The
    /// edits are for the session that shows the document. Throws as Document::paint_tile and convert_map.
    std::vector<MapEdit> begin(const Brush& brush, const ShownPicture& picture, float x, float y);
    /// The stroke goes on to (x, y): along the object that it began on.
    std::vector<MapEdit> move(const ShownPicture& picture, float x, float y);
    void end();
    bool is_active() const { return object_ != kNoIndex; }

    bool can_undo() const { return history_.can_undo(); }
    bool can_redo() const { return history_.can_redo(); }
    bool has_strokes() const { return history_.has_strokes(); }
    /// As StrokeHistory::note_value.
    void note_value(const SceneValue& before, bool is_new) { history_.note_value(before, is_new); }
    /// Without edits where the step was no stroke: the document has it then.
    std::vector<MapEdit> undo();
    std::vector<MapEdit> redo();
    /// Of maps that were replaced nothing can be taken back.
    void forget() { history_.clear(), frames_.clear(), places_.clear(); }
    /// Of the environment and lights that were replaced.
    void forget_lighting() { history_.forget_lighting(); }
    /// Meshes were replaced, and values have followed their keys.
    void follow_frame() {
        frames_.clear(), places_.clear();
        history_.change_values([&](SceneValue& value) { document_.follow_frame(value); });
    }

  private:
    const Object& object() const { return document_.scene().objects[object_]; }
    const Displacement& map() const { return document_.scene().displacements[object().displacement]; }
    void dab_at(const ShownPicture& picture, float x, float y);
    Texture& paint(const DabPiece& piece);
    std::vector<DabPiece> find_pieces(const ShownPicture& picture, const SurfacePoint& point);
    /// What a shift of the surface in the world adds to values of the map.
    Vec3f find_step(const Vec3f& shift_world, const SurfacePoint& point, int udim);
    void apply(const std::vector<DabPiece>& pieces, const SurfacePoint& point);
    void smooth(const std::vector<DabPiece>& pieces);
    std::vector<MapEdit> grab(const ShownPicture& picture, float x, float y);
    SceneValue exchange(const SceneValue& value);
    void note_change(const TilePlace& place, const TexelBox& box);
    std::vector<MapEdit> take_edits();

    Document& document_;
    StrokeHistory history_;
    /// By displacement, mesh and whether rows go along v.
    std::map<std::tuple<uint32_t, uint32_t, bool>, std::unique_ptr<TexelFrames>> frames_;
    std::map<uint32_t, std::unique_ptr<TexelPlaces>> places_; ///< by object
    Brush brush_;
    uint32_t object_ = kNoIndex; ///< that a stroke is on; none: no stroke
    Vec2f last_{};               ///< pixels of the whole picture
    std::optional<SurfacePoint> start_;
    int start_udim_ = 1001;
    std::vector<DabPiece> grabbed_;
    std::vector<Texture> before_grab_;                    ///< texels of each piece
    std::vector<std::pair<TilePlace, TexelBox>> changed_; ///< since the last edits
};

} // namespace relief::viewer
