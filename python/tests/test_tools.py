"""inspect and convert; what the package says of itself."""
import pathlib
import re
import tempfile
import unittest

import numpy as np

import relief
import scenes


class InspectTest(unittest.TestCase):
    def test_scenes_meshes_and_maps_are_described(self):
        scene = scenes.make_scene()
        self.assertEqual(relief.inspect(scene)["values"]["patches"]["value"], 1)
        self.assertEqual(set(relief.inspect(scenes.make_plane())), {"facts", "values", "findings"})
        codes = [finding["code"] for finding in relief.inspect((scenes.make_waves() * 255).astype(np.uint8))["findings"]]
        self.assertIn("W-8BIT", codes)
        with tempfile.TemporaryDirectory() as folder:
            scene.save(folder)
            self.assertEqual(relief.inspect(pathlib.Path(folder) / "scene.json")["facts"]["patches"],
                             relief.inspect(scene)["facts"]["patches"])
            relief.inspect(pathlib.Path(folder) / "maps/displacement.exr", mesh=pathlib.Path(folder) / "meshes/mesh.obj")

    def test_maps_go_to_another_convention_and_back(self):
        waves, plane = scenes.make_waves(), scenes.make_plane()
        there = relief.convert(relief.Displacement(waves, space="tangent", midlevel=0), mesh=plane, space="object", axes="x,z,-y")
        back = relief.convert(there, mesh=plane, space="tangent", axes="t,b,n")
        np.testing.assert_allclose(back["file"], waves, atol=1e-5)
        np.testing.assert_allclose(there["file"][:, :, 1], waves[:, :, 2], atol=1e-5)
        with self.assertRaises(relief.Error):
            relief.convert(relief.Displacement(waves, space="tangent"), space="object")
        with self.assertRaisesRegex(TypeError, "spaces"):
            relief.convert(relief.Displacement(waves), spaces="object")

    def test_a_displaced_surface_is_a_mesh(self):
        mesh = relief.convert(scenes.make_scene(), level=4)
        self.assertEqual(mesh.faces.shape, (256, 4))
        self.assertGreater(np.ptp(mesh.positions[:, 2]), 0.1)


class PackageTest(unittest.TestCase):
    def test_everything_has_a_docstring(self):
        for name in relief.__all__:
            if name not in ("NOTHING", "__version__"):
                self.assertTrue(getattr(relief, name).__doc__, name)
        self.assertTrue(re.fullmatch(r"\d+\.\d+\.\d+", relief.__version__))
        self.assertIn(relief.isas()[0], ("avx512", "avx2", "sse4", "neon", "scalar"))
        self.assertIsInstance(relief.devices(), list)


if __name__ == "__main__":
    unittest.main()
