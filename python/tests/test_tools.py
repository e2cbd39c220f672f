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


def make_slope() -> relief.Mesh:
    """Curved, with uvs at an angle to its edges."""
    x, z = (grid.reshape(-1) for grid in np.meshgrid(np.linspace(-1, 1, 5), np.linspace(-1, 1, 5)))
    rows = np.arange(25).reshape(5, 5)
    quads = np.stack([rows[:-1, :-1], rows[:-1, 1:], rows[1:, 1:], rows[1:, :-1]], 2).reshape(-1, 4)
    uvs = np.stack([0.5 + 0.3 * x, 0.45 + 0.2 * z + 0.04 * x], 1)
    return relief.Mesh(np.stack([x + 0.2 * z, 0.3 * np.sin(2 * x) * np.cos(z), -z], 1), quads, uvs, quads)


class ConvertTest(unittest.TestCase):
    """The surface that a map displaces is the same before and after."""
    KEYS = [{}, {"scale": 3}, {"midlevel": 0.5}, {"midlevel": [0.1, 0.2, 0.3], "scale": [1, 2, 3]}, {"space": "object"},
            {"axes": "x,z,-y"}, {"axes": "n,-t,b"}, {"type": "vector"}, {"frame": "dpdu", "lengths": "relative"},
            {"flip_v": True}, {"encoding": "signed"}]
    PRESETS = ["blender-brush", "genvdm", "3dcoat", "vray-tangent", "mudbox", "maya", "cycles", "arnold", "moonray", "daz16"]

    def setUp(self):
        self.mesh = make_slope()
        v, u = np.mgrid[0:64, 0:64] / 64
        self.texels = 0.1 * np.stack([np.sin(6 * u) * np.cos(5 * v), np.cos(4 * u) * np.sin(3 * v), np.sin(9 * u) * np.sin(7 * v)], 2)
        heights, vectors = self.texels[:, :, 2], self.texels
        self.sources = {"heights": relief.Displacement(heights), "declared heights": relief.Displacement(heights, type="height"),
                        "vectors": relief.Displacement(vectors, space="tangent", axes="t,b,n", midlevel=0.02, scale=1.5, wrap="mirror"),
                        "vectors of an object": relief.Displacement(vectors, axes="x,y,z", scale=2)}

    def displace(self, displacement):
        scene = relief.Scene()
        scene.add(self.mesh, displacement=displacement)
        return np.asarray(relief.convert(scene, level=3).positions)

    def check_same(self, source, **to):
        made = relief.convert(source, mesh=self.mesh, **to)
        self.assertLess(np.abs(self.displace(made) - self.displace(source)).max(), 4e-3, made)
        return made

    def test_a_map_in_another_convention_displaces_as_before(self):
        for name, source in self.sources.items():
            for to in self.KEYS:
                with self.subTest(name, to=to):
                    made = self.check_same(source, **to)
                    self.assertEqual((made["type"], made["file"].shape[2]), ("vector", 3))

    def test_heights_stay_heights_where_they_are_asked_for(self):
        for name in ("heights", "declared heights"):
            for to in ({}, {"midlevel": 0.5, "scale": 2}, {"preset": "daz16"}, {"flip_v": True}):
                with self.subTest(name, to=to):
                    made = self.check_same(self.sources[name], type="height", **to)
                    self.assertEqual((made["type"], made["file"].shape[2]), ("height", 1))

    def test_a_map_in_the_convention_of_a_program_displaces_as_before(self):
        for name, source in self.sources.items():
            for preset in self.PRESETS:
                with self.subTest(name, preset=preset):
                    self.check_same(source, preset=preset)
        for preset in self.PRESETS:
            with self.subTest(preset):
                self.check_same(relief.Displacement(self.texels + 0.45, preset=preset), preset="maya")

    def test_a_converted_map_says_all_that_it_means(self):
        made = relief.convert(self.sources["vectors"], preset="daz16", scale=[1, 2, 2])
        texels = made.pop("file")
        self.assertEqual(texels.shape, (64, 64, 3))
        self.assertEqual(made, {"type": "vector", "space": "tangent", "axes": "t,n,b", "frame": "mikk", "lengths": "absolute",
                                "midlevel": 0.5, "scale": [1, 2, 2], "flip_v": False, "wrap": "mirror"})

    def test_a_preset_decides_the_space_and_else_the_map_does(self):
        in_object = self.sources["vectors of an object"]
        self.assertEqual(relief.convert(in_object, mesh=self.mesh, preset="maya")["space"], "tangent")
        self.assertEqual(relief.convert(in_object, scale=4)["space"], "object")
        self.assertEqual(relief.convert(in_object, axes="x,z,-y")["axes"], "x,z,-y")


class PackageTest(unittest.TestCase):
    def test_everything_has_a_docstring(self):
        for name in relief.__all__:
            if name not in ("NOTHING", "__version__"):
                self.assertTrue(getattr(relief, name).__doc__, name)
        self.assertTrue(re.fullmatch(r"\d+\.\d+\.\d+", relief.__version__))
        self.assertIn(relief.isas()[0], ("avx512", "avx2", "sse4", "neon", "scalar"))
        self.assertIsInstance(relief.devices(), list)


class MaterialInputsTest(unittest.TestCase):
    def test_inputs_have_the_keys_ranges_and_defaults_of_materials(self):
        inputs = {row["name"]: row for row in relief.material_inputs()}
        self.assertEqual(inputs["coat_ior"]["default"], 1.6)
        self.assertEqual((inputs["coat_ior"]["low"], inputs["coat_ior"]["high"]), (1, float("inf")))
        self.assertEqual(inputs["base_color"]["default"], [0.8, 0.8, 0.8])
        self.assertEqual(inputs["specular_roughness"]["alias"], "roughness")
        for row in inputs.values():
            self.assertTrue(row["meaning"].endswith("."), row["name"])
            if row["type"] == "normal":
                continue
            for key in filter(None, (row["name"], row["alias"])):
                scene = scenes.make_scene()
                value = row["default"]
                scene.materials["m"] = relief.Material(**{key: value})
                if key == "emission_color":
                    scene.materials["m"]["emission_luminance"] = 1
                scene.validate()
                if row["type"] in ("number", "color") and key != "emission":
                    below = row["low"] - 1
                    scene.materials["m"][key] = below if row["type"] == "number" else [below] * 3
                    with self.assertRaisesRegex(relief.Error, f"materials.m.{key}.*must be"):
                        scene.validate()
                    if row["type"] == "color":
                        scene.materials["m"][key] = [row["high"] + 1] * 3
                        with self.assertRaisesRegex(relief.Error, f"materials.m.{key}.*must be"):
                            scene.validate()


if __name__ == "__main__":
    unittest.main()
