"""The viewport: a coarse picture at once, then one of all pixels, begun anew when the scene or the view changes."""
import numpy as np

from .camera_export import add_depth_of_field, find_basis, make_view
from .passes import make_combined
from .properties import find_threads
from .render_job import RenderJob
from .report import Report
from .scene_export import SceneExport

COARSE = 4  # pixels a side of the first picture
# Kinds of data whose changes are changes of the scene; moves of the view are none.
WATCHED = ("OBJECT", "MESH", "CURVE", "MATERIAL", "NODETREE", "LIGHT", "WORLD", "IMAGE", "COLLECTION", "SCENE", "META")


def find_view(context):
    """(width, height, window matrix, matrix of the viewer in the world) of the region that is drawn."""
    region, view = context.region, context.region_data
    return region.width, region.height, np.array(view.window_matrix), np.array(view.view_matrix.inverted())


def make_settings(scene, view, factor):
    own = scene.relief
    return {"size": view.size, "crop": view.crop, "spp": 1 if factor > 1 else own.viewport_samples,
            "bounces": own.viewport_bounces, "pixel_error": own.viewport_pixel_error, "seed": own.seed,
            "engine": own.engine, "threads": find_threads(scene.render), "clamp_indirect": own.clamp_indirect,
            "background": "transparent" if scene.render.film_transparent else None}


class Viewport:
    """One viewport of a render engine. `draw_picture` draws (height, width, 4) premultiplied linear values."""

    def __init__(self, engine, draw_picture=None, make_job=RenderJob):
        self._engine, self._make_job = engine, make_job
        self._draw_picture = draw_picture or Screen(engine).draw
        self._scene = self._job = self._key = self._array = None
        self._factors = []

    def update(self, context, depsgraph):
        """Takes the scene over again if it has changed."""
        is_changed = any(depsgraph.id_type_updated(kind) for kind in WATCHED)
        if self._scene is not None and not is_changed:
            return
        self.stop()
        self._scene = SceneExport(depsgraph, Report()).run()
        self._key = None
        self._engine.tag_redraw()

    def draw(self, context, depsgraph):
        if self._scene is None:
            self.update(context, depsgraph)
        width, height, projection, world_from_view = find_view(context)
        key = (width, height, projection.tobytes(), world_from_view.tobytes())
        if key != self._key:
            self.stop()
            self._key, self._factors = key, [COARSE, 1]
        self._take_news(depsgraph.scene)
        if self._job is None and self._factors:
            self._start(context, depsgraph.scene, self._factors.pop(0))
        if self._array is not None:
            self._draw_picture(depsgraph.scene, self._array, width, height)

    def _start(self, context, scene, factor):
        width, height, projection, world_from_view = find_view(context)
        basis = find_basis(world_from_view)
        size = max(width // factor, 1), max(height // factor, 1)
        view = make_view((*size, None), projection, basis, lambda text: None)
        camera = scene.camera
        if camera is not None and context.region_data.view_perspective == "CAMERA":
            add_depth_of_field(view, camera.data, basis, lambda text: None)
        self._scene.camera = view.camera
        self._job = self._make_job(self._scene, make_settings(scene, view, factor), 0.1)
        self._job.on_news = self._engine.tag_redraw

    def _take_news(self, scene):
        while self._job is not None:
            kind, thing = self._job.poll(0)
            if kind is None:
                return
            if kind in {"picture", "done"}:
                self._array = make_combined(np.array(thing.color), scene.render.film_transparent)
            if kind == "fault":
                self._engine.report({"ERROR"}, f"Relief: {thing}")
                self._factors = []
            if kind in {"done", "fault"}:
                self._job = None

    def stop(self):
        """Ends the render that goes on."""
        if self._job is not None:
            self._job.cancel()
            self._job.join()
            self._job = None


class Screen:
    """Draws pictures over the region, in Blender's display space."""

    def __init__(self, engine):
        self._engine = engine

    def draw(self, scene, array, width, height):
        import gpu
        from gpu_extras.presets import draw_texture_2d
        rows = np.ascontiguousarray(array[::-1], np.float32)
        buffer = gpu.types.Buffer("FLOAT", rows.size, rows.reshape(-1))
        texture = gpu.types.GPUTexture((rows.shape[1], rows.shape[0]), format="RGBA16F", data=buffer)
        gpu.state.blend_set("ALPHA_PREMULT")
        self._engine.bind_display_space_shader(scene)
        draw_texture_2d(texture, (0, 0), width, height)
        self._engine.unbind_display_space_shader()
        gpu.state.blend_set("NONE")
