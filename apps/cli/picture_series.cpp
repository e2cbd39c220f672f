#include "picture_series.h"

#include <utility>

#include "render_motion.h"

namespace relief::cli {

void PictureSeries::hold(Scene scene, const RenderSettings& settings) {
    scene_ = std::move(scene), settings_ = settings;
}

void PictureSeries::hold(SceneUpdate update, const RenderSettings& settings) {
    update_ = std::move(update), settings_ = settings;
}

/// Tessellated surfaces are made for one view.
int PictureSeries::show_alone(const Shot::View& view, const std::filesystem::path& output,
                              const std::string& step, const PendingTimes& waiting) {
    Scene scene = *scene_;
    scene.camera = view.camera, scene.hash = view.scene_hash;
    const auto render_alone = [&](RenderObserver* observer) {
        return render(std::move(scene), settings_, observer);
    };
    return show_next(options_, settings_, render_alone, output, waiting, told_, step);
}

void PictureSeries::prepare(const Shot::View& view, int frame) {
    if (scene_) {
        scene_->camera = view.camera, scene_->hash = view.scene_hash;
        session_.emplace(std::move(*scene_), settings_, shot_ ? SessionUse::scenes : SessionUse::views);
        scene_.reset();
    } else if (update_) {
        session_->change_scene(std::move(*update_), settings_.image);
        update_.reset();
        // What has come to lie far away is measured from this camera, as if it were the first.
        if (session_->is_far_away())
            session_.reset(), session_.emplace(shot_->load(frame), settings_, SessionUse::scenes);
    } else {
        session_->change_view(view.camera, settings_.image, view.scene_hash);
    }
}

int PictureSeries::show(const Shot::View& view, int frame, const std::filesystem::path& output,
                        const std::string& step, const PendingTimes& waiting) {
    settings_ = reserve_time(options_, settings_, waiting);
    if (settings_.surface.mode == SurfaceMode::tessellated) return show_alone(view, output, step, waiting);
    prepare(view, frame);
    const auto render_next = [&](RenderObserver* observer) {
        if (!shot_ || !is_moving(*shot_, view.camera)) return session_->render(observer);
        const auto update = [this](double time) { return shot_->update(time); };
        return session_->render_moving(frame, update, observer);
    };
    return show_next(options_, settings_, render_next, output, waiting, told_, step);
}

} // namespace relief::cli
