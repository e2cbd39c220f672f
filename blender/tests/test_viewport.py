"""The viewport: its pictures, its faults, and its end."""
from support import BlenderTest, main, make_grid, make_image, make_material  # first: it makes the add-on known
import gc
import threading
import time
import types
from unittest import mock

import bpy
import numpy as np
from mathutils import Matrix
from relief_blender import images
from relief_blender import viewport as viewport_module
from relief_blender.engine import ReliefEngine
from relief_blender.render_job import RenderJob
from relief_blender.viewport import Viewport

import relief


class Engine:
    """What the viewport asks of its render engine. `texts`: what its corner shows, one after the other."""

    def __init__(self):
        self.texts, self.errors = [], []

    def tag_redraw(self):
        pass

    def report(self, kind, text):
        self.errors.append(text)

    def update_stats(self, label, text):
        self.texts.append(text)


def end_at(event):
    """In place of relief.render: prepares until an event, and then is stopped."""
    def render(scene, progress, **settings):
        event.wait(60)
        raise relief.Error("the render was stopped before every pixel had a sample", kind="failed")
    return render


class View(BlenderTest):
    """The viewport's logic, with a region and a screen that are made up."""

    def setUp(self):
        super().setUp()
        self.grid = make_grid(2)
        make_material(self.grid)
        bpy.context.scene.relief.viewport_samples = 4
        self.drawn = []
        self.engine = Engine()
        self.viewport = Viewport(self.engine, lambda engine, scene, array, width, height: self.drawn.append(array))
        self.addCleanup(self.viewport.close)
        self.depsgraph = bpy.context.evaluated_depsgraph_get()

    def make_context(self, turn=0.0, perspective="PERSP"):
        camera = self.camera.evaluated_get(self.depsgraph)
        projection = camera.calc_matrix_camera(self.depsgraph, x=80, y=60)
        view = (camera.matrix_world @ Matrix.Rotation(turn, 4, "Z")).inverted()
        region_data = types.SimpleNamespace(window_matrix=projection, view_matrix=view, view_perspective=perspective)
        return types.SimpleNamespace(region=types.SimpleNamespace(width=80, height=60), region_data=region_data)

    def draw_until_done(self, context):
        self.drawn.clear()
        limit = time.monotonic() + 60
        while time.monotonic() < limit:
            self.viewport.draw(context, self.depsgraph)
            if self.viewport._job is None and not self.viewport._factors:
                break
            time.sleep(0.02)
        return self.drawn[-1]

    def test_a_coarse_picture_comes_before_the_fine_one(self):
        self.viewport.update(self.make_context(), self.depsgraph)
        fine = self.draw_until_done(self.make_context())
        self.assertEqual(fine.shape, (60, 80, 4))
        self.assertEqual(self.drawn[0].shape, (15, 20, 4))
        self.assertGreater(fine[..., 3].mean(), 0.05)

    def test_turning_the_view_begins_anew_without_a_new_scene(self):
        self.viewport.update(self.make_context(), self.depsgraph)
        first = self.draw_until_done(self.make_context())
        scene = self.viewport._scene
        second = self.draw_until_done(self.make_context(0.7))
        self.assertGreater(np.abs(first - second).mean(), 0.01)
        self.assertIs(self.viewport._scene, scene)

    def test_the_viewport_shows_what_the_render_shows(self):
        self.viewport.update(self.make_context(), self.depsgraph)
        viewed = self.draw_until_done(self.make_context())[..., 3] > 0.5
        render = bpy.context.scene.render
        render.resolution_x, render.resolution_y = 80, 60
        self.assertLess(np.mean(viewed != self.render("RELIEF").mask), 0.01)

    def change(self, context):
        """Something in the scene has changed."""
        with mock.patch.object(viewport_module, "has_changed", return_value=True):
            self.viewport.update(context, self.depsgraph)

    # Faults

    def test_a_fault_of_the_export_is_shown_once_and_tried_again_when_something_changes(self):
        context = self.make_context()
        with mock.patch.object(viewport_module, "SceneExport", side_effect=KeyError("uv")) as export:
            self.viewport.update(context, self.depsgraph)
            for turn in (0, 0, 0.3):
                self.viewport.draw(self.make_context(turn), self.depsgraph)
            self.viewport.update(context, self.depsgraph)
            self.assertEqual(export.call_count, 1)
            self.assertEqual(self.engine.texts, self.engine.errors)
            self.assertEqual(len(self.engine.texts), 1)
            self.assertIn("Relief: KeyError: 'uv'", self.engine.texts[0])
            self.change(context)
            self.assertEqual((export.call_count, len(self.engine.texts)), (2, 1))
        self.change(context)
        self.draw_until_done(context)
        self.assertEqual(self.engine.texts[1:], [""])
        self.assertEqual(len(self.engine.errors), 1)

    def test_a_fault_of_the_renderer_is_shown_and_the_last_picture_is_not(self):
        self.viewport.update(self.make_context(), self.depsgraph)
        self.draw_until_done(self.make_context())
        with mock.patch.object(relief, "render", side_effect=relief.Error("no such device")) as render:
            self.change(self.make_context())
            self.wait_for_fault(self.make_context())
            self.drawn.clear()
            for _ in range(3):
                self.viewport.draw(self.make_context(), self.depsgraph)
            self.assertEqual((render.call_count, self.drawn, self.engine.texts), (1, [], ["Relief: no such device"]))
            self.wait_for_fault(self.make_context(0.3), calls=(render, 2))
        self.draw_until_done(self.make_context(0.6))
        self.assertEqual(self.engine.texts[-1], "")

    def wait_for_fault(self, context, calls=None):
        limit = time.monotonic() + 30
        while time.monotonic() < limit:
            self.viewport.draw(context, self.depsgraph)
            if self.engine.texts and self.engine.texts[-1] and (calls is None or calls[0].call_count == calls[1]):
                return
            time.sleep(0.01)
        self.fail(self.engine.texts)

    def test_a_fault_of_drawing_is_shown_once_for_a_view(self):
        calls = []

        def fail_to_draw(*arguments):
            calls.append(arguments)
            raise RuntimeError("no GPU")
        self.viewport._draw_picture = fail_to_draw
        self.viewport.update(self.make_context(), self.depsgraph)
        self.wait_for_fault(self.make_context())
        for _ in range(3):
            self.viewport.draw(self.make_context(), self.depsgraph)
        self.assertEqual((len(calls), len(self.engine.errors)), (1, 1))
        self.assertIn("no GPU", self.engine.errors[0])

    def test_tiles_of_images_are_read_once_for_all_changes(self):
        for number in (1001, 1002):
            tile = make_image("tile", np.full((4, 4, 3), 0.5, np.float32))
            tile.filepath_raw, tile.file_format = str(self.folder / f"tile.{number}.png"), "PNG"
            tile.save()
        bpy.ops.image.open(filepath=str(self.folder / "tile.1001.png"), use_udim_detecting=True)
        tree = self.grid.active_material.node_tree
        texture = tree.nodes.new("ShaderNodeTexImage")
        texture.image = bpy.data.images["tile.<UDIM>.png"]
        tree.links.new(texture.outputs["Color"], tree.nodes["Principled BSDF"].inputs["Base Color"])
        self.depsgraph = bpy.context.evaluated_depsgraph_get()
        with mock.patch.object(images, "_load_tile", wraps=images._load_tile) as load:
            for _ in range(3):
                self.change(self.make_context())
            self.assertEqual(load.call_count, 1)
        self.assertEqual(self.engine.errors, [])

    # Its end

    def test_a_new_view_does_not_wait_for_preparation_and_prepares_nothing_beside_it(self):
        may_end = threading.Event()
        self.addCleanup(may_end.set)
        with mock.patch.object(relief, "render", side_effect=end_at(may_end)) as render:
            self.viewport.update(self.make_context(), self.depsgraph)
            start = time.monotonic()
            for turn in (0, 0.1, 0.2, 0.3):
                self.viewport.draw(self.make_context(turn), self.depsgraph)
            self.change(self.make_context())
            self.assertLess(time.monotonic() - start, 5)
            self.assertEqual(render.call_count, 1)
        may_end.set()
        fine = self.draw_until_done(self.make_context(0.3))
        self.assertEqual(fine.shape, (60, 80, 4))
        self.assertEqual(self.engine.errors, [])

    def test_a_change_of_the_focus_begins_anew(self):
        context = self.make_context(perspective="CAMERA")
        self.viewport.update(context, self.depsgraph)
        self.draw_until_done(context)
        dof = bpy.context.scene.camera.data.dof
        dof.use_dof, dof.focus_distance, dof.aperture_fstop = True, 1.0, 0.01
        with mock.patch.object(relief, "render", wraps=relief.render) as render:
            self.draw_until_done(context)
        self.assertEqual(render.call_count, 2)

    def test_blender_letting_go_of_an_engine_stops_its_viewport_at_once(self):
        may_end, jobs, gone = threading.Event(), [], []
        self.addCleanup(may_end.set)

        def view(engine, depsgraph):
            viewport = engine._find_viewport()
            viewport._job = RenderJob(relief.Scene(), {})
            viewport._job.on_news = viewport_module.make_redraw(viewport._engine)
            jobs.append(viewport._job)
            gone.append(viewport._engine)
        bpy.context.scene.render.engine = "RELIEF"
        gc.disable()
        self.addCleanup(gc.enable)
        with mock.patch.object(relief, "render", end_at(may_end)), mock.patch.object(ReliefEngine, "render", view):
            bpy.ops.render.render()
            self.assertIsNone(gone[0]())
            self.assertTrue(jobs[0].is_cancelled)


if __name__ == "__main__":
    main()
