"""The render engine: final renders and the viewport."""
import time
import weakref

import bpy

from . import faults, passes, remedies, statistics
from .camera_export import report_clipping
from .motion_export import MotionExport
from .properties import find_threads
from .render_job import RenderJob, describe, has_left
from .report import Report
from .scene_export import SceneExport
from .stereo import find_cameras, find_views
from .viewport import Viewport

PATIENCE = 1.0  # seconds that a stopped render may take to end


def make_settings(scene, view, layers):
    """Keywords of relief.render for a final render."""
    own = scene.relief
    return {"size": view.size, "crop": view.crop, "spp": own.samples, "bounces": own.bounces, "seed": own.seed,
            "noise": own.noise, "time_limit": own.time_limit, "clamp_indirect": own.clamp_indirect,
            "pixel_error": own.pixel_error, "engine": own.engine, "denoise": own.denoise, "layers": layers,
            "threads": find_threads(scene.render),
            "background": "transparent" if scene.render.film_transparent else None}


def begin_layer(layers, name):
    """{name of a view layer: (lines, fault)} of the layers of one render so far. Blender may use an engine for several frames:
    a layer that comes again begins another render."""
    return {**({} if name in layers else layers), name: ([], "")}


class ReliefEngine(bpy.types.RenderEngine):
    bl_idname = "RELIEF"
    bl_label = "Relief"
    bl_use_preview = False
    bl_use_shading_nodes_custom = False
    bl_use_eevee_viewport = True

    def update_render_passes(self, scene=None, view_layer=None):
        passes.register(self, scene, view_layer)

    # Final renders

    def update(self, data, depsgraph):
        """Takes the scene over, in the main thread. A fault is shown by render()."""
        self._report, self._fault = Report(), ""
        self._layers = begin_layer(getattr(self, "_layers", {}), depsgraph.view_layer.name)
        self.update_stats("", "Relief: taking over the scene")
        try:
            cameras = find_cameras(self, depsgraph.scene)
            self._views = find_views(self, depsgraph, self._report, cameras)
            exporter = SceneExport(depsgraph, self._report)
            self._scene = exporter.run()
            for name, view in self._views.items():
                report_clipping(self._scene, view, cameras[name].evaluated_get(depsgraph), self._report)
            self._motion = MotionExport(depsgraph, exporter, self._views, self._report)
            self._motion.run(self)
        except Exception as fault:  # whatever Blender is not told is a picture without the scene
            self._fault = faults.describe(fault)

    def render(self, depsgraph):
        try:
            fault = self._fault or self._render(depsgraph)
        except Exception as raised:
            fault = faults.describe(raised)
        if fault:
            self._fail(fault, depsgraph)

    def _render(self, depsgraph):
        """What went wrong, or ""."""
        while has_left(0.1):
            self.update_stats("", "Relief: waiting for the end of the render before")
            if self._is_stopped():
                return ""
        scene = depsgraph.scene
        layers = passes.find_layers(depsgraph.view_layer)
        passes.report_missing(depsgraph.view_layer, self._report)
        taken, self._scene = self._scene, None
        for number, (name, view) in enumerate(self._views.items()):
            taken.camera = self._motion.cameras[name]
            is_last = number == len(self._views) - 1
            job = RenderJob(taken, {**make_settings(scene, view, layers), **self._motion.settings, "release": is_last},
                            on_end=self._motion.make_clean_up() if is_last else None)
            if is_last:
                taken = None
            try:
                fault = self._follow(job, depsgraph, name)
            finally:
                job.leave()
            if fault or self._is_stopped():
                return fault
        return ""

    def _follow(self, job, depsgraph, name):
        """What went wrong in a view, or "". A render that is stopped has the picture so far, or none before the first
        sample."""
        stopped_at = None
        while True:
            kind, thing = job.poll(0.1)
            if stopped_at is None and self._is_stopped():
                job.cancel()
                stopped_at = time.monotonic()
            if kind == "progress":
                before = list(self._views).index(name)
                self.update_progress((before + thing.fraction) / len(self._views))
                self.update_stats("", describe(thing))
            elif kind == "picture":
                self._show(thing, depsgraph, name, is_last=False)
            elif kind == "done":
                self._finish(thing, depsgraph, name)
                return ""
            elif kind == "fault":
                return "" if job.is_cancelled else faults.describe(thing)
            elif stopped_at is not None and time.monotonic() - stopped_at > PATIENCE:
                return ""

    def _is_stopped(self):
        return self.test_break()

    def _show(self, picture, depsgraph, name, is_last):
        """Writes a picture of a view into the result."""
        x0, y0, x1, y1 = self._views[name].crop
        result = self.begin_result(0, 0, x1 - x0, y1 - y0, layer=depsgraph.view_layer.name, view=name)
        made = result.layers[0].passes
        passes.put(made["Combined"], passes.make_combined(picture.color, depsgraph.scene.render.film_transparent))
        for p in passes.wanted_passes(depsgraph.view_layer):
            passes.put(made[p.name], passes.make_pass(p, picture[p.layer], self._views[name]))
        for matte in passes.wanted_mattes(depsgraph.view_layer) if is_last else []:
            for rank in range(passes.MATTE_RANKS):
                passes.put(made[f"{matte}{rank:02}"], picture[f"{matte}{rank:02}"])
        self.end_result(result)

    def _finish(self, picture, depsgraph, name):
        self._show(picture, depsgraph, name, is_last=True)
        for warning in picture.warnings:
            self._report.add("scene", "", remedies.translate(warning))
        self._keep(depsgraph, picture.statistics)
        if name == list(self._views)[-1] or self._is_stopped():
            self._report.tell(lambda line: self.report({"WARNING"}, line))

    def _keep(self, depsgraph, numbers, fault=""):
        """Keeps the numbers of this view layer, with the lines and the first fault of all layers of the render."""
        self._layers[depsgraph.view_layer.name] = self._report.lines, fault
        lines = dict.fromkeys(line for lines, _ in self._layers.values() for line in lines)
        faults_of_layers = [fault for _, fault in self._layers.values() if fault]
        statistics.keep(depsgraph.scene, numbers, list(lines), next(iter(faults_of_layers), ""))

    def _fail(self, text, depsgraph):
        """Shows an error; the statistics keep it, as the panel is what one looks at next."""
        # Blender 4.5 ends with a segmentation fault where a render that failed has no result to write.
        self.end_result(self.begin_result(0, 0, self.resolution_x, self.resolution_y))
        self._keep(depsgraph, {}, text)
        self.error_set(text)           # in the image editor
        self.report({"ERROR"}, text)   # in a window; scripts get an exception, and no picture is written
        self._report.tell(lambda line: self.report({"WARNING"}, line))

    # Viewport

    def view_update(self, context, depsgraph):
        self._find_viewport().update(context, depsgraph)

    def view_draw(self, context, depsgraph):
        self._find_viewport().draw(context, depsgraph)

    def _find_viewport(self):
        if not hasattr(self, "_viewport"):
            self._viewport = Viewport(self)
            weakref.finalize(self, self._viewport.close)  # __del__ could no longer read what the engine has
        return self._viewport


def find_panels():
    """Panels of Blender that Relief takes part in: those of others that are not about an engine's own settings."""
    excluded = {"VIEWLAYER_PT_filter", "VIEWLAYER_PT_layer_passes", "RENDER_PT_eevee_performance"}
    return [panel for panel in bpy.types.Panel.__subclasses__()
            if "BLENDER_RENDER" in getattr(panel, "COMPAT_ENGINES", ()) and panel.__name__ not in excluded]


def register():
    bpy.utils.register_class(ReliefEngine)
    for panel in find_panels():
        panel.COMPAT_ENGINES.add("RELIEF")


def unregister():
    for panel in bpy.types.Panel.__subclasses__():
        if "RELIEF" in getattr(panel, "COMPAT_ENGINES", ()):
            panel.COMPAT_ENGINES.discard("RELIEF")
    bpy.utils.unregister_class(ReliefEngine)
