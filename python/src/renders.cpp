// Pictures of scenes, at once or one after the other while maps are painted.
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <limits>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "answers.h"
#include "exit_gate.h"
#include "parts.h"
#include "relief/denoise.h"
#include "relief/error.h"
#include "relief/session.h"
#include "render_job.h"
#include "scenes.h"
#include "settings.h"
#include "textures.h"
#include "values.h"

namespace nb = nanobind;

namespace relief::python {

namespace {

/// Loaded before the render, which would be in vain without it; null where nothing is to be denoised.
std::shared_ptr<const Denoiser> load_denoiser(const std::vector<std::string>& libraries, bool is_wanted,
                                              RenderSettings& settings) {
    if (!is_wanted) return nullptr;
    DenoiserSettings denoiser;
    denoiser.libraries.assign(libraries.begin(), libraries.end());
    denoiser.threads = settings.device.threads;
    for (const char* name : kDenoiserLayers)
        if (std::find(settings.image.layers.begin(), settings.image.layers.end(), name) ==
            settings.image.layers.end())
            settings.image.layers.emplace_back(name);
    return std::make_shared<const Denoiser>(denoiser);
}

/// Null where the observer cancels meanwhile. The scene is used up.
std::unique_ptr<Session> make_session(Scene&& scene, const RenderSettings& settings,
                                      RenderObserver& observer) {
    try {
        return std::make_unique<Session>(std::move(scene), settings, SessionUse::scenes, &observer);
    } catch (const Error&) {
        if (observer.is_cancelled()) return nullptr;
        throw;
    }
}

/// With motion blur where the scene moves. The scene is used up.
RenderResult render_parsed(ParsedScene& parsed, const RenderSettings& settings, RenderObserver& observer) {
    if (!parsed.shot) return render(std::move(parsed.scene), settings, &observer);
    const auto session = make_session(std::move(parsed.scene), settings, observer);
    if (!session) {
        RenderResult stopped;
        stopped.is_complete = false;
        return stopped;
    }
    const auto update = [&parsed](double frame) { return parsed.shot->update(frame); };
    return session->render_moving(parsed.frame, update, &observer);
}

/// The scene is used up.
nb::object render_scene(ParsedScene& parsed, const nb::dict& keywords, nb::object on_progress,
                        nb::object on_picture, double picture_interval_s, bool is_checked, bool is_denoised,
                        const std::vector<std::string>& denoisers) {
    RenderSettings settings = read_settings(keywords, parsed.scene.picture);
    const RenderCallbacks callbacks{std::move(on_progress), std::move(on_picture), picture_interval_s,
                                    settings.image.spp};
    const GateVisit visit;
    const auto denoiser = load_denoiser(denoisers, is_denoised, settings);
    const auto work = [&parsed, &settings, denoiser, is_checked](RenderObserver& observer) {
        if (is_checked)
            for (std::string& warning : find_doubts(parsed.scene))
                parsed.scene.warnings.push_back(std::move(warning));
        if (denoiser && settings.image.time_limit_s > 0)
            settings.image.time_reserved_s =
                denoiser->estimate_seconds(size_t(settings.image.width) * size_t(settings.image.height));
        RenderResult result = render_parsed(parsed, settings, observer);
        if (!denoiser || result.whole_samples == 0) return result;
        const auto start = std::chrono::steady_clock::now();
        try {
            if (!denoiser->denoise(result.image, [&] { return observer.is_cancelled(); }))
                result.is_complete = false;
        } catch (const std::exception& error) { // the picture is there
            result.statistics.warnings.push_back(std::string("the picture is not denoised: ") + error.what());
        }
        const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
        result.statistics.denoise_s = time.count();
        result.statistics.total_s += time.count();
        return result;
    };
    return make_answer(run_job(work, callbacks), settings);
}

/// Calls at the same time are refused: a callback that edits would wait for itself.
class PaintSession {
  public:
    /// The scene is used up.
    PaintSession(ParsedScene& parsed, const nb::dict& keywords)
        : camera_(parsed.scene.camera),
          picture_(parsed.scene.picture),
          settings_(read_settings(keywords, picture_)) {
        const GateVisit visit;
        const nb::gil_scoped_release release;
        session_ = std::make_unique<Session>(std::move(parsed.scene), settings_);
    }

