"""The life of the add-on: registering, what is kept of renders, the viewport."""
from support import BlenderTest, main, make_grid, make_material  # first: it makes the add-on known
import time
import types

import bpy
import numpy as np
import relief_blender
from mathutils import Matrix
from relief_blender import statistics
from relief_blender.viewport import Viewport


class Engine(BlenderTest):
    def test_it_registers_and_unregisters_cleanly(self):
        relief_blender.unregister()
        self.assertFalse(hasattr(bpy.types.Scene, "relief"))
        self.assertFalse(any("RELIEF" in getattr(p, "COMPAT_ENGINES", ()) for p in bpy.types.Panel.__subclasses__()))
        with self.assertRaises(TypeError):
            bpy.context.scene.render.engine = "RELIEF"
        relief_blender.register()
        bpy.context.scene.render.engine = "RELIEF"
        self.assertGreater(bpy.context.scene.relief.samples, 0)

    def test_statistics_and_report_are_kept_for_the_panel(self):
        make_material(make_grid(3), Subsurface_Weight=0.5)
        self.render("RELIEF")
        found, lines, fault = statistics.find(bpy.context.scene)
        self.assertEqual((len(lines), fault), (1, ""))
        labels = dict(statistics.describe(found))
        self.assertEqual((labels["Instances"], labels["Triangles"]), ("1", "18"), labels)
        self.assertNotIn("0.0 MiB", labels["Peak of the process"])
        self.assertTrue(labels["Device"])

    def test_statistics_are_those_of_a_scene_and_not_of_its_name(self):
        make_grid(2)
        self.render("RELIEF", samples=1)
        scene = bpy.context.scene
        scene.name, other = "renamed", bpy.data.scenes.new("Scene")
        self.assertIsNotNone(statistics.find(scene))
        self.assertIsNone(statistics.find(other))

    def test_statistics_are_forgotten_with_their_file(self):
        make_grid(2)
        self.render("RELIEF", samples=1)
        bpy.ops.wm.save_as_mainfile(filepath=str(self.folder / "a.blend"))
        self.assertEqual(len(statistics._kept), 1)
        bpy.ops.wm.open_mainfile(filepath=str(self.folder / "a.blend"))
        self.assertEqual(len(statistics._kept), 0)
        self.assertIsNone(statistics.find(bpy.context.scene))
        relief_blender.unregister()
        self.assertFalse([f for f in bpy.app.handlers.load_post if f.__module__.startswith("relief_blender")])
        relief_blender.register()


class View(BlenderTest):
    """The viewport's logic, with a region and a screen that are made up."""

    def setUp(self):
        super().setUp()
        self.grid = make_grid(2)
        make_material(self.grid)
        bpy.context.scene.relief.viewport_samples = 4
        self.drawn = []
        self.engine = types.SimpleNamespace(tag_redraw=lambda: None, report=lambda kind, text: self.fail(text))
        self.viewport = Viewport(self.engine, lambda scene, array, width, height: self.drawn.append(array))
        self.addCleanup(self.viewport.stop)
        self.depsgraph = bpy.context.evaluated_depsgraph_get()

    def make_context(self, turn=0.0):
        camera = self.camera.evaluated_get(self.depsgraph)
        projection = camera.calc_matrix_camera(self.depsgraph, x=80, y=60)
        view = (camera.matrix_world @ Matrix.Rotation(turn, 4, "Z")).inverted()
        region_data = types.SimpleNamespace(window_matrix=projection, view_matrix=view, view_perspective="PERSP")
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


if __name__ == "__main__":
    main()
