"""Renders: settings, pictures, callbacks, interrupts, threads and the end of Python."""
import json
import math
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import textwrap
import threading
import time
import unittest

import numpy as np

import relief
import scenes

SLOW = dict(size=(320, 240), spp=100000, bounces=4)


class RenderTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        cls.scene = scenes.make_scene()

    def test_a_picture_has_layers_without_copies(self):
        picture = relief.render(self.scene, layers=("depth", "N", "id", "samples"), seed=3)
        self.assertEqual(picture.array.shape, (48, 64, len(picture.channels)))
        self.assertEqual(picture["depth"].shape, (48, 64))
        self.assertEqual(picture["N"].shape, (48, 64, 3))
        for view in (picture["depth"], picture["N"], picture["R"], picture.color):
            self.assertTrue(np.shares_memory(view, picture.array))
        self.assertTrue((picture["samples"] == 2).all())
        self.assertTrue(picture.complete)
        self.assertEqual((picture.samples, picture.statistics["image"]["spp"], picture.size), (2, 2, (64, 48)))
        with self.assertRaisesRegex(KeyError, "depth"):
            picture["deep"]

    def test_pixels_outlive_their_picture(self):
        depth = relief.render(self.scene, layers="depth")["depth"]
        self.assertTrue(np.isfinite(depth).any())

    def test_a_crop_is_a_part_of_the_whole(self):
        whole = relief.render(self.scene).array
        part = relief.render(self.scene, crop=(10, 20, 40, 44))
        np.testing.assert_array_equal(part.array, whole[20:44, 10:40])
        self.assertEqual((part.window, part.full_size), ((10, 20, 40, 44), (64, 48)))

    def test_threads_do_not_change_a_picture(self):
        np.testing.assert_array_equal(relief.render(self.scene, threads=1).array, relief.render(self.scene, threads=3).array)

    def test_frames_are_those_of_the_keys(self):
        keys = {"keys": [[1, [0, 0, 4]], [3, [0, 0, 8]]]}
        scene = scenes.make_scene()
        scene.camera = relief.Camera(from_=keys, to=(0, 0, 0))
        stills = []
        for z in (4, 6, 8):
            still = scenes.make_scene()
            still.camera = relief.Camera(from_=(0, 0, z), to=(0, 0, 0))
            stills.append(relief.render(still).array)
        for frame, still in zip((None, 2, 3), stills):
            np.testing.assert_array_equal(relief.render(scene, frame=frame).array, still)
            np.testing.assert_array_equal(relief.Session(scene, frame=frame).render().array, still)
        self.assertFalse(np.array_equal(stills[0], stills[1]))
        with tempfile.TemporaryDirectory() as folder:
            scene.save(folder)
            file = pathlib.Path(folder) / "scene.json"
            root = json.loads(file.read_text())
            root["camera"]["from"] = keys
            file.write_text(json.dumps(root))
            np.testing.assert_array_equal(relief.render(file, frame=2).array, stills[1])
        with self.assertRaisesRegex(relief.Error, "frame: nan is not a number"):
            relief.render(scene, frame=float("nan"))
        self.assertEqual(relief.parse_frames("1-7x3,12"), [1, 4, 7, 12])
        self.assertEqual(relief.name_frame("wave.####.exr", 12), "wave.0012.exr")

    def test_motion_blur_is_the_mean_of_still_pictures(self):
        scene = scenes.make_scene()
        scene.objects[0]["transform"] = {"translate": {"keys": [[1, [0, 0, 0]], [3, [1, 0, 0]]]}}
        scene.camera["shutter"] = (-0.5, 0.5)
        blur = relief.render(scene, frame=2, spp=4).array
        scene.camera["shutter"] = (0, 0)
        times = [2 - 0.5 + (0.5 + k * 0x9E3779B9 / 2**32) % 1 for k in range(4)]
        stills = [relief.render(scene, frame=time, spp=1, first_sample=k).array for k, time in enumerate(times)]
        np.testing.assert_array_equal(blur, np.mean(np.asarray(stills, dtype=np.float64), axis=0).astype(np.float32))
        self.assertFalse(np.array_equal(blur, relief.render(scene, frame=2, spp=4).array))

    def test_settings_that_are_wrong_are_named(self):
        for words, keys in (("'speed'.*'spp'|there is no keyword 'sppp'.*spp", dict(sppp=3)), ("spp.*whole number from 1", dict(spp=0)),
                            ("spp: 1.5 is not", dict(spp=1.5)), ("size: 5 is not two", dict(size=5)), ("spp: True is not", dict(spp=True)),
                            ("engine: 'gpu' is not one of cpu, vulkan", dict(engine="gpu")), ("noise", dict(noise=2)),
                            ("layer", dict(layers=["dept"])), ("crop", dict(crop=(5, 5, 4, 9))), ("crop", dict(crop=(0, 0, 900, 9))),
                            ("level: 99 is not", dict(level=99)), ("background", dict(background="red"))):
            with self.assertRaisesRegex(relief.Error, words) as caught:
                relief.render(self.scene, **keys)
            self.assertEqual(caught.exception.kind, "usage")
        with self.assertRaises(TypeError):
            relief.render(self.scene, progress=3)

    def test_files_keep_names_like_those_of_settings(self):
        with self.assertRaises(relief.Error) as raised:
            relief.Picture.load("displacement.exr")
        self.assertIn("displacement.exr", raised.exception.where)

    def test_files_of_a_picture(self):
        picture = relief.render(self.scene, background="transparent", layers="depth")
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "a.exr"
            picture.save(file)
            read = relief.Picture.load(file)
            np.testing.assert_array_equal(read["depth"], picture["depth"])
            self.assertEqual(read.metadata["relief:seed"], "0")
            png = picture.to_png(pathlib.Path(folder) / "a.png", exposure=1)
            self.assertEqual(png, (pathlib.Path(folder) / "a.png").read_bytes())
            with self.assertRaises(relief.Error):
                picture.save(pathlib.Path(folder) / "a.jpeg")
        self.assertEqual(picture._repr_png_()[:8], b"\x89PNG\r\n\x1a\n")
        self.assertEqual(png[25], 6)  # with alpha, as the film is transparent
        self.assertNotEqual(png, picture.to_png())
        self.assertNotIn("relief:exposure", picture.metadata)

    def test_tonemaps_and_exposures_that_there_are_not_are_refused(self):
        picture = relief.render(self.scene)
        self.assertEqual(picture.to_png(exposure=np.float32(0.5)), picture.to_png(exposure=0.5))
        self.assertNotEqual(picture.to_png(exposure="auto"), picture.to_png())
        with tempfile.TemporaryDirectory() as folder:
            for words, keys in (("tonemap: 'filmc' is not one of agx.*did you mean 'filmic'", dict(tonemap="filmc")),
                                ("tonemap: None", dict(tonemap=None)), ("exposure: 'x' is not", dict(exposure="x")),
                                ("exposure: nan is not", dict(exposure=math.nan)), ("exposure: None", dict(exposure=None)),
                                ("exposure: 65 is not", dict(exposure=65)), ("exposure: True", dict(exposure=True))):
                for call in (picture.to_png, lambda **keys: picture.save(os.path.join(folder, "a.exr"), **keys)):
                    with self.assertRaisesRegex(relief.Error, words):
                        call(**keys)
            with self.assertRaisesRegex(relief.Error, "b.exr' does not end in .png"):
                picture.to_png(os.path.join(folder, "b.exr"))
            self.assertEqual(os.listdir(folder), [])

    def test_progress_and_pictures_so_far_come_to_this_thread(self):
        fractions, pictures, threads = [], [], set()

        def on_progress(progress):
            fractions.append(progress.fraction), threads.add(threading.get_ident())

        def on_picture(picture):
            pictures.append(picture.array.copy()), threads.add(threading.get_ident())

        picture = relief.render(self.scene, spp=64, progress=on_progress, on_picture=on_picture, picture_interval=0.0)
        self.assertEqual(fractions, sorted(fractions))
        self.assertEqual(threads, {threading.get_ident()})
        self.assertTrue(pictures)
        self.assertEqual(pictures[0].shape, picture.array.shape)
        np.testing.assert_array_equal(picture.array, relief.render(self.scene, spp=64).array)

    def test_a_callback_stops_a_render_by_false(self):
        picture = relief.render(self.scene, **SLOW, on_picture=lambda picture: False)
        self.assertFalse(picture.complete)
        self.assertGreater(picture.samples, 0)
        with self.assertRaisesRegex(relief.Error, "stopped before"):
            relief.render(self.scene, size=(8000, 8000), spp=1, progress=lambda progress: False)

    def test_a_render_can_be_stopped_while_its_scene_is_prepared(self):
        steps = np.linspace(-1, 1, 501)
        points = np.stack([*np.meshgrid(steps, steps), np.zeros((501, 501))], -1).reshape(-1, 3)
        first = (np.arange(500)[:, None] * 501 + np.arange(500)).reshape(-1, 1)
        mesh = relief.Mesh(points, first + [0, 1, 502, 501], uvs=points[:, :2] / 2 + 0.5, uv_indices=first + [0, 1, 502, 501])
        scene, told = relief.Scene.from_mesh(mesh, scenes.make_waves()), []

        def stop(progress):
            told.append((progress.rays, progress.samples_done, progress.samples_total))
            return False

        with self.assertRaisesRegex(relief.Error, "stopped before"):
            relief.render(scene, spp=3, progress=stop, on_picture=lambda picture: self.fail("it went on"))
        self.assertEqual(told[0], (0, 0, 3))
        with self.assertRaisesRegex(ZeroDivisionError, "division"):
            relief.render(scene, spp=3, progress=lambda progress: 1 / progress.rays)

    def test_what_speaks_against_the_axes_of_a_map_is_a_warning(self):
        heights = scenes.make_waves()[:, :, ::-1].copy()
        heights[:, :, 0] = np.abs(heights[:, :, 0]) + 0.1  # along t, as the values go, and not along n
        for keys, words in (({}, "axes t,b,n are assumed"), ({"axes": "t,b,n"}, "note: .*axes t,b,n are declared")):
            scene = relief.Scene.from_mesh(scenes.make_plane(), relief.Displacement(heights, space="tangent", midlevel=0, **keys))
            warnings = relief.render(scene, size=(8, 8), spp=1).warnings
            self.assertEqual(warnings, scene.validate())
            self.assertRegex(" ".join(warnings), words)
            self.assertEqual(relief.render(scene, size=(8, 8), spp=1, check_maps=False).warnings, [])

    def test_meshes_render_as_they_are(self):
        mesh = scenes.make_plane()
        np.testing.assert_array_equal(relief.render(mesh, size=(8, 8), spp=1).array,
                                      relief.render(relief.Scene.from_mesh(mesh), size=(8, 8), spp=1).array)
        with self.assertRaisesRegex(TypeError, r"scene: a Scene, a Mesh, or the name of a file is needed, not float64 \(3,\)"):
            relief.render(np.zeros(3))

    def test_metadata_stays_as_it_is_while_a_file_is_written(self):
        picture, seen = relief.render(self.scene, size=(256, 256), spp=1), set()
        with tempfile.TemporaryDirectory() as folder:
            writers = [threading.Thread(target=lambda k=k: [picture.save(f"{folder}/{k}.png") for _ in range(10)]) for k in range(2)]
            for writer in writers:
                writer.start()
            while any(writer.is_alive() for writer in writers):
                seen |= picture.metadata.keys()
        self.assertIn("relief:seed", seen)
        self.assertNotIn("relief:display", seen)

    def test_exceptions_of_callbacks_come_out_with_the_picture(self):
        def fail(picture):
            raise ZeroDivisionError("mine")

        with self.assertRaisesRegex(ZeroDivisionError, "mine") as caught:
            relief.render(self.scene, **SLOW, on_picture=fail)
        self.assertGreater(caught.exception.picture.samples, 0)

    def test_ctrl_c_keeps_the_picture(self):
        def interrupt(picture):
            os.kill(os.getpid(), signal.SIGINT)

        picture = relief.render(self.scene, **SLOW, on_picture=interrupt)
        self.assertFalse(picture.complete)
        self.assertTrue((picture["R"] > 0).any())

    def test_python_goes_on_during_a_render_in_a_thread(self):
        done, steps = [], 0
        thread = threading.Thread(target=lambda: done.append(relief.render(self.scene, size=(320, 240), spp=16)))
        thread.start()
        while thread.is_alive():
            steps += 1
            time.sleep(0.001)
        self.assertTrue(done[0].complete)
        self.assertGreater(steps, 5)

    def test_renders_at_once_do_not_disturb_each_other(self):
        expected, found = relief.render(self.scene).array, []
        threads = [threading.Thread(target=lambda: found.append(relief.render(self.scene).array)) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for array in found:
            np.testing.assert_array_equal(array, expected)


class SessionTest(unittest.TestCase):
    def test_an_edit_makes_the_picture_of_the_edited_map(self):
        scene, waves = scenes.make_scene(), scenes.make_waves()
        session = relief.Session(scene, spp=1)
        before = session.render().array
        patch = np.full((8, 12, 3), (0, 0, 0.3), np.float32)
        self.assertGreater(session.edit("displacement", patch, x=20, y=10), 0)
        painted = waves.copy()
        painted[10:18, 20:32] = patch
        scene.displacements["displacement"]["file"] = painted
        after = session.render().array
        np.testing.assert_array_equal(after, relief.render(scene, spp=1).array)
        self.assertFalse((before == after).all())

    def test_a_view_makes_the_picture_of_its_camera_and_size(self):
        scene = scenes.make_scene()
        session = relief.Session(scene, spp=1)
        session.render()
        scene.camera = relief.Camera(from_=(0.5, 1, 2.5), to=(0, 0, 0), fov_degrees=40)
        session.change_view(scene.camera)
        np.testing.assert_array_equal(session.render().array, relief.render(scene, spp=1).array)
        session.change_view(size=(32, 40), spp=2)
        picture = session.render()
        self.assertEqual(picture.array.shape[:2], (40, 32))
        np.testing.assert_array_equal(picture.array, relief.render(scene, size=(32, 40), spp=2).array)
        for bad in (dict(camera=relief.Camera(from_=(0, 0, 0), to=(0, 0, 0))), dict(size=(0, 5))):
            with self.assertRaises(relief.Error):
                session.change_view(**bad)
        for other in (dict(layers=("depth",)), dict(level=1), dict(engine="vulkan"), dict(no_such_setting=1)):
            with self.assertRaisesRegex(TypeError, "begin another Session"):
                session.change_view(**other)
        session.change_view(crop=(4, 4, 20, 20))
        self.assertEqual(session.render().array.shape[:2], (16, 16))
        session.change_view(crop=None)
        self.assertEqual(session.render().array.shape[:2], (40, 32))

    def test_bad_edits_are_refused(self):
        session = relief.Session(scenes.make_scene(), spp=1)
        for error, keys in ((relief.Error, dict(displacement="no", texels=np.zeros((2, 2, 3), np.float32))),
                            (relief.Error, dict(displacement="displacement", texels=np.zeros((2, 2, 3), np.float32), x=63)),
                            (relief.Error, dict(displacement="displacement", texels=np.full((2, 2, 3), np.nan, np.float32))),
                            (relief.Error, dict(displacement="displacement", texels=np.zeros((2, 2), np.float32))),
                            (relief.Error, dict(displacement="displacement", texels=np.zeros((2, 2, 3), np.float32), x=-5)),
                            (relief.Error, dict(displacement="displacement", texels=np.zeros((2, 2, 3), np.float32), y=1.5)),
                            (relief.Error, dict(displacement="displacement", texels=np.zeros((2, 2, 3), np.float32), udim=3)),
                            (relief.Error, dict(displacement=5, texels=np.zeros((2, 2, 3), np.float32))),
                            (ValueError, dict(displacement="displacement", texels=np.zeros((2, 2, 7), np.float32))),
                            (TypeError, dict(displacement="displacement", texels=np.zeros((2, 2), bool)))):
            with self.assertRaises(error):
                session.edit(**keys)
        with self.assertRaisesRegex(relief.Error, "at work"):
            session.render(on_picture=lambda picture: session.edit("displacement", np.zeros((2, 2, 3), np.float32)),
                           picture_interval=0.0)


class EndTest(unittest.TestCase):
    """Python ends while threads render or trace: no crash, no deadlock."""

    def run_script(self, body: str, before: str = "") -> subprocess.CompletedProcess:
        """before: what is run before the module is imported."""
        script = "import threading, time, sys\n" + textwrap.dedent(before) + \
            "import numpy as np\nimport relief, scenes\n" + textwrap.dedent(body)
        environment = dict(os.environ, PYTHONPATH=os.pathsep.join(sys.path))
        return subprocess.run([sys.executable, "-X", "faulthandler", "-c", script], capture_output=True, text=True,
                              timeout=240, cwd=os.path.dirname(os.path.abspath(__file__)), env=environment)

    def test_during_a_render_in_a_daemon_thread(self):
        for wait in (0.0, 0.5):
            done = self.run_script(f"""
                scene, started = scenes.make_scene(), threading.Event()
                def work():
                    started.set()
                    relief.render(scene, size=(320, 240), spp=100000, progress=lambda progress: None,
                                  on_picture=lambda picture: picture.array.sum(), picture_interval=0.0)
                threading.Thread(target=work, daemon=True).start()
                started.wait()
                time.sleep({wait})
                """)
            self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_during_a_call_within_a_callback_of_a_daemon_thread(self):
        done = self.run_script("""
            scene, small, started = scenes.make_scene(), scenes.make_scene(), threading.Event()
            def trace(picture):
                started.set()
                while True:
                    relief.render(small, size=(64, 64), spp=64)
            threading.Thread(target=lambda: relief.render(scene, spp=100000, on_picture=trace), daemon=True).start()
            started.wait()
            """)
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_calls_after_the_end_neither_crash_nor_print(self):
        done = self.run_script("""
            scene = scenes.make_scene()
            def work():
                go.wait()
                relief.render(scene)
                print("rendered")
            threading.Thread(target=work, daemon=True).start()
            """, before="""
            import atexit
            go = threading.Event()
            def end():
                go.set()
                time.sleep(0.5)
                try:
                    relief.render(scene)
                except relief.Error as error:
                    print(error)
            atexit.register(end)
            """)
        self.assertEqual((done.returncode, done.stdout.strip(), done.stderr), (0, "Python is ending", ""))

    def test_of_a_child_process_that_was_forked_during_a_render(self):
        done = self.run_script("""
            import os
            scene, started = scenes.make_scene(), threading.Event()
            threading.Thread(target=lambda: relief.render(scene, size=(320, 240), spp=100000,
                                                          on_picture=lambda picture: started.set()), daemon=True).start()
            started.wait()
            child = os.fork()
            if child == 0:
                sys.exit(7)
            print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
            """)
        self.assertEqual((done.returncode, done.stdout.strip(), done.stderr), (0, "7", ""))

    def test_during_rays_in_daemon_threads(self):
        done = self.run_script("""
            intersector, rays, started = relief.Intersector(scenes.make_scene()), scenes.make_rays(20000), threading.Event()
            def work():
                while True:
                    intersector.closest_hits(rays)
                    started.set()
            for _ in range(3):
                threading.Thread(target=work, daemon=True).start()
            started.wait()
            """)
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_by_an_interrupt_without_a_picture(self):
        done = self.run_script("""
            import os, signal
            threading.Timer(0.3, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
            try:
                relief.render(scenes.make_scene(), size=(16000, 16000), spp=4, bounces=8)
            except KeyboardInterrupt as interrupt:
                print("interrupted", interrupt.picture)
            """)
        self.assertEqual((done.returncode, done.stdout.strip(), done.stderr), (0, "interrupted None", ""))


if __name__ == "__main__":
    unittest.main()
