// A scene that is looked at and changed: what of it differs from its files, and how it is saved.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "relief/io.h"
#include "relief/render.h"
#include "relief/scene.h"
#include "viewer/changed_fields.h"
#include "viewer/shared_scene.h"
#include "viewer/shot_reader.h"
#include "viewer/stroke_history.h"

namespace relief::viewer {

/// A scene file, or a mesh with its map and environment.
struct SceneInput {
    std::filesystem::path file;
    MeshSceneOptions mesh;
    std::optional<int> frame; ///< of a scene whose values have keys; nothing: its first one
};

struct LoadedInput {
    Scene scene;
    SharedMeshes meshes;              ///< of the scene
    std::shared_ptr<ShotReader> shot; ///< of a scene that differs from frame to frame, else null
    std::vector<int> frames;          ///< of the shot, as the file names them
    int frame = 1;                    ///< of the shot, that was read
    uint64_t content = 0;             ///< ShotFrame::content
    std::vector<std::string> doubts;  ///< what speaks against what was assumed about its maps
};

/// Throws as Shot and load_mesh_scene, and Error{usage} for a file that is neither scene nor mesh.
LoadedInput load_input(const SceneInput& input);

/// What another frame means for strokes, which belong to the map that they were painted on.
struct FrameStrokes {
    std::vector<Displacement> left;    ///< maps as they were painted and not saved, which the frame has not
    std::vector<std::string> returned; ///< names of maps that the frame has again, painted and not saved
    bool has_other_maps = false;       ///< of strokes before nothing can be taken back
};

class Document {
  public:
    /// `scene` as load_input read it. Maps whose names are not distinct get distinct ones.
    Document(SceneInput input, Scene scene)
        : Document(std::move(input), LoadedInput{std::move(scene), {}, nullptr, {}, 1, 0, {}}) {}
    Document(SceneInput input, LoadedInput loaded);

    const SceneInput& input() const { return input_; }
    /// LoadedInput::doubts, until a map's convention is changed.
    const std::vector<std::string>& doubts() const { return doubts_; }
    /// ShotFrame::content of what is shown; 0: the file has no frames.
    uint64_t content() const { return content_; }
    /// Another frame of the same file. What was changed stays changed; strokes stay where the frame has the
    /// map that they are on, others come back with it.
    FrameStrokes show_frame(ShotFrame next);
    /// Gives what something was at another frame what it has at this one, but for what was changed then.
    void follow_frame(SceneValue& value) const;
    /// Makes something that again; returns what it was before.
    SceneValue exchange(const SceneValue& value);
    /// Frames whose maps have strokes that are not saved, without the one that is shown; rising.
    std::vector<int> list_frames_aside() const;
    bool has_strokes_aside() const { return !list_frames_aside().empty(); }
    const Scene& scene() const { return scene_; }
    /// A copy, with all that was painted so far.
    std::shared_ptr<const SharedScene> snapshot();
    /// Grows with each change that a session does not follow.
    uint64_t version() const { return version_; }
    bool has_changes() const { return has_changes_; }
    bool is_saved() const { return is_saved_; } ///< save() was called since it was read
    /// Something was painted since the maps were saved last.
    bool has_painted() const { return !unsaved_.empty(); }
    bool has_painted(const std::string& map) const { return unsaved_.contains(map); }
    /// Grows with each change of texels to paint on.
    uint64_t paint_count() const { return paint_count_; }

    /// These return what it was before.
    SceneValue change_displacement(size_t index, const std::function<void(Displacement&)>& change);
    SceneValue change_material(size_t index, const std::function<void(Material&)>& change);
    SceneValue change_light(size_t index, const std::function<void(Light&)>& change);
    /// Nothing where there is none.
    std::optional<SceneValue> change_environment(const std::function<void(Environment&)>& change);
    /// A program's preset was chosen for a map: several have the same values.
    void note_preset(size_t displacement, const std::string& preset);
    /// The one whose values the map has now; empty: none.
    std::string find_preset(size_t displacement) const;
    /// With a mesh alone it is the light, placed as load_mesh_scene() does it; the environment of a scene
    /// keeps its strength and rotation. Throws as read_texture.
    void load_environment(const std::filesystem::path& file);
    /// The camera is no change that needs another session.
    void set_camera(const Camera& camera) { scene_.camera = camera; }

