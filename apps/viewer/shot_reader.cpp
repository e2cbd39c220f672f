#include "viewer/shot_reader.h"

#include <memory>
#include <utility>

namespace relief::viewer {

namespace {

/// Takes meshes that were left out from those before.
SharedMeshes take_meshes(std::vector<Mesh> meshes, const SharedMeshes& before) {
    SharedMeshes shared;
    for (size_t k = 0; k < meshes.size(); ++k) {
        const bool is_left_out = meshes[k].positions.empty() && meshes[k].face_sizes.empty();
        shared.push_back(is_left_out && k < before.size()
                             ? before[k]
                             : std::make_shared<const Mesh>(std::move(meshes[k])));
    }
    return shared;
}

} // namespace

/// Of those that a frame reads, before it does.
void ShotReader::drop_rewritten_files(int frame) {
    std::map<std::filesystem::path, FileStamp> now;
    bool has_changed = false;
    for (const std::filesystem::path& file : shot_.list_files(frame)) {
        if (file == file_) continue; // whoever watches it says what becomes of changes
        now[file] = read_stamp(file);
        const auto known = stamps_.find(file);
        has_changed |= known != stamps_.end() && known->second != now[file];
    }
    if (has_changed) shot_ = Shot(file_, reader_), stamps_.clear();
    stamps_.merge(now);
}

ShotFrame ShotReader::read(int frame, uint64_t known) {
    // Also since update() takes the last file where there is none.
    if (shot_.is_animated()) drop_rewritten_files(frame);
    SceneUpdate update = shot_.update(frame);
    if (update.scene) {
        last_.meshes = take_meshes(std::exchange(update.scene->meshes, {}), last_.meshes);
        last_.scene = std::move(*update.scene);
        ++content_;
    }
    last_.scene.camera = update.camera;
    last_.scene.hash = update.scene_hash;
    ShotFrame result{frame, content_, update.camera, std::nullopt, {}};
    if (content_ == known) return result;
    result.scene = make_whole(last_);
    result.meshes = last_.meshes;
    return result;
}

} // namespace relief::viewer
