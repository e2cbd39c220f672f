"""Scenes that stay prepared while they change."""
import gc
import os
import pathlib
import tempfile
import threading
import unittest
import weakref

import numpy as np

import relief
import scenes


def make_body(turns: int = 8, height: float = 1.0) -> relief.Mesh:
    """A grid of squares, a little bent."""
    v, u = np.mgrid[0:turns + 1, 0:turns + 1] / turns
    positions = np.stack([2 * u - 1, 2 * v - 1, height * 0.1 * u * v], -1).reshape(-1, 3).astype(np.float32)
    corner = np.arange(turns)[:, None] * (turns + 1) + np.arange(turns)
    faces = np.stack([corner, corner + 1, corner + turns + 2, corner + turns + 1], -1).reshape(-1, 4)
    uvs = np.stack([u, v], -1).reshape(-1, 2).astype(np.float32)[faces.reshape(-1)]
    return relief.Mesh(positions, faces, uvs=uvs)


def make_scene() -> relief.Scene:
    """Two displaced bodies with a texture each, one of them an array."""
    scene = relief.Scene.from_mesh(make_body(), relief.Displacement(scenes.make_waves(), space="tangent", midlevel=0))
    color = np.linspace(0, 1, 8 * 8 * 3, dtype=np.float32).reshape(8, 8, 3)
    scene.add(make_body(6), "displacement", relief.Material(base_color={"file": color}),
              transform={"translate": [0.4, 0.3, 0.5], "scale": 0.5}, name="second")
    scene.render.update(width=64, height=48, spp=2, bounces=1)
    return scene


