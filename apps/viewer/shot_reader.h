// Reads frames of a scene file; of a frame only what differs from the one before.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <vector>

#include "relief/io.h"
#include "relief/shot.h"
#include "viewer/file_watch.h"
#include "viewer/shared_scene.h"

namespace relief::viewer {

struct ShotFrame {
    int frame = 1;
    uint64_t content = 0; ///< the same one where frames differ by the camera alone; never 0
    Camera camera;
    std::optional<Scene> scene; ///< nothing: its content is known already
    SharedMeshes meshes;        ///< of the scene; those that have stayed are those of earlier frames
};

/// Not thread safe.
class ShotReader {
  public:
    /// Throws as Shot.
    explicit ShotReader(const std::filesystem::path& file, const MeshReaderSettings& reader = {})
        : file_(file), reader_(reader), shot_(file, reader) {}

    const std::vector<int>& frames() const { return shot_.frames(); }
    bool is_animated() const { return shot_.is_animated(); }

    /// `known`: content that the caller has. Files that were written since a frame read them are read again.
    /// Throws as Shot::update, and as Shot::list_files for a numbered file that is not there, before the
    /// first one and after the last too.
    ShotFrame read(int frame, uint64_t known = 0);

  private:
    void drop_rewritten_files(int frame);

    std::filesystem::path file_;
    MeshReaderSettings reader_;
    Shot shot_;
    std::map<std::filesystem::path, FileStamp> stamps_; ///< of files as they were read
    SharedScene last_;
    uint64_t content_ = 0;
};

} // namespace relief::viewer
