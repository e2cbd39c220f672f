"""The renders of a viewport, which go on from what the last one has prepared."""
import relief

from .render_job import RenderJob

FIXED = ("engine", "threads", "pixel_error")  # settings of a LiveScene that do not change


class LiveRenders:
    """The LiveScene of a viewport. Its jobs follow one another; each is given the scene as it was exported last."""

    def __init__(self):
        self._live = self._shown = self._fixed = None

    def knows_meshes(self, settings):
        """Whether meshes that a job with such settings has had are known to the next one: they have lost their arrays."""
        return self._live is None or self._fixed == _select_fixed(settings)

    @property
    def made_surfaces(self):
        """How many surfaces have been made from meshes so far."""
        return self._live.made_surfaces if self._live is not None else 0

    def forget(self):
        """The next job prepares all of its scene."""
        self._live = self._shown = self._fixed = None

    def render(self, scene, settings, progress, on_picture, picture_interval):
        """The relief.Picture of a scene; one that is the same object as before differs in its camera alone."""
        view = {key: value for key, value in settings.items() if key not in FIXED}
        if self._live is None:
            self._live = relief.LiveScene(scene, progress=progress, release=True, **settings)
            self._fixed = _select_fixed(settings)
        elif scene is self._shown:
            self._live.change_view(scene.camera, progress=progress, **view)
        else:
            self._shown = None
            self._live.change_scene(scene, progress=progress, **view)
        self._shown = scene
        return self._live.render(progress=progress, on_picture=on_picture, picture_interval=picture_interval)


def _select_fixed(settings):
    return {key: settings[key] for key in FIXED}


class LiveJob(RenderJob):
    """A job of LiveRenders."""

    def __init__(self, renders, scene, settings, picture_interval=0.5):
        self._renders = renders
        super().__init__(scene, settings, picture_interval)

    def _render(self, scene):
        return self._renders.render(scene, self._settings, self._on_progress, self._on_picture, self._picture_interval)
