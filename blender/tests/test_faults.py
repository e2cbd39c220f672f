"""Final renders that fail or are stopped: what Blender, its scripts and the panel are told."""
from support import BlenderTest, main, make_grid, make_material  # first: it makes the add-on known
import pathlib
import subprocess
import sys
import textwrap
import threading
import time
from unittest import mock

import bpy
from relief_blender import engine, faults, mesh_export, render_job, statistics
from relief_blender.engine import ReliefEngine

import relief


class Preparation:
    """In place of relief.render: prepares until it is told to end, and hears nothing meanwhile."""

    def __init__(self):
        self.may_end = threading.Event()
        self.calls = self.ends = 0

    def __call__(self, scene, progress, **settings):
        self.calls += 1
        self.may_end.wait(60)
        self.ends += 1
        raise relief.Error("the render was stopped before every pixel had a sample", kind="failed")


class Final(BlenderTest):
    def setUp(self):
        super().setUp()
        self.material = make_material(make_grid(2))
        self.scene = bpy.context.scene
        self.scene.render.engine = "RELIEF"
        self.file = self.folder / "fault.exr"
        self.scene.render.filepath = str(self.file)

    def stop_at_once(self):
        return mock.patch.object(ReliefEngine, "_is_stopped", lambda engine: True)

    def check_fault(self, *texts):
        """The render fails, says so, and writes no picture."""
        with self.assertRaises(RuntimeError) as raised:
            bpy.ops.render.render(write_still=True)
        kept = statistics.find(self.scene)
        for text in texts:
            self.assertIn(text, str(raised.exception))
            self.assertIn(text, kept.fault)
        self.assertEqual(kept.statistics, {})
        self.assertFalse(self.file.exists())

    def test_a_scene_without_a_camera_is_a_fault_and_no_crash(self):
        self.scene.camera = None
        with self.assertRaises(RuntimeError):
            bpy.ops.render.render()

    def test_a_fault_of_the_renderer_has_its_hint(self):
        with mock.patch.object(relief, "render", side_effect=relief.Error("no such device", hint="choose the CPU")):
            self.check_fault("Relief: no such device (choose the CPU)")

    def test_what_nobody_foresaw_has_its_object_type_and_line(self):
        with mock.patch.object(mesh_export.MeshExport, "export", side_effect=KeyError("uv")):
            self.check_fault('Relief: object "thing": KeyError: \'uv\'', "a fault of the add-on", ".py:")

    def test_faults_of_materials_and_worlds_have_their_places(self):
        with mock.patch("relief_blender.material_export.Shaders", side_effect=AttributeError("no socket")):
            self.check_fault('object "thing", material "material": AttributeError: no socket')
        with mock.patch("relief_blender.scene_export.export_world", side_effect=OSError(28, "No space left")):
            self.check_fault("Relief: world: [Errno 28] No space left")

    def test_faults_while_a_picture_is_shown(self):
        with mock.patch.object(engine.passes, "make_combined", side_effect=MemoryError):
            self.check_fault("Relief: there is not enough memory (")

    def test_a_fault_ends_an_animation(self):
        self.scene.frame_start, self.scene.frame_end = 1, 3
        with mock.patch.object(mesh_export.MeshExport, "export", side_effect=KeyError("uv")) as export:
            with self.assertRaises(RuntimeError):
                bpy.ops.render.render(animation=True)
        self.assertEqual(export.call_count, 1)
        self.assertEqual(list(self.folder.iterdir()), [])

    def test_after_a_fault_the_next_render_has_a_picture(self):
        with mock.patch.object(relief, "render", side_effect=relief.Error("no such device")):
            self.check_fault("no such device")
        self.render("RELIEF", samples=1)
        self.assertEqual(statistics.find(self.scene).fault, "")

    def test_places_are_told_from_outside_to_inside(self):
        with self.assertRaises(ValueError) as raised:
            with faults.place("object", "a"), faults.place("world", ""):
                raise ValueError("odd")
        self.assertEqual(faults.describe(raised.exception).split(" (")[0], 'Relief: object "a", world: ValueError: odd')

    # Stopped renders

    def test_stopping_a_render_ends_it_soon(self):
        self.scene.relief.samples = 1 << 20
        start = time.monotonic()
        with self.stop_at_once():
            bpy.ops.render.render()
        self.assertLess(time.monotonic() - start, 10)

    def test_stopping_before_the_first_sample_is_no_fault(self):
        error = relief.Error("the render was stopped before every pixel had a sample", kind="failed")
        with self.stop_at_once(), mock.patch.object(relief, "render", side_effect=error):
            self.assertEqual(bpy.ops.render.render(), {"FINISHED"})
        self.assertIsNone(statistics.find(self.scene))
        with mock.patch.object(relief, "render", side_effect=error):
            self.check_fault("stopped before every pixel")

    def test_stopping_a_real_render_before_its_first_sample_is_no_fault(self):
        self.scene.render.resolution_x = self.scene.render.resolution_y = 3000
        self.scene.render.use_border, self.scene.render.border_max_x = True, 0.9
        with self.stop_at_once():
            self.assertEqual(bpy.ops.render.render(), {"FINISHED"})
        self.assertIsNone(statistics.find(self.scene))

    def test_stopping_does_not_wait_for_preparation_but_the_next_render_does(self):
        preparation = Preparation()
        self.addCleanup(preparation.may_end.set)
        with mock.patch.object(relief, "render", preparation):
            start = time.monotonic()
            with self.stop_at_once():
                bpy.ops.render.render()
                self.assertLess(time.monotonic() - start, engine.PATIENCE + 5)
                self.assertTrue(render_job.has_left(0))
                bpy.ops.render.render()
            self.assertEqual((preparation.calls, preparation.ends), (1, 0), "a second preparation began")
            threading.Timer(0.3, preparation.may_end.set).start()
            with self.assertRaises(RuntimeError):
                bpy.ops.render.render()
        self.assertEqual(preparation.ends, 2)
        self.assertFalse(render_job.has_left(5))

    def test_files_of_motion_go_when_the_render_that_was_left_ends(self):
        preparation, ended = Preparation(), threading.Event()
        with mock.patch.object(relief, "render", preparation):
            job = render_job.RenderJob(relief.Scene(), {}, on_end=ended.set)
            job.leave()
            self.assertFalse(ended.is_set())
            preparation.may_end.set()
            self.assertTrue(ended.wait(10))

    def test_python_ends_cleanly_while_a_render_that_was_left_goes_on(self):
        script = """
            import sys
            sys.path.insert(0, sys.argv[1])
            import bpy, numpy as np, relief
            import relief_blender
            from relief_blender.render_job import RenderJob
            relief_blender.register()
            mesh = relief.Mesh([[-1, 0, 1], [1, 0, 1], [1, 0, -1], [-1, 0, -1]], [[0, 1, 2, 3]],
                               uvs=[[0, 0], [1, 0], [1, 1], [0, 1]])
            scene = relief.Scene.from_mesh(mesh, np.zeros((4096, 4096), np.float32))
            job = RenderJob(scene, {"size": (2048, 2048), "spp": 1 << 20})
            job.leave()
            print("left", job._thread.is_alive())
            relief_blender.unregister()
            """
        folder = pathlib.Path(engine.__file__).resolve().parent.parent
        done = subprocess.run([sys.executable, "-c", textwrap.dedent(script), folder], capture_output=True, text=True, timeout=120)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("left True", done.stdout)


if __name__ == "__main__":
    main()
