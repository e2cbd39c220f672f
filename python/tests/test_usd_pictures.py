"""relief.usd in pictures: lights have the units that they should have, and a scene that goes through USD looks the same."""
import math
import os
import pathlib
import shutil
import subprocess
import unittest

import numpy as np

import relief
import relief.usd
import usd_stages as stages
from test_usd import UsdTest

try:
    from pxr import Gf, Sdf, Usd, UsdGeom, UsdLux
except ImportError:
    pass

WHITE = {"diffuseColor": (1.0, 1.0, 1.0), "roughness": 1.0, "ior": 1.0}  # an ior of 1 leaves Lambert's law alone
COMMAND = os.environ.get("RELIEF") or shutil.which("relief")


def render(scene, **settings):
    settings = {"size": (96, 54), "spp": 4, "bounces": 2, "threads": 2, "progress": None, **settings}
    return relief.render(scene, **settings)


class Units(UsdTest):
    def measure(self, kind, spp=256, **values):
        """Radiance of the middle of a white floor three units below a light that looks down; of pi times it the irradiance."""
        stage = stages.create(self.path)
        stages.bind(stages.add_square(stage, "/floor"), stages.add_material(stage, "/look", **WHITE))
        light = getattr(UsdLux, kind).Define(stage, "/light")
        light.AddTranslateOp().Set(Gf.Vec3d(0, 3, 0))
        light.AddRotateXOp().Set(-90)
        for name, value in values.items():
            light.GetPrim().GetAttribute(f"inputs:{name}").Set(value)
        camera = UsdGeom.Camera.Define(stage, "/camera")
        camera.AddTranslateOp().Set(Gf.Vec3d(0, 4, 4))
        camera.AddRotateXOp().Set(-45)
        camera.CreateVerticalApertureAttr(0.1)
        scene = self.load(stage)
        os.remove(self.path)
        picture = render(scene, size=(16, 16), spp=spp, bounces=0)
        np.testing.assert_array_equal(picture.color[..., 3], 1)
        return float(picture.color[..., :3].mean())

    def test_a_rectangle_lights_a_floor_as_the_closed_form_says(self):
        a, b = 2 / 3, 1 / 3  # halves of 4 x 2, over the height
        corner = (a / math.hypot(1, a) * math.atan(b / math.hypot(1, a)) + b / math.hypot(1, b) * math.atan(a / math.hypot(1, b))) / 2
        expected = 5 * 4 * corner  # irradiance
        self.assertAlmostEqual(self.measure("RectLight", intensity=5.0, width=4.0, height=2.0) * math.pi / expected, 1, delta=0.01)

    def test_disks_spheres_suns_and_domes_light_it_by_their_radiance(self):
        disk = self.measure("DiskLight", intensity=5.0, radius=2.0) * math.pi
        self.assertAlmostEqual(disk / (5 * math.pi * 4 / (9 + 4)), 1, delta=0.01)
        sphere = self.measure("SphereLight", intensity=5.0, radius=1.5) * math.pi
        self.assertAlmostEqual(sphere / (5 * math.pi * (1.5 / 3) ** 2), 1, delta=0.01)
        sun = self.measure("DistantLight", intensity=5.0, angle=20.0) * math.pi
        self.assertAlmostEqual(sun / (5 * math.pi * math.sin(math.radians(10)) ** 2), 1, delta=0.01)
        self.assertAlmostEqual(self.measure("DomeLight", spp=1024, intensity=5.0) / 5, 1, delta=0.02)

    def test_normalized_lights_give_their_intensity(self):
        sun = self.measure("DistantLight", intensity=5.0, angle=20.0, normalize=True) * math.pi
        self.assertAlmostEqual(sun / 5, 1, delta=0.01)
        # Power: pi of an area light of radiance 1 / area each, from far enough a point of intensity 1.
        small = self.measure("RectLight", intensity=5.0, width=0.03, height=0.03, normalize=True) * math.pi
        self.assertAlmostEqual(small / (5 / 9), 1, delta=0.01)

    def test_a_dome_shows_its_picture_where_usd_says(self):
        stage = stages.create(self.path)
        stages.add_square(stage, "/floor")
        sky = np.zeros((8, 16, 3), np.float32)
        sky[:, 2:6] = 1, 0, 0   # longitude 90 degrees, towards +x
        sky[:, 6:10] = 0, 1, 0  # longitude 0, towards +z
        holder = relief.Scene()
        holder.environment = relief.Environment(sky)
        holder.add(relief.Mesh(stages.SQUARE, [[0, 1, 2, 3]]))
        holder.save(self.folder.name)  # which writes it as EXR
        file = relief.Scene.load(os.path.join(self.folder.name, "scene.json")).environment["file"]
        dome = UsdLux.DomeLight.Define(stage, "/sky")
        dome.CreateTextureFileAttr(f"./{file}")
        for degrees, expected in ((0, (0, 0, 0)), (-90, (1, 0, 0)), (180, (0, 1, 0))):
            camera = UsdGeom.Camera.Define(stage, "/camera")
            camera.ClearXformOpOrder()
            camera.AddTranslateOp().Set(Gf.Vec3d(0, 1, 0))
            camera.AddRotateYOp().Set(degrees)  # of a view along -z
            camera.CreateVerticalApertureAttr(1)
            picture = render(self.load(stage), size=(4, 4), spp=1)
            np.testing.assert_allclose(picture.color[..., :3].mean((0, 1)), expected, atol=0.02)


