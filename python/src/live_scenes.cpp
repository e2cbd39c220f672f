// Scenes that stay prepared between pictures while anything of them changes.
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "answers.h"
#include "base/stop_request.h"
#include "exit_gate.h"
#include "parts.h"
#include "relief/error.h"
#include "relief/io.h"
#include "relief/session.h"
#include "relief/shot.h"
#include "render_job.h"
#include "scenes.h"
#include "settings.h"

namespace nb = nanobind;

namespace relief::python {

namespace {

/// A scene as text and what the text names.
struct GivenScene {
    std::string text, folder;
    SceneAssets assets;
    std::optional<double> frame;
};

GivenScene read_scene(const nb::dict& given) {
    GivenScene scene;
    scene.text = nb::cast<std::string>(given["text"]), scene.folder = nb::cast<std::string>(given["folder"]);
    scene.assets = read_assets(nb::cast<nb::dict>(given["meshes"]), nb::cast<nb::dict>(given["textures"]));
    scene.frame = nb::cast<std::optional<double>>(given["frame"]);
    return scene;
}

double find_frame(const Shot& shot, std::optional<double> frame) {
    return frame.value_or(shot.frames().empty() ? 1 : shot.frames().front());
}

/// Calls at the same time are refused, and calls from callbacks.
class LiveScene {
  public:
    LiveScene(const nb::dict& given, const nb::dict& keywords, const nb::object& on_progress) {
        GivenScene scene = read_scene(given);
        const GateVisit visit;
        Scene loaded = load(std::move(scene), on_progress);
        picture_ = loaded.picture, camera_ = loaded.camera;
        settings_ = read_settings(keywords, picture_);
        MeshHashes hashes = hash_meshes(loaded);
        const auto work = [&](RenderObserver& observer) {
            session_ = std::make_unique<Session>(std::move(loaded), settings_, SessionUse::scenes, &observer);
        };
        run_step(work, on_progress, settings_.image.spp);
        hashes_ = std::move(hashes);
    }

    nb::object render(nb::object on_progress, nb::object on_picture, double picture_interval_s) {
        const auto lock = enter();
        return render_session(*session_, settings_,
                              {std::move(on_progress), std::move(on_picture), picture_interval_s});
    }

    /// `parsed`: a scene with the camera, or null for the one that there is.
    void change_view(const ParsedScene* parsed, const nb::dict& keywords, const nb::object& on_progress) {
        const auto lock = enter();
        const RenderSettings settings = read_settings(keywords, picture_);
        const Camera camera = parsed ? parsed->scene.camera : camera_;
        const GateVisit visit;
        const auto work = [&](RenderObserver& observer) {
            session_->change_view(camera, settings.image, 0, &observer);
        };
        run_step(work, on_progress, settings.image.spp);
        camera_ = camera, settings_.image = settings.image;
    }

    /// `kept`: names of the meshes that are as they were in the scene that was taken last.
    void change_scene(const nb::dict& given, const std::vector<std::string>& kept, const nb::dict& keywords,
                      const nb::object& on_progress) {
        const auto lock = enter();
        GivenScene scene = read_scene(given);
        for (const std::string& name : kept) scene.assets.kept_meshes[name] = hashes_.at(name);
        const GateVisit visit;
        Scene loaded = load(std::move(scene), on_progress);
        const PictureDefaults picture = loaded.picture;
        const Camera camera = loaded.camera;
        const RenderSettings settings = read_settings(keywords, picture);
        MeshHashes hashes = hash_meshes(loaded);
        const auto work = [&](RenderObserver& observer) {
            const uint64_t hash = loaded.hash;
            session_->change_scene({std::move(loaded), camera, hash}, settings.image, &observer);
        };
        run_step(work, on_progress, settings.image.spp);
        hashes_ = std::move(hashes), picture_ = picture, camera_ = camera, settings_.image = settings.image;
    }

    uint64_t made_surfaces() {
        const auto lock = enter();
        return session_->made_surfaces();
    }

  private:
    using MeshHashes = std::map<std::string, uint64_t>;

    std::unique_lock<std::mutex> enter() {
        std::unique_lock lock(mutex_, std::try_to_lock);
        if (!lock)
            throw Error(ErrorKind::usage,
                        {"the scene is at work in another call", "LiveScene",
                         "change it between pictures, not from a callback or another thread"});
        return lock;
    }

    Scene load(GivenScene&& given, const nb::object& on_progress) {
        Scene scene;
        const auto work = [&](RenderObserver& observer) {
            const StopScope scope([&] { return observer.is_cancelled(); });
            if (shot_ && given.folder == folder_)
                shot_->change_text(given.text, std::move(given.assets));
            else
                shot_ = std::make_unique<Shot>(given.text, given.folder, std::move(given.assets));
            folder_ = given.folder;
            scene = shot_->load(find_frame(*shot_, given.frame));
        };
        try {
            run_step(work, on_progress, 0);
        } catch (const StopRequest&) {
            throw Error(ErrorKind::failed, {"the reading of the scene was stopped", "LiveScene", ""});
        }
        return scene;
    }

    MeshHashes hash_meshes(const Scene& scene) const {
        MeshHashes hashes;
        for (const Mesh& mesh : scene.meshes)
            hashes[mesh.name] = mesh.face_sizes.empty() ? hashes_.at(mesh.name) : hash_mesh(mesh);
        return hashes;
    }

    std::unique_ptr<Shot> shot_;
    std::string folder_;
    Camera camera_;
    PictureDefaults picture_;
    RenderSettings settings_;
    MeshHashes hashes_; ///< of the meshes that the session has
    std::unique_ptr<Session> session_;
    std::mutex mutex_;
};

} // namespace

void add_live_scenes(nb::module_& module) {
    nb::class_<LiveScene>(module, "LiveScene", "A scene that stays prepared while it changes.")
        .def(nb::init<const nb::dict&, const nb::dict&, const nb::object&>(), nb::arg("scene"),
             nb::arg("keywords"), nb::arg("on_progress").none())
        .def("render", &LiveScene::render, nb::arg("on_progress").none(), nb::arg("on_picture").none(),
             nb::arg("picture_interval"))
        .def("change_view", &LiveScene::change_view, nb::arg("scene").none(), nb::arg("keywords"),
             nb::arg("on_progress").none())
        .def("change_scene", &LiveScene::change_scene, nb::arg("scene"), nb::arg("kept"), nb::arg("keywords"),
             nb::arg("on_progress").none())
        .def_prop_ro("made_surfaces", &LiveScene::made_surfaces);
}

} // namespace relief::python