    nb::object render(nb::object on_progress, nb::object on_picture, double picture_interval_s) {
        const auto lock = enter();
        return render_session(*session_, settings_,
                              {std::move(on_progress), std::move(on_picture), picture_interval_s});
    }

    nb::object edit(nb::handle displacement, nb::handle texels, nb::handle x, nb::handle y, nb::handle udim) {
        const auto lock = enter();
        constexpr int64_t kMostTexels = std::numeric_limits<uint32_t>::max();
        const MapEdit edit{
            Argument("displacement", displacement).text(), int(Argument("udim", udim).integer(1001, 9999)),
            uint32_t(Argument("x", x).integer(0, kMostTexels)),
            uint32_t(Argument("y", y).integer(0, kMostTexels)), make_texture(texels, "texels")};
        EditReport report;
        {
            const GateVisit visit;
            const nb::gil_scoped_release release;
            report = session_->edit(edit);
        }
        return nb::make_tuple(report.patches, report.seconds);
    }

    /// `parsed`: a scene with the camera, or null for the one that there is.
    void change_view(const ParsedScene* parsed, const nb::dict& keywords) {
        const auto lock = enter();
        const RenderSettings settings = read_settings(keywords, picture_);
        const Camera camera = parsed ? parsed->scene.camera : camera_;
        {
            const GateVisit visit;
            const nb::gil_scoped_release release;
            session_->change_view(camera, settings.image);
        }
        camera_ = camera, settings_.image = settings.image;
    }

  private:
    std::unique_lock<std::mutex> enter() {
        std::unique_lock lock(mutex_, std::try_to_lock);
        if (!lock)
            throw Error(ErrorKind::usage, {"the session is at work in another call", "Session",
                                           "edit between pictures, not from a callback or another thread"});
        return lock;
    }

    Camera camera_;
    PictureDefaults picture_;
    RenderSettings settings_;
    std::unique_ptr<Session> session_;
    std::mutex mutex_;
};

} // namespace

void add_renders(nb::module_& module) {
    nb::class_<JobProgress>(module, "Progress", "How far a render is.")
        .def_ro("prepared", &JobProgress::prepared,
                "in [0, 1], of the faces of meshes, before the first ray; then 1")
        .def_ro("fraction", &JobProgress::fraction, "in [0, 1], of all samples")
        .def_ro("samples_done", &JobProgress::samples_done, "of every pixel")
        .def_ro("samples_total", &JobProgress::samples_total, "of every pixel")
        .def_ro("rays", &JobProgress::rays, "traced so far")
        .def_ro("elapsed_s", &JobProgress::elapsed_s, "seconds since the first ray");
    module.def("render", &render_scene, nb::arg("scene"), nb::arg("keywords"), nb::arg("on_progress").none(),
               nb::arg("on_picture").none(), nb::arg("picture_interval"), nb::arg("is_checked"),
               nb::arg("is_denoised"), nb::arg("denoisers"));
    nb::class_<PaintSession>(module, "Session", "A scene that stays prepared while its maps are edited.")
        .def(nb::init<ParsedScene&, const nb::dict&>(), nb::arg("scene"), nb::arg("keywords"))
        .def("render", &PaintSession::render, nb::arg("on_progress").none(), nb::arg("on_picture").none(),
             nb::arg("picture_interval"))
        .def("change_view", &PaintSession::change_view, nb::arg("scene").none(), nb::arg("keywords"))
        .def("edit", &PaintSession::edit, nb::arg("displacement"), nb::arg("texels"), nb::arg("x"),
             nb::arg("y"), nb::arg("udim"));
}

} // namespace relief::python