class RoundTrip(UsdTest):
    def check(self, scene, tolerance=0.0, **settings):
        """The picture of a scene, and of what USD makes of it."""
        before = render(scene, **settings)
        relief.usd.save(scene, self.path, report=self.report)
        self.assertEqual(self.report, [])
        again = self.load()
        self.assertEqual(self.report, [])
        after = render(again, **settings)
        self.assertGreater(float(before.color[..., :3].std()), 0.01)  # there is something to see
        difference = np.abs(before.color - after.color)
        if tolerance == 0:
            np.testing.assert_array_equal(after.color, before.color)
        else:
            self.assertLessEqual(float(difference.mean()), tolerance)
        return again

    def make_waves(self, size=64):
        u, v = np.meshgrid((np.arange(size) + 0.5) / size, (np.arange(size) + 0.5) / size)
        return np.stack([0.1 * np.sin(9 * v), 0.1 * np.cos(7 * u), 0.15 * np.sin(13 * u) * np.sin(11 * v)], 2).astype(np.float32)

    def make_scene(self):
        plane = relief.Mesh(stages.SQUARE, [[0, 1, 2, 3]], uvs=[[0, 0], [1, 0], [1, 1], [0, 1]])
        points = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
        faces = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
        cube = relief.Mesh(points, faces, creases=[[2, 3, 10.0], [3, 7, 1.5], [0, 0, 10.0]],
                           subdivision={"scheme": "catmark", "level": 3, "creases": True})
        scene = relief.Scene()
        scene.camera = relief.Camera(from_=(1.5, 2.25, 4.1), to=(0.3, 0.1, -0.2), up=(0.1, 1, 0), fov_degrees=41.7,
                                     aperture_radius=0.03, focus_distance=4.3)
        color = np.random.default_rng(3).random((16, 16, 3)).astype(np.float32)
        scene.add(plane, relief.Displacement(self.make_waves(), scale=[1.25, 1, 0.75], axes="t,-b,n", filter="cubic"),
                  relief.Material(base_color={"file": color, "factor": 0.8, "wrap": "mirror", "uv_scale": [2, 3]},
                                  roughness=0.3, coat_weight=0.5, coat_color=[1, 0.9, 0.7]), name="waves")
        scene.add(cube, None, relief.Material(base_color=[0.9, 0.6, 0.2], metallic=1, roughness=0.35, specular_color=[1, 0.9, 0.8]),
                  {"translate": [0.9, 0.5, -0.7], "rotate_degrees": [10, 25, 5], "scale": 0.4}, "cube")
        scene.add(plane, relief.Displacement(self.make_waves()[..., 2], type="height", midlevel=0.05), None,
                  {"translate": [-1.9, 0.1, -1], "rotate_degrees": [0, 30, 0]}, "hill")
        scene.add(plane, None, relief.Material(base_color=[0, 0, 0], emission=[3, 2, 1]),
                  {"translate": [-1, 2, -2], "rotate_degrees": [110, 0, 0], "scale": 0.3}, "light")
        scene.lights = [relief.Light(type="sun", direction=[-1, -2, -1.5], strength=1.5, angle_degrees=2),
                        relief.Light(type="point", position=[1, 2, 1], radius=0.1, strength=2, color=[1, 0.5, 0.3]),
                        relief.Light(type="rectangle", position=[-2, 2, 1], direction=[1, -1, 0], width=1.5, height=0.5, strength=3,
                                     light_link_includes=["waves"]),
                        relief.Light(type="disk", position=[0, 3, 0], radius=0.4, strength=1, light_group="top"),
                        relief.Light(type="spot", position=[2, 3, 2], direction=[-1, -1.5, -1], angle_degrees=35, blend=0.4, strength=4)]
        scene.environment = relief.Environment(np.random.default_rng(4).random((8, 16, 3)).astype(np.float32), strength=0.3,
                                               rotate_degrees=77)
        scene.render = {"width": 96, "height": 54, "spp": 4}
        return scene

    def test_a_scene_of_every_part_looks_the_same(self):
        again = self.check(self.make_scene())
        self.assertEqual([o["name"] for o in again.objects], ["waves", "cube", "hill", "light"])
        self.assertEqual(len(again.meshes), 2)
        self.assertEqual(again.lights[2]["light_link_includes"], ["waves"])
        self.assertEqual(again.render["spp"], 4)

    def test_displaced_surfaces_keep_their_bits(self):
        scene = self.make_scene()
        scene.lights, scene.camera["aperture_radius"] = scene.lights[:1], 0
        for entry in scene.objects:
            entry.pop("transform", None)
        before = render(scene, layers=("depth", "uv"))
        relief.usd.save(scene, self.path)
        after = render(self.load(), layers=("depth", "uv"))
        for layer in ("depth", "uv"):
            np.testing.assert_array_equal(after[layer], before[layer])

    def test_binary_files_are_the_same_scene(self):
        scene = self.make_scene()
        relief.usd.save(scene, self.path)
        text = self.load()
        self.path = os.path.join(self.folder.name, "other", "shot.usdc")
        relief.usd.save(scene, self.path)
        np.testing.assert_array_equal(render(self.load()).color, render(text).color)

    @unittest.skipIf(COMMAND is None, "the command relief is neither in RELIEF nor in PATH")
    def test_samples_look_the_same(self):
        for name in ("pumpkin", "materials"):
            folder = os.path.join(self.folder.name, name)
            subprocess.run([COMMAND, "scene", name, "-o", folder], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            self.path = os.path.join(self.folder.name, f"{name}.usda")
            self.check(relief.Scene.load(os.path.join(folder, "scene.json")), spp=2)

    def test_the_command_writes_a_scene(self):
        relief.usd.save(self.make_scene(), self.path)
        out = os.path.join(self.folder.name, "out", "scene.json")
        self.assertEqual(relief.usd.main([self.path, "-o", out, "-q"]), 0)
        found = relief.Scene.load(out)
        np.testing.assert_allclose(render(found).color, render(self.load()).color, atol=1e-4)
        self.assertEqual(relief.usd.main([os.path.join(self.folder.name, "none.usda"), "-o", out, "-q"]), 3)

    def test_what_cannot_be_saved_is_an_error(self):
        with self.assertRaisesRegex(relief.Error, "ending"):
            relief.usd.save(self.make_scene(), os.path.join(self.folder.name, "scene.obj"))
        self.assertEqual(list(pathlib.Path(self.folder.name).iterdir()), [])


if __name__ == "__main__":
    unittest.main()
