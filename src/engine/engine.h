// The one interface that both engines stand behind.
#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <span>

#include "film/film.h"
#include "prepare/prepared_scene.h"
#include "prepare/scene_edit.h"
#include "relief/intersect.h"
#include "relief/render.h"

namespace relief {

/// What is called every so many seconds while no sample is traced.
struct Interruption {
    double interval_s = std::numeric_limits<double>::infinity();
    std::function<void()> call; ///< may be empty
};

/// Who follows a render.
struct RenderControl {
    RenderControl(RenderObserver* render_observer = nullptr) : observer(render_observer) {}

    RenderObserver* observer;
    Interruption save;
    Interruption show;  ///< once as soon as every pixel has a sample, then at its intervals
    double spent_s = 0; ///< of the time limit, before the render began
};

class Engine {
  public:
    virtual ~Engine() = default;

    /// The scene's editor has changed it in place: texels, bounds and levels of these patches, one change a
    /// surface. Not while rays are traced. False: the engine does not support that, a new one has to be made.
    virtual bool apply_changes(std::span<const SurfaceChange> changes) = 0;

    /// The scene's editor has changed the camera, the size of pictures and with them levels in place; these
    /// patches read other copies of maps. `image` takes the place of those settings. As apply_changes() else.
    virtual bool change_view(std::span<const SurfaceChange> changes, const ImageSettings& image) {
        (void)changes, (void)image;
        return false;
    }

    /// The scene's editor has put the scene at another time in its place: these surfaces have changed, and
    /// perhaps anything but them. As change_view() else.
    virtual bool change_scene(std::span<const SurfaceChange> changes, const ImageSettings& image) {
        (void)changes, (void)image;
        return false;
    }

    /// Adds those of samples [settings.image.first_sample, + spp) of every pixel of the film's window that it
    /// lacks. Returns false when the observer cancelled; the film then holds what was done.
    virtual bool render(Film& film, const RenderControl& control) = 0;

    /// apply_changes() and refresh() will be called: whatever makes them cheaper may cost a little.
    virtual void expect_changes() {}

    /// The film of the last render() or refresh() becomes what render() would make of an empty one now; what
    /// no change since then can have reached is kept. The rest as for render().
    virtual bool refresh(Film& film, const RenderControl& control) {
        film.clear(film.window());
        return render(film, control);
    }

    /// Spans of equal length; thread safe. Instances are met whose visibility mask shares a bit with `mask`.
    virtual void closest_hits(std::span<const Ray> rays, std::span<RayHit> hits, uint32_t mask) const = 0;
    virtual void any_hits(std::span<const Ray> rays, std::span<uint8_t> hits, uint32_t mask) const = 0;

    /// Adds the engine's counters. What render() spent on setup moves from render_s to prepare_s.
    virtual void add_statistics(Statistics& statistics) const = 0;
};

} // namespace relief
