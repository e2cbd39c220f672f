"""The viewport: its pictures, its faults, and its end."""
from support import BlenderTest, add_light, main, make_grid, make_image, make_material, subdivide  # first: it makes the add-on known
import gc
import threading
import time
import types
from unittest import mock

import bpy
import numpy as np
from mathutils import Matrix
from relief_blender import images, mesh_arrays
from relief_blender import viewport as viewport_module
from relief_blender.engine import ReliefEngine
from relief_blender.live_job import LiveJob, LiveRenders
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
        # The status, which comes without a label and is cleared too, depends on how long things take.
        if label or not text and self.texts and self.texts[-1]:
            self.texts.append(text)


def end_at(event):
    """Replaces LiveRenders.render: it prepares until an event, and is then stopped."""
    def render(*arguments):
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
        return self.drawn[-1] if self.drawn else None

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

    # What is kept

    def follow(self, change):
        """What Blender itself would say after a change, drawn."""
        def update(scene, depsgraph):
            self.depsgraph = depsgraph
            self.viewport.update(self.make_context(), depsgraph)
        bpy.app.handlers.depsgraph_update_post.append(update)
        self.addCleanup(lambda: update in bpy.app.handlers.depsgraph_update_post and
                        bpy.app.handlers.depsgraph_update_post.remove(update))
        change()
        bpy.context.view_layer.update()
        bpy.app.handlers.depsgraph_update_post.remove(update)
        self.depsgraph = bpy.context.evaluated_depsgraph_get()
        return self.draw_until_done(self.make_context())

    def begin(self):
        """Two objects, drawn. How many surfaces that took."""
        self.other = make_grid(3)
        self.other.location = 0, 0, 1
        self.other.scale = 0.3, 0.3, 0.3
        subdivide(self.other, "CATMULL_CLARK", 1)
        self.depsgraph = bpy.context.evaluated_depsgraph_get()
        self.viewport.update(self.make_context(), self.depsgraph)
        self.draw_until_done(self.make_context())
        self.follow(lambda: setattr(self.other, "hide_render", True))  # reports all changes from making them
        return self.viewport._renders.made_surfaces

    def move(self, ob, x):
        ob.location.x = x

    def test_nothing_is_prepared_again_for_views_transforms_lights_and_materials(self):
        subdivide(self.grid, "CATMULL_CLARK", 1, adaptive=True)
        made = self.begin()
        self.draw_until_done(self.make_context(0.5))
        before = self.drawn[-1]
        for x in (0.3, 0.6):
            self.follow(lambda: self.move(self.other, x))
        self.assertGreater(np.abs(before - self.drawn[-1]).mean(), 0.001)
        light = add_light("SUN", (3, -2, 4), energy=3.0)
        self.follow(lambda: setattr(light.data, "energy", 1.0))
        roughness = self.grid.active_material.node_tree.nodes["Principled BSDF"].inputs["Roughness"]
        self.follow(lambda: setattr(roughness, "default_value", 0.2))
        self.assertEqual(self.viewport._renders.made_surfaces, made)
        self.assertEqual(self.engine.errors, [])

    def test_a_changed_mesh_is_exported_and_prepared_alone(self):
        made = self.begin()

        def change():
            self.grid.data.vertices[0].co.z += 1
            self.grid.data.update()
        before = self.drawn[-1]
        with mock.patch.object(mesh_arrays, "read_mesh", wraps=mesh_arrays.read_mesh) as read:
            after = self.follow(change)
        self.assertEqual(read.call_count, 1)
        self.assertEqual(self.viewport._renders.made_surfaces, made + 1)
        self.assertGreater(np.abs(before - after).mean(), 0.001)

    def test_a_cage_below_other_modifiers_is_prepared_once(self):
        bend = self.grid.modifiers.new("bend", "SIMPLE_DEFORM")
        subdivide(self.grid, "CATMULL_CLARK", 1)
        made = self.begin()
        for x in (0.1, 0.2):
            self.follow(lambda: self.move(self.grid, x))
        self.assertEqual(self.viewport._renders.made_surfaces, made)
        self.follow(lambda: setattr(bend, "angle", 1.0))
        self.assertEqual(self.viewport._renders.made_surfaces, made + 1)

    def test_a_cage_that_is_named_as_changed_and_is_the_same_is_prepared_once(self):
        """As Blender 5 names those of displaced materials, when the material changes."""
        subdivide(self.grid, "CATMULL_CLARK", 1)
        made, follow = self.begin(), self.viewport._parts.follow
        update = types.SimpleNamespace(id=self.grid, is_updated_geometry=True)
        with mock.patch.object(self.viewport._parts, "follow", lambda depsgraph: follow(
                types.SimpleNamespace(scene=depsgraph.scene, updates=[update]))):
            with mock.patch.object(mesh_arrays, "read_mesh", wraps=mesh_arrays.read_mesh) as read:
                self.follow(lambda: self.move(self.grid, 0.2))
        self.assertEqual(read.call_count, 1)
        self.assertEqual(self.viewport._renders.made_surfaces, made)

    def test_an_object_that_comes_is_prepared_alone(self):
        made = self.begin()
        self.follow(lambda: make_grid(4))
        self.assertEqual(self.viewport._renders.made_surfaces, made + 1)
        self.follow(lambda: bpy.data.objects.remove(self.other))
        self.assertEqual(self.viewport._renders.made_surfaces, made + 1)

    def test_other_fixed_settings_prepare_all(self):
        made = self.begin()
        self.follow(lambda: setattr(bpy.context.scene.relief, "viewport_pixel_error", 3.0))
        self.viewport._key = None
        self.draw_until_done(self.make_context())
        self.assertEqual(self.viewport._renders.made_surfaces, made)
        self.assertEqual(self.engine.errors, [])

    def test_a_stopped_preparation_is_begun_again(self):
        with mock.patch.object(RenderJob, "_on_progress", return_value=False):
            with mock.patch.object(LiveJob, "is_cancelled", True):
                self.viewport.update(self.make_context(), self.depsgraph)
                self.draw_until_done(self.make_context())
        self.viewport._key = None
        self.assertEqual(self.draw_until_done(self.make_context()).shape, (60, 80, 4))
        self.assertEqual(self.engine.errors, [])

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
        with mock.patch.object(LiveRenders, "render", side_effect=relief.Error("no such device")) as render:
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
        with mock.patch.object(LiveRenders, "render", side_effect=end_at(may_end)) as render:
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
        with mock.patch.object(self.viewport._renders, "render", wraps=self.viewport._renders.render) as render:
            self.draw_until_done(context)
        self.assertEqual(render.call_count, 2)

    def test_blender_letting_go_of_an_engine_stops_its_viewport_at_once(self):
        may_end, jobs, gone = threading.Event(), [], []
        self.addCleanup(may_end.set)

        def view(engine, depsgraph):
            viewport = engine._find_viewport()
            viewport._job = LiveJob(LiveRenders(), relief.Scene(), {})
            viewport._job.on_news = viewport_module.make_redraw(viewport._engine)
            jobs.append(viewport._job)
            gone.append(viewport._engine)
        bpy.context.scene.render.engine = "RELIEF"
        gc.disable()
        self.addCleanup(gc.enable)
        with mock.patch.object(LiveRenders, "render", end_at(may_end)), mock.patch.object(ReliefEngine, "render", view):
            bpy.ops.render.render()
            self.assertIsNone(gone[0]())
            self.assertTrue(jobs[0].is_cancelled)


if __name__ == "__main__":
    main()