class LiveSceneTest(unittest.TestCase):
    def setUp(self) -> None:
        self.scene = make_scene()
        self.live = relief.LiveScene(self.scene)
        self.made = self.live.made_surfaces
        self.assertEqual(self.made, 2)

    def expect_same(self, made: int = 0) -> None:
        """As a fresh render, after so many surfaces more."""
        self.live.change_scene(self.scene)
        np.testing.assert_array_equal(self.live.render().array, relief.render(self.scene).array)
        self.assertEqual(self.live.made_surfaces, self.made + made)

    def test_the_first_picture_is_that_of_a_render(self):
        np.testing.assert_array_equal(self.live.render().array, relief.render(self.scene).array)
        self.assertEqual(self.live.render().statistics["scene"], relief.render(self.scene).statistics["scene"])

    def test_another_weld_makes_a_surface_anew(self):
        part = self.scene.meshes[self.scene.objects[1]["mesh"]]
        mesh = part if isinstance(part, relief.Mesh) else part["file"]
        mesh.weld = 1e-3
        self.expect_same(made=1)
        self.live.change_scene(self.scene)
        self.assertEqual(self.live.made_surfaces, self.made + 1)

    def test_objects_lights_and_materials_change_without_a_surface(self):
        before = self.live.render().array
        self.scene.objects[1]["transform"] = {"translate": [-0.4, 0.3, 0.6], "scale": 0.4}
        self.expect_same()
        self.assertFalse((before == self.live.render().array).all())
        self.scene.lights[0]["strength"] = 5
        self.scene.materials["second"]["specular_roughness"] = 0.2
        self.expect_same()
        self.scene.environment = relief.Environment(color=[0.2, 0.4, 0.9])
        self.scene.camera["fov_degrees"] = 50
        self.expect_same()
        self.scene.materials["second"]["base_color"] = {"file": np.full((4, 4, 3), 0.2, np.float32)}
        self.expect_same()

    def test_a_changed_mesh_is_prepared_alone(self):
        self.scene.meshes["second"] = make_body(6, 3)
        self.expect_same(1)
        self.scene.meshes["second"].positions = self.scene.meshes["second"].positions * np.float32(1.2)
        self.expect_same(2)
        self.scene.meshes["second"].subdivision = {"scheme": "catmark", "level": 1}
        self.expect_same(3)
        self.expect_same(3)

    def test_objects_come_and_go(self):
        self.scene.meshes = {"a third": make_body(4), **self.scene.meshes}
        self.scene.objects.insert(0, {"name": "third", "mesh": "a third", "material": "clay",
                                      "transform": {"translate": [0, 0, 0.7], "scale": 0.2}})
        self.expect_same(1)
        del self.scene.objects[1], self.scene.meshes["mesh"]
        self.expect_same(1)

    def test_a_changed_map_is_seen_by_the_array(self):
        texels = self.scene.displacements["displacement"]["file"]
        self.scene.displacements["displacement"]["file"] = 2 * texels
        self.expect_same()
        self.scene.displacements["displacement"]["scale"] = 0.5
        self.expect_same()

    def test_the_view_changes_alone(self):
        camera = relief.Camera(from_=(2, 1, 3), to=(0, 0, 0))
        self.live.change_view(camera, size=(48, 32), spp=1)
        self.scene.camera = camera
        np.testing.assert_array_equal(self.live.render().array, relief.render(self.scene, size=(48, 32), spp=1).array)
        with self.assertRaisesRegex(TypeError, "not layers: begin another LiveScene"):
            self.live.change_view(layers=["N"])
        self.assertEqual(self.live.made_surfaces, self.made)

    def test_files_are_read_again_when_they_have_changed(self):
        with tempfile.TemporaryDirectory() as folder:
            make_body().save(pathlib.Path(folder, "body.ply"))
            self.scene.folder = folder
            self.scene.meshes["mesh"] = {"file": "body.ply"}
            self.expect_same(1)
            self.expect_same(1)
            make_body(5).save(pathlib.Path(folder, "body.ply"))
            self.expect_same(2)

    def test_picture_files_are_read_again_when_they_have_changed(self):
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "light.exr")
            for strength in (1, 3, 3):
                relief.render(self.scene, size=(8, 4), spp=1, background=(strength, 1, 0)).save(file)
                self.scene.environment = relief.Environment(file)
                self.expect_same()

    # Faults and stops

    def test_a_scene_with_a_fault_changes_nothing(self):
        whole = self.scene.objects[1]["transform"]
        self.scene.objects[1]["transform"] = {"scale": 0}
        with self.assertRaisesRegex(relief.Error, "singular"):
            self.live.change_scene(self.scene)
        self.scene.objects[1]["transform"] = whole
        self.expect_same()

    def test_a_stopped_change_keeps_what_was_there(self):
        mesh, self.scene.meshes["second"] = self.scene.meshes["second"], make_body(700)
        with self.assertRaises(relief.Error) as caught:
            self.live.change_scene(self.scene, progress=lambda progress: False)
        self.assertEqual(caught.exception.kind, "failed")
        self.scene.meshes["second"] = mesh
        self.expect_same()

    def test_an_exception_of_a_callback_comes_out(self):
        def fail(progress):
            raise KeyError("mine")
        with self.assertRaisesRegex(KeyError, "mine"):
            relief.LiveScene(relief.Scene.from_mesh(make_body(300)), progress=fail)

    def test_progress_tells_of_the_preparation(self):
        told = []
        relief.LiveScene(self.scene, progress=lambda progress: told.append((progress.prepared, progress.fraction)))
        self.assertTrue(all(0 <= prepared <= 1 and fraction == 0 for prepared, fraction in told), told)

    def test_a_callback_changes_nothing(self):
        with self.assertRaisesRegex(relief.Error, "at work in another call"):
            self.live.render(on_picture=lambda picture: self.live.change_view(spp=1), picture_interval=0)

    # Memory

    def test_release_lets_go_of_arrays(self):
        mesh = make_body()
        positions = weakref.ref(mesh.positions)
        scene = relief.Scene.from_mesh(mesh)
        scene.render.update(width=64, height=48, spp=1)
        live = relief.LiveScene(scene, release=True)
        gc.collect()
        self.assertIsNone(positions())
        before = live.render().array
        scene.lights[0]["strength"] = 0
        live.change_scene(scene)
        self.assertFalse((before == live.render().array).all())
        self.assertEqual(live.made_surfaces, 1)
        with self.assertRaisesRegex(relief.Error, "give a new Mesh"):
            relief.render(scene)

    def test_a_render_lets_go_of_its_scene(self):
        texels = weakref.ref(self.scene.displacements["displacement"]["file"])
        positions = weakref.ref(self.scene.meshes["mesh"]["file"].positions)
        held = []

        def look(progress):
            gc.collect()
            held.append((texels(), positions()))
        expected = relief.render(self.scene).array
        np.testing.assert_array_equal(relief.render(self.scene, release=True, progress=look).array, expected)
        self.assertEqual(held[-1], (None, None))
        self.assertEqual((self.scene.objects, self.scene.meshes, self.scene.camera), ([], {}, None))

    def test_arrays_that_are_known_are_not_kept(self):
        texels = weakref.ref(self.scene.displacements["displacement"]["file"])
        self.scene = None
        gc.collect()
        self.assertIsNone(texels())

    def test_other_threads_go_on(self):
        scene = relief.Scene.from_mesh(make_body(40))
        made = []
        threads = [threading.Thread(target=lambda: made.append(relief.LiveScene(scene, size=(16, 16), spp=1).render()))
                   for _ in range(3)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(len(made), 3)


if __name__ == "__main__":
    unittest.main()