    /// Texels of a map's tile to paint on: of the place in memory that displacements share. Marks it as
    /// painted. Throws Error{usage} for a missing tile, and for a map that is dequantised.
    Texture& paint_tile(size_t displacement, int udim);
    /// New texels from its file, of the same size: no change that needs another session, if it is told of the
    /// edit. False where the size is another one.
    bool replace_tile(size_t displacement, int udim, Texture texels);
    /// Makes replace_tile() a change for sessions that take no edits.
    void note_replaced_tiles() { ++version_; }

    /// Writes a scene file with the picture of these settings, and painted maps beside it, `STEM_NAME.exr`,
    /// or `STEM_NAME-2.exr` where that is a file which this document did not write, or of another frame.
    /// Returns all files written. Throws as save_scene_copy and write_map.
    std::vector<std::filesystem::path> save(const std::filesystem::path& file, const ImageSettings& image);
    /// Writes a map in the convention of `to`, whose tiles are ignored. Throws as convert_map and write_map,
    /// and Error{usage} for a file that is there already and that this document did not write.
    void save_map(size_t displacement, const std::filesystem::path& file, const Displacement& to);

  private:
    using TileKey = const Texture*;
    /// A tile of a map by name and number, and what it was read from: its file, else its frame.
    using TilePlace = std::pair<std::string, int>;
    using TileSource = std::pair<TilePlace, std::string>;
    struct AsideTile {
        std::shared_ptr<const Texture> texture;
        bool is_saved = false;
        int frame = 1; ///< where it was shown last
    };

    void note_read_maps();
    void note_read_values(const Scene& scene);
    SceneValue put_back(const Displacement& was, size_t index);
    SceneValue put_back(const Material& was, size_t index);
    SceneValue put_back(const Environment& was, size_t index);
    SceneValue put_back(const Light& was, size_t index);
    std::string name_source(const Texture& texture) const;
    void put_aside(const Scene& next, FrameStrokes& strokes);
    void take_back(Scene& next, FrameStrokes& strokes);
    void touch();
    void place_light(Environment sky);
    /// Puts what was painted into the scene.
    void commit();
    /// No file of a map is there, or this document wrote it for that map of that frame. `pattern` holds
    /// `<UDIM>` where the map has tiles.
    bool may_write(const std::filesystem::path& pattern, const Displacement& map) const;
    void note_written(const std::filesystem::path& pattern, const Displacement& map);
    /// The name that a painted map is written to, beside the scene file.
    std::filesystem::path name_painted(const Displacement& map,
                                       const std::filesystem::path& scene_file) const;
    std::filesystem::path save_painted(const Displacement& map, const std::filesystem::path& scene_file);

    SceneInput input_;
    Scene scene_;
    SharedMeshes meshes_; ///< of the scene
    uint64_t content_ = 0;
    ChangedFields changed_;
    std::vector<Displacement> read_maps_; ///< as the file has them at this frame, as the next three
    std::vector<Material> read_materials_;
    std::vector<Light> read_lights_;
    std::optional<Environment> read_environment_;
    std::map<TilePlace, std::shared_ptr<const Texture>> read_; ///< as the reader gave them
    std::map<TileSource, AsideTile> aside_;                    ///< painted maps of other frames
    std::map<std::string, std::string> presets_; ///< that were chosen last, by names of displacements
    std::vector<std::string> doubts_;
    uint64_t version_ = 1;
    bool has_changes_ = false, is_saved_ = false;
    SceneChanges changes_;
    /// Texels being painted, by the texture that the scene holds in their place.
    std::map<TileKey, std::unique_ptr<Texture>> painted_;
    std::set<TileKey> uncommitted_;
    std::set<std::string> painted_maps_;                   ///< names of displacements, since they were read
    std::set<std::string> unsaved_;                        ///< of these, since they were saved
    std::map<std::filesystem::path, std::string> written_; ///< files of maps, and name_source() of each
    uint64_t paint_count_ = 0;
};

/// Names tell maps apart in edits and in files.
void make_names_distinct(std::vector<Displacement>& maps);

/// The file of a tile of a map; `pattern` may hold `<UDIM>`.
std::filesystem::path name_tile(const std::filesystem::path& pattern, int udim);

/// Finds an object with that displacement; its mesh gives the frames. Null: none.
const Mesh* find_mesh(const Scene& scene, size_t displacement);

} // namespace relief::viewer
