// A scene document at one time after another: what is as it was is neither evaluated nor read again.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "io/scene/asset_cache.h"
#include "io/scene/file_sequence.h"
#include "io/scene/json_node.h"
#include "io/scene/keyed_values.h"
#include "io/scene/scene_parts.h"
#include "io/scene/scene_reader.h"
#include "relief/io.h"
#include "relief/scene.h"
#include "relief/shot.h"

namespace relief {

class FrameReader {
  public:
    /// `name` of the document is for messages.
    FrameReader(Json document, std::string name, AssetCache assets, const MeshReaderSettings& reader);
    FrameReader(const FrameReader&) = delete;
    FrameReader& operator=(const FrameReader&) = delete;

    /// Goes on with the pictures of a reader of another document, which is of no use then, and with `given`.
    void take_over_pictures(FrameReader& before, SceneAssets given);

    const std::vector<int>& frames() const { return frames_; }
    bool is_animated() const { return is_animated_; }

    /// As Shot has them; the first three throw as load_scene.
    Scene load(double frame);
    SceneUpdate update(double frame);
    std::optional<Shot::View> find_view(double frame);
    /// Names of the files that a frame with its shutter reads, each once.
    std::vector<std::string> list_names(double frame);

  private:
    /// What is known of the scene at a time. A copy goes on for itself.
    struct State {
        SceneReader reader;
        std::vector<Json> parts; ///< those that move, in the order of `moving_`
        std::vector<uint64_t> part_hashes;
        uint64_t document_hash = 0;
    };
    /// Of sequences: `strict` at whole frames, where each has its file; `held` where the shutter may be open
    /// before the first and after the last.
    enum class Ends { strict, held };

    static Ends choose_ends(double frame);
    SequenceFiles find_files(const std::string& pattern, double frame, FileUse use, Ends ends);
    NameFile make_namer(Ends ends);
    std::vector<Json> evaluate_parts(double frame, Ends ends);
    bool is_view(const State& state, const std::vector<Json>& parts) const;
    Scene load_at(double frame, Ends ends);
    Scene load_still();
    void move(State& state, std::vector<Json> parts);
    static uint64_t hash_now(State& state);
    uint64_t hash_shutter(const State& state, uint64_t hash, double frame);
    void forget(const Camera& camera, double frame);

    Json document_;
    std::string name_;
    MeshReaderSettings reader_;
    AssetCache assets_;
    FileSequences sequences_;
    std::vector<int> frames_;
    bool is_animated_ = false;
    bool has_moving_sections_ = false;
    std::vector<ScenePart> moving_;
    std::optional<Shot::View> still_; ///< of a document without keys, once loaded
    std::optional<State> state_;      ///< as returned last; empty: nothing is, or it cannot be gone on from
};

} // namespace relief
