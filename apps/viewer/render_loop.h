// Renders in a thread of its own what was wanted last: pictures come as they refine, and what nobody waits
// for any more is cancelled.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "relief/render.h"
#include "relief/scene.h"
#include "relief/session.h"
#include "viewer/resolution_governor.h"
#include "viewer/shared_scene.h"

namespace relief::viewer {

/// `moving`: one sample at a size that comes fast; `painting`: one sample of direct light, smaller too, of
/// which edits renew a part; `still`: all samples.
enum class Motion { still, moving, painting };

/// What is to be seen.
struct RenderRequest {
    std::shared_ptr<const SharedScene> scene;
    uint64_t scene_version = 0; ///< another one: another session, but
    uint64_t shot = 0;          ///< scenes of one that is not 0 follow each other in one for `scenes`
    RenderSettings settings;
    Camera camera;
    Motion motion = Motion::still;
    SessionUse use = SessionUse::views; ///< `edits` where some are to come
};

struct ShownPicture {
    Image image;
    Camera camera;
    int full_width = 0, full_height = 0; ///< of the picture when still
    uint64_t version = 0;                ///< of the request and the edits that it shows
    Motion motion = Motion::still;
    bool is_complete = false; ///< all samples of a still one
    int samples = 0;          ///< of each pixel, at least
    double seconds = 0;       ///< since its render began
};

struct RenderState {
    bool is_busy = false;
    std::string error; ///< of the last render; empty: none
    Progress progress; ///< of the last picture
    /// Of the last render that ended; never null.
    std::shared_ptr<const Statistics> statistics = std::make_shared<const Statistics>();
    uint64_t picture_count = 0;
    double picture_scale = 1; ///< of width and height while moving
};

/// All functions are called by one thread, that of the interface, and never wait for a render.
class RenderLoop {
  public:
    /// `on_news` is called by the render thread when take_picture() or state() have something new.
    explicit RenderLoop(std::function<void()> on_news = {});
    /// Cancels what is being rendered, and waits for that.
    ~RenderLoop();
    RenderLoop(const RenderLoop&) = delete;
    RenderLoop& operator=(const RenderLoop&) = delete;

    /// Replaces what is wanted; edits that were not made yet are dropped with the scene that they were for.
    /// `edits`: of its maps, after all earlier ones. Returns the version of the pictures that show it.
    uint64_t show(const RenderRequest& request, std::vector<MapEdit> edits = {});

    /// The newest picture, if there is one since the last call.
    std::shared_ptr<const ShownPicture> take_picture();
    RenderState state() const;

  private:
    class Observer;
    /// What the thread works on.
    struct Work {
        RenderRequest request;
        std::vector<MapEdit> edits;
        uint64_t version = 0;
    };

    void run();
    std::optional<Work> await_work();
    void render(const Work& work);
    void prepare(const RenderRequest& request);
    void start_session(const RenderRequest& request);
    bool change_scene(const RenderRequest& request);
    ImageSettings make_first_image(const RenderRequest& request) const;
    void render_pass(const Work& work, const ImageSettings& image, Motion motion);
    void render_painting(const Work& work);
    void render_preview(const Work& work);
    void publish(Image image, const Observer& observer, bool is_complete);
    void tell();
    bool may_cancel(const RenderRequest& next) const;

    std::function<void()> on_news_;
    mutable std::mutex mutex_;
    std::condition_variable has_work_;
    RenderRequest wanted_;
    std::vector<MapEdit> edits_;
    uint64_t version_ = 0, started_version_ = 0;
    bool must_end_ = false;
    std::optional<Motion> rendered_motion_; ///< of what is being rendered; nothing: idle
    uint64_t rendered_scene_ = 0;
    std::shared_ptr<const ShownPicture> picture_;
    RenderState state_;
    std::atomic<bool> is_stale_{false};

    // Of the render thread alone.
    std::unique_ptr<Session> session_;
    uint64_t session_scene_ = 0, session_shot_ = 0;
    SharedMeshes session_meshes_;
    SessionUse session_use_ = SessionUse::views;
    RenderSettings session_settings_; ///< with those of the last picture
    Camera session_camera_;
    bool has_shown_session_ = false;
    bool is_seen_ = false; ///< there is a picture of what is to be seen, by that camera
    Camera seen_camera_;
    ResolutionGovernor governor_, painting_governor_;
    std::pair<int, int> painting_size_{}; ///< kept until the next stroke; (0, 0): there is none

    std::thread thread_; ///< last: it uses all of the above
};

} // namespace relief::viewer
