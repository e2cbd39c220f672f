// Edits of a prepared scene between pictures: the editor alone may write, while nobody reads.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "prepare/prepared_scene.h"
#include "prepare/scene_parts.h"
#include "prepare/surface_change.h"
#include "relief/session.h"

namespace relief {

/// An edit that fits the scene it was checked against.
class CheckedEdit {
    friend class SceneEditor;
    explicit CheckedEdit(const MapEdit& edit) : edit_(edit) {}
    const MapEdit& edit_;
    std::vector<size_t> maps_; ///< of PreparedScene::maps, each texture once
};

/// Changes a scene in place, by edits of its maps: texels, bounds of maps and their smaller copies, the
/// camera, levels of instances, mips of patches; or as a whole, to what it is at another time. Not thread
/// safe.
class SceneEditor {
  public:
    /// As prepare_scene(). With SessionUse::edits maps are copied, as they may be shared; without apply() is
    /// not to be called. Meshes whose subdivision the view decides are kept; with SessionUse::scenes all
    /// meshes are, and change_scene() may be called. Error{usage} for tessellated surfaces.
    SceneEditor(Scene scene, const RenderSettings& settings, SessionUse use = SessionUse::edits);

    /// Changed by apply(), in place: no rays may be traced in it then.
    std::shared_ptr<const PreparedScene> scene() const { return scene_; }
    /// Of the scene and all edits since: names what a picture shows.
    uint64_t scene_hash() const { return hash_; }
    /// Surfaces that have been made from meshes so far.
    uint64_t made_surfaces() const { return parts_.made_surfaces; }

    /// Throws Error{bad_input} for an edit that does not fit. The result refers to `edit`.
    CheckedEdit check(const MapEdit& edit) const;

    /// What has changed then, one a surface.
    std::vector<SurfaceChange> apply(const CheckedEdit& edit);

    /// Another camera and size of the picture, which have been validated; the patches that read other copies
    /// of their maps for them. `scene_hash` as for Session::change_view.
    std::vector<SurfaceChange> change_view(const Camera& camera, const RenderSettings& settings,
                                           uint64_t scene_hash);

    /// As prepare_next_scene(). After an error the editor is of no use.
    std::optional<std::vector<SurfaceChange>> change_scene(Scene scene, const RenderSettings& settings);

  private:
    /// What a surface reads of an image, and where that has changed, in the image and its copies.
    struct Reading {
        uint32_t surface;
        TileIndex tile;
        std::vector<TexelRectangle> rectangles;
    };
    struct EditableMap {
        std::shared_ptr<Texture> texture;
        std::shared_ptr<BoundsPyramid> pyramid; ///< null: no surface reads the texture itself
    };

    void own_maps();
    size_t find_map(const MapEdit& edit) const;
    std::vector<size_t> find_copies(const MapEdit& edit) const;
    template <class Visit> void visit_users(const Texture& texture, const Visit& visit) const;
    void check_values(const MapEdit& edit, const Texture& map) const;
    void paint(const MapEdit& edit, size_t named, std::vector<Reading>& readings);
    void update_splines(const std::shared_ptr<const Texture>& texels, const TexelRectangle& changed,
                        std::vector<Reading>& readings);
    std::vector<SurfaceChange> find_changes(const std::vector<Reading>& readings) const;
    void extend_reach(uint32_t surface, std::vector<float>& reach) const;
    void find_different_patches(const std::vector<Reading>& readings, const std::vector<float>& reach,
                                SurfaceChange& change) const;
    void update_mips(std::vector<SurfaceChange>& changes);
    void update_levels(const std::vector<SurfaceChange>& changes);

    LodRule lod_;
    uint64_t hash_;
    SceneParts parts_; ///< without what only SessionUse::scenes needs, unless it is that
    std::shared_ptr<PreparedScene> scene_;
    std::vector<uint32_t> remade_; ///< surfaces that a change of the view has made, until it is done
    std::vector<std::shared_ptr<MipChain>> mips_;    ///< of PreparedScene::maps
    std::map<const Texture*, EditableMap> textures_; ///< by the texture itself
};

} // namespace relief
