"""relief.usd: textures of one material on several uv sets."""
import os
import unittest

import numpy as np

import relief
import usd_stages as stages
from test_usd import UsdTest

try:
    from pxr import Gf, UsdGeom, UsdShade, Vt
except ImportError:
    pass

SECOND = [(0.5, 0.25), (0.75, 0.25), (0.75, 0.5), (0.5, 0.5)]
THIRD = [(0.1, 0.1), (0.2, 0.1), (0.2, 0.2), (0.1, 0.2)]


class UvSets(UsdTest):
    def add_texture(self, stage, path, uvs=None, **inputs):
        texture = stages.add_texture(stage, path, "./maps/a.png", **inputs)
        if uvs is not None:
            reader = UsdShade.Shader.Define(stage, f"{path}_reader")
            reader.CreateIdAttr("UsdPrimvarReader_float2")
            stages.set_input(reader, "varname", uvs)
            stages.set_input(texture, "st", (reader, "result"))
        return texture

    def make(self, scheme="none", **outputs):
        """A square of a material; `outputs`: of inputs of its surface, a texture's output and the uvs that it is read on."""
        stage = stages.create(self.path)
        mesh = stages.add_square(stage, "/m", scheme)
        stages.add_uvs(mesh, SECOND, "vertex", name="second")
        stages.add_uvs(mesh, THIRD, "faceVarying", name="third")
        stages.write_png(os.path.join(self.folder.name, "maps/a.png"), stages.make_picture())
        inputs = {name: (self.add_texture(stage, f"/look/{name}", uvs), output) for name, (output, uvs) in outputs.items()}
        stages.bind(mesh, stages.add_material(stage, "/look", **inputs))
        return stage

    def corners(self, mesh, number):
        uvs, indices = (mesh.uvs, mesh.uv_indices) if number is None else mesh.further_uvs[number]
        return uvs[indices].tolist()

    def expect_sets(self, mesh, *sets):
        """Of the mesh's own uvs, then of 1, 2 and so on."""
        self.assertEqual(list(mesh.further_uvs), list(range(1, len(sets))))
        for number, uvs in enumerate(sets):
            np.testing.assert_allclose(self.corners(mesh, number or None), uvs, atol=1e-6)

    def test_names_become_numbers_of_sets(self):
        scene = self.load(self.make(diffuseColor=("rgb", "st"), roughness=("g", "second"), metallic=("b", "third"),
                                    clearcoat=("r", "second")))
        look, square = scene.materials["look"], [(0, 0), (1, 0), (1, 1), (0, 1)]
        self.assertEqual([look[name].get("uv_set") for name in ("base_color", "specular_roughness", "base_metalness", "coat_weight")],
                         [None, look["specular_roughness"]["uv_set"], look["base_metalness"]["uv_set"], look["specular_roughness"]["uv_set"]])
        self.assertEqual({look["specular_roughness"]["uv_set"], look["base_metalness"]["uv_set"]}, {1, 2})
        sets = [THIRD, SECOND] if look["base_metalness"]["uv_set"] == 1 else [SECOND, THIRD]
        self.expect_sets(scene.meshes["m"], square, *sets)
        self.assertEqual(scene.validate(), [])
        self.assertFalse(self.reported("/look", "uvs"))

    def test_displacements_and_normal_maps_have_those_of_the_mesh(self):
        scene = self.load(self.make(diffuseColor=("rgb", "second"), displacement=("r", "third")))
        self.expect_sets(scene.meshes["m"], THIRD, SECOND)
        self.assertEqual(scene.materials["look"]["base_color"]["uv_set"], 1)
        os.remove(self.path)
        scene = self.load(self.make(diffuseColor=("rgb", "second"), normal=("rgb", "third")))
        self.expect_sets(scene.meshes["m"], THIRD, SECOND)
        self.assertNotIn("uv_set", scene.materials["look"]["geometry_normal"])
        os.remove(self.path)
        scene = self.load(self.make(normal=("rgb", "second"), displacement=("r", "third")))
        self.expect_sets(scene.meshes["m"], THIRD)
        self.assertTrue(self.reported("/look", "its normal map on uvs second is read on third"))

    def test_uvs_that_are_not_there_are_others(self):
        scene = self.load(self.make(diffuseColor=("rgb", "st"), roughness=("g", "none")))
        self.expect_sets(scene.meshes["m"], *[[(0, 0), (1, 0), (1, 1), (0, 1)]] * 2)
        self.assertTrue(self.reported("/m", "has no uvs none: st is used"))

    def test_pictures_do_not_depend_on_which_set_is_the_mesh_s_own(self):
        def render(stage):
            scene = self.load(stage)
            scene.camera = relief.Camera(from_=(0, 3, 0.5), to=(0, 0, 0))
            scene.environment = relief.Environment(color=(1, 1, 1))
            os.remove(self.path)
            return relief.render(scene, size=(32, 32), spp=1, bounces=1).array

        def exchange(stage):
            api = UsdGeom.PrimvarsAPI(stage.GetPrimAtPath("/m"))
            values = [api.GetPrimvar(name).Get() for name in ("second", "st")]
            for name, value in zip(("st", "second"), values):
                api.GetPrimvar(name).Set(value)
            return stage

        picture = render(self.make(diffuseColor=("rgb", "st"), roughness=("g", "second")))
        again = render(exchange(self.make(diffuseColor=("rgb", "second"), roughness=("g", "st"))))
        np.testing.assert_array_equal(picture, again)
        for outputs in ({"diffuseColor": ("rgb", "st"), "roughness": ("g", "st")},
                        {"diffuseColor": ("rgb", "second"), "roughness": ("g", "second")}):
            self.assertFalse(np.array_equal(picture, render(self.make(**outputs))))

    def test_parts_of_a_subdivided_mesh_keep_all_sets(self):
        stage = stages.create(self.path)
        points = [(0, 0, 0), (1, 0, 0), (1, 0, -1), (0, 0, -1), (2, 1, 0), (2, 1, -1)]
        plain = [(p[0], -p[2]) for p in points]
        mesh = stages.add_mesh(stage, "/m", points, [4, 4], [0, 1, 2, 3, 1, 4, 5, 2], "bilinear", uvs=plain)
        stages.add_uvs(mesh, [(v, u) for u, v in plain], "vertex", name="turned")
        stages.write_png(os.path.join(self.folder.name, "maps/a.png"), stages.make_picture())
        for k, names in enumerate((("st", "turned"), ("turned", "st"))):
            inputs = {key: (self.add_texture(stage, f"/look{k}/{key}", uvs), output)
                      for key, output, uvs in zip(("diffuseColor", "roughness"), ("rgb", "g"), names)}
            subset = UsdShade.MaterialBindingAPI(mesh).CreateMaterialBindSubset(f"part{k}", [k])
            stages.bind(subset, stages.add_material(stage, f"/look{k}", **inputs))
        scene = self.load(stage, subdivision_level=1)
        for entry in scene.objects:
            found = scene.meshes[entry["mesh"]]
            own, further = np.array(self.corners(found, None)), np.array(self.corners(found, 1))
            np.testing.assert_allclose(further, own[:, ::-1], atol=1e-6)
            places = found.positions[found.corners][:, [0, 2]] * [1, -1]
            first = scene.materials[entry["material"]]["base_color"].get("uv_set")
            self.assertIsNone(first)
            np.testing.assert_allclose(own if entry["material"] == "look0" else further, places, atol=1e-6)
        self.assertEqual(scene.validate(), [])

    def test_moving_points_stay_where_textures_lie_on_several_sets(self):
        stage = self.make(diffuseColor=("rgb", "st"), roughness=("g", "second"))
        points = UsdGeom.Mesh(stage.GetPrimAtPath("/m")).GetPointsAttr()
        for frame in (1, 2):
            points.Set(Vt.Vec3fArray([Gf.Vec3f(x, y + frame, z) for x, y, z in stages.SQUARE]), frame)
        scene = self.load(stage, frames="1-2", folder=os.path.join(self.folder.name, "made"))
        self.assertTrue(self.reported("/m", "files a frame hold one uv set"))
        self.assertIsInstance(scene.meshes["m"], relief.Mesh)


if __name__ == "__main__":
    unittest.main()
