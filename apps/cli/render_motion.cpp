#include "render_motion.h"

#include <utility>

#include "relief/error.h"
#include "relief/session.h"

namespace relief::cli {

bool is_moving(const Shot& shot, const Camera& camera) {
    return shot.is_animated() && camera.shutter_open < camera.shutter_close;
}

void check_motion(const RenderOptions& options) {
    if (options.settings.surface.mode == SurfaceMode::tessellated)
        throw Error(ErrorKind::usage, {"tessellated surfaces have no motion blur", "--surface tessellated",
                                       "camera.shutter = [0, 0], or leave the option out"});
    if (options.aim.scene == AimOptions{}) return;
    throw Error(
        ErrorKind::usage,
        {"the shutter is open, and options change the scene at one time alone", options.input,
         "write what --from, --light and the like say into the scene file, or camera.shutter = [0, 0]"});
}

RenderResult render_shot(Shot& shot, int frame, Scene scene, const RenderSettings& settings,
                         RenderObserver* observer, const Checkpoints& checkpoints) {
    if (!is_moving(shot, scene.camera)) return render(std::move(scene), settings, observer, checkpoints);
    Session session(std::move(scene), settings, SessionUse::scenes);
    const auto update = [&shot](double time) { return shot.update(time); };
    return session.render_moving(frame, update, observer, checkpoints);
}

} // namespace relief::cli
