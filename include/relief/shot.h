// Shots: scene files whose values change from frame to frame. In library relief_io.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "relief/io.h"
#include "relief/scene.h"

namespace relief {

inline constexpr int kMaxFrame = 1000000;     ///< of a frame's number
inline constexpr size_t kMaxFrames = 1000000; ///< of one list

/// Numbers of frames, "1-100x2,150": from 1 to 100 every second one, and 150. In that order, each once.
/// Throws Error{usage}.
std::vector<int> parse_frames(std::string_view text);

/// `####` in the name of a file becomes the frame's number, with at least as many digits; where there are no
/// two `#` in a row, ".0001" comes before the extension. A name that has this frame's ".0001" there stays.
std::filesystem::path name_frame(const std::filesystem::path& pattern, int frame);

/// A scene file and its frames. Not thread safe.
class Shot {
  public:
    /// Reads the file, but none that it names. Throws as load_scene.
    explicit Shot(const std::filesystem::path& file, const MeshReaderSettings& reader = {});
    /// Of text, as parse_scene_text takes it; a mesh in `assets` is used up by the first call of load().
    Shot(std::string_view text, const std::filesystem::path& folder, SceneAssets assets,
         const MeshReaderSettings& reader = {});
    ~Shot();

    /// Goes on with another text, which may leave out meshes. Pictures that were read stay read, unless their
    /// files have changed or `assets` has another texture under their name. Throws as the constructor, and
    /// changes nothing then.
    void change_text(std::string_view text, SceneAssets assets);
    Shot(Shot&&) noexcept;
    Shot& operator=(Shot&&) noexcept;

    /// `render.frames` of the file; may be empty.
    const std::vector<int>& frames() const;
    /// Whether any value or file depends on the frame.
    bool is_animated() const;

    /// The scene file and all files that a frame reads, those beside it that its shutter sees too; reads none
    /// of them. Throws Error{bad_input} for one that is not there.
    std::vector<std::filesystem::path> list_files(double frame) const;

    /// The scene at a frame, which may lie between two: values and the numbered files of displacements and
    /// meshes are blended linearly there, halves to halves; other numbered files are those of the whole part.
    /// Between frames the first and the last file of a sequence last. Scene::hash of a whole frame with an
    /// open shutter is of all that the shutter sees. Textures of the last call are not read again. Throws as
    /// load_scene.
    Scene load(double frame);

    /// The same as what differs from what load() or update() returned last: all of it where that was
    /// nothing. Reads no file twice for times less than a shutter apart. The first and last files of
    /// sequences last at all times. Throws as load_scene, and the next call returns all of the scene; values
    /// that fit for themselves but not together, such as the names of linked objects, are left to whoever
    /// takes the scene.
    SceneUpdate update(double frame);

    /// What a frame has for itself if all else is as load() returned it last.
    struct View {
        Camera camera;
        uint64_t scene_hash = 0; ///< that of load() at that frame
    };
    /// nullopt: more than the camera differs from what load() returned last. Throws as load_scene.
    std::optional<View> find_view(double frame) const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

} // namespace relief
