// Pictures of a scene that stays prepared while its camera moves, or time goes on.
#pragma once

#include <optional>
#include <string>

#include "finish_picture.h"
#include "relief/scene.h"
#include "relief/shot.h"
#include "render_warnings.h"

namespace relief::cli {

class PictureSeries {
  public:
    /// `shot`: whose frames they are; null: nothing but the camera moves. Both outlive this.
    explicit PictureSeries(const RenderOptions& options, Shot* shot = nullptr)
        : options_(options), shot_(shot) {}

    /// The scene of the next picture. Warnings that an earlier one had are not told again.
    void hold(Scene scene, const RenderSettings& settings);
    /// The same of a scene that is prepared, as it differs from that before.
    void hold(SceneUpdate update, const RenderSettings& settings);
    /// Frees what the last scene takes.
    void let_go() { session_.reset(), scene_.reset(), update_.reset(); }
    /// Whether the next picture may be of what is prepared. Far from the origin, pictures depend a little on
    /// the camera of the session's first one.
    bool can_keep_scene() const { return scene_ || (session_ && !session_->is_far_away()); }
    const RenderSettings& settings() const { return settings_; }

    /// Renders and writes one, whose progress begins with `step`, with motion blur where the shutter is open;
    /// returns the exit code.
    int show(const Shot::View& view, int frame, const std::filesystem::path& output, const std::string& step,
             const PendingTimes& waiting);

  private:
    int show_alone(const Shot::View& view, const std::filesystem::path& output, const std::string& step,
                   const PendingTimes& waiting);
    void prepare(const Shot::View& view, int frame);

    const RenderOptions& options_;
    Shot* shot_;
    RenderSettings settings_;
    std::optional<Scene> scene_;        ///< not prepared yet, or tessellated
    std::optional<SceneUpdate> update_; ///< not prepared yet
    std::optional<Session> session_;
    ToldWarnings told_;
};

} // namespace relief::cli
