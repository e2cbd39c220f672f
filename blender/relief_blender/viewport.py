"""The viewport: a coarse picture at once, then one of all pixels, begun anew when the scene or the view changes. What has not
changed of the scene stays exported and prepared."""
import weakref

import numpy as np

from . import faults
from .camera_export import add_depth_of_field, find_basis, make_view
from .kept_parts import KeptParts
from .live_job import LiveJob, LiveRenders
from .passes import make_combined
from .properties import find_threads
from .render_job import describe
from .report import Report
from .scene_export import SceneExport

COARSE = 4  # pixels a side of the first picture
# Kinds of data whose changes are changes of the scene; moves of the view are none.
WATCHED = ("OBJECT", "MESH", "CURVE", "MATERIAL", "NODETREE", "LIGHT", "WORLD", "IMAGE", "COLLECTION", "SCENE", "META")


def has_changed(depsgraph):
    return any(depsgraph.id_type_updated(kind) for kind in WATCHED)


def find_view(context, scene, factor=1):
    """The View of the region that is drawn, `factor` pixels a side of each of the picture."""
    region, region_data = context.region, context.region_data
    basis = find_basis(np.array(region_data.view_matrix.inverted()))
    size = max(region.width // factor, 1), max(region.height // factor, 1)
    view = make_view((*size, None), np.array(region_data.window_matrix), basis, lambda text: None)
    if scene.camera is not None and region_data.view_perspective == "CAMERA":
        add_depth_of_field(view, scene.camera.data, basis, lambda text: None)
    return view


def make_settings(scene, view, factor):
    """Makes settings for a picture with 1 / `factor` of the rows and columns; its geometry is that of the whole picture."""
    own = scene.relief
    return {"size": view.size, "detail_height": view.size[1] * factor, "crop": view.crop,
            "spp": 1 if factor > 1 else own.viewport_samples,
            "bounces": own.viewport_bounces, "pixel_error": own.viewport_pixel_error, "seed": own.seed,
            "engine": own.engine, "threads": find_threads(scene.render), "clamp_indirect": own.clamp_indirect,
            "background": "transparent" if scene.render.film_transparent else None}


def draw_on_screen(engine, scene, array, width, height):
    """Draws a picture over the region, in Blender's display space."""
    import gpu
    from gpu_extras.presets import draw_texture_2d
    rows = np.ascontiguousarray(array[::-1], np.float32)
    buffer = gpu.types.Buffer("FLOAT", rows.size, rows.reshape(-1))
    texture = gpu.types.GPUTexture((rows.shape[1], rows.shape[0]), format="RGBA16F", data=buffer)
    gpu.state.blend_set("ALPHA_PREMULT")
    engine.bind_display_space_shader(scene)
    draw_texture_2d(texture, (0, 0), width, height)
    engine.unbind_display_space_shader()
    gpu.state.blend_set("NONE")


class Viewport:
    """One viewport of a render engine, which it does not keep alive: Blender lets go of it where the viewport is closed.

    draw_picture(engine, scene, array, width, height) draws (height, width, 4) premultiplied linear values."""

    def __init__(self, engine, draw_picture=draw_on_screen, make_job=LiveJob):
        self._engine, self._draw_picture, self._make_job = weakref.ref(engine), draw_picture, make_job
        self._scene = self._job = self._key = self._array = None
        self._parts, self._renders = KeptParts(), LiveRenders()
        self._factors, self._status = [], ""
        self._fault = ""  # nothing is drawn or tried again until the scene or the view changes

    def update(self, context, depsgraph):
        """Takes the scene over again if it has changed."""
        if (self._scene is not None or self._fault) and not has_changed(depsgraph):
            return
        self.stop()
        self._scene = self._key = None
        try:
            self._parts.follow(depsgraph)
            self._scene = SceneExport(depsgraph, Report(), self._parts).run()
            self._parts.forget_unused()
            self._show_fault("")
        except Exception as fault:
            self._show_fault(faults.describe(fault))
        self._engine().tag_redraw()

    def draw(self, context, depsgraph):
        if self._scene is None:
            self.update(context, depsgraph)
        if self._scene is None:
            return
        try:
            self._draw(context, depsgraph)
        except Exception as fault:
            self.stop()
            self._show_fault(faults.describe(fault))

    def _draw(self, context, depsgraph):
        scene = depsgraph.scene
        view = find_view(context, scene)
        key = repr((view.size, sorted(view.camera.items())))
        if key != self._key:
            self.stop()
            self._key, self._factors = key, [COARSE, 1]
            self._show_fault("")
        self._take_news(scene)
        if self._job is None and self._factors:
            self._start(context, depsgraph, self._factors.pop(0))
        if self._array is not None:
            self._draw_picture(self._engine(), scene, self._array, *view.size)

    def _start(self, context, depsgraph, factor):
        scene = depsgraph.scene
        view = find_view(context, scene, factor)
        settings = make_settings(scene, view, factor)
        if not self._renders.knows_meshes(settings):
            self._renders.forget()
            self._parts.forget_all()
            self._scene = SceneExport(depsgraph, Report(), self._parts).run()
        self._scene.camera = view.camera
        self._job = self._make_job(self._renders, self._scene, settings, 0.1)
        self._job.on_news = make_redraw(self._engine)

    def _take_news(self, scene):
        while self._job is not None:
            kind, thing = self._job.poll(0)
            if kind is None:
                return
            is_wanted = not self._job.is_cancelled
            self._show_status(describe(thing) if kind == "progress" and is_wanted and thing.fraction == 0 else "")
            if kind in {"done", "fault"}:
                self._job = None
            if is_wanted and kind in {"picture", "done"}:
                self._array = make_combined(np.array(thing.color), scene.render.film_transparent)
            if is_wanted and kind == "fault":
                self._show_fault(faults.describe(thing))

    def _show_status(self, text):
        """In the status of Blender, while the scene is prepared."""
        if text != self._status and not self._fault:
            self._engine().update_stats("", text)
        self._status = text

    def _show_fault(self, text):
        """In the corner of the viewport and in the console, once; "": there is none any more."""
        if text != self._fault:
            self._engine().update_stats("Relief" if text else "", text)
            if text:
                self._engine().report({"ERROR"}, text)
        self._fault = text
        if text:
            self._array, self._factors = None, []

    def stop(self):
        """Asks the render that goes on for its end; draw() begins no other before that, as two would want twice the memory."""
        self._factors = []
        if self._job is not None:
            self._job.cancel()

    def close(self):
        """Lets a render that goes on end by itself."""
        if self._job is not None:
            self._job.on_news = None
            self._job.leave()


def make_redraw(find_engine):
    """Asks for a redraw from the render's thread, as long as there is an engine."""
    def redraw():
        try:
            engine = find_engine()
            if engine is not None:
                engine.tag_redraw()
        except ReferenceError:  # Blender has let go of it just now
            pass
    return redraw
