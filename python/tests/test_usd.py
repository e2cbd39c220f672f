"""relief.usd: one file of USD for each feature, made here, and what becomes of it in the scene."""
import math
import os
import pathlib
import tempfile
import unittest

import numpy as np

import relief
import relief.usd
import usd_stages as stages

try:
    from pxr import Gf, Sdf, Usd, UsdGeom, UsdLux
except ImportError:
    Usd = None


@unittest.skipIf(Usd is None, "usd-core is not installed: pip install relief[usd]")
class UsdTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.path = os.path.join(self.folder.name, "shot.usda")
        self.report = []

    def load(self, stage=None, **options):
        if stage is not None:
            stage.GetRootLayer().Save()
        self.report = []
        return relief.usd.load(self.path, report=self.report, **options)

    def find(self, scene, name):
        return next(entry for entry in scene.objects if entry["name"] == name)

    def matrix(self, entry):
        return np.array(entry.get("transform", {"matrix": np.eye(4)})["matrix"]).reshape(4, 4)

    def reported(self, path, text):
        return any(line.removeprefix("note: ").startswith(f"{path}: ") and text in line for line in self.report)


class Meshes(UsdTest):
    def test_left_handed_faces_turn_round_with_their_uvs(self):
        stage = stages.create(self.path)
        mesh = stages.add_square(stage, "/m")
        mesh.CreateOrientationAttr("leftHanded")
        found = self.load(stage).meshes["m"]
        self.assertEqual(found.corners.tolist(), [0, 3, 2, 1])
        self.assertEqual(found.uvs[found.uv_indices].tolist(), [[0, 0], [0, 1], [1, 1], [1, 0]])

    def test_uvs_of_every_interpolation_reach_the_corners(self):
        stage = stages.create(self.path)
        points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (2, 0, 0), (2, 1, 0)]
        corners = [0, 1, 2, 3, 1, 4, 5, 2]
        flat = [(k / 10, k / 20) for k in range(8)]
        cases = {"constant": (flat[:1], None, [0] * 8), "uniform": (flat[:2], None, [0] * 4 + [1] * 4),
                 "vertex": (flat[:6], None, corners), "varying": (flat[:6], None, corners), "faceVarying": (flat, None, list(range(8))),
                 "indexed": (flat[:2], [1, 0, 1, 0, 0, 1, 1, 1], [1, 0, 1, 0, 0, 1, 1, 1])}
        for name, (values, indices, _) in cases.items():
            mesh = stages.add_mesh(stage, f"/{name}", points, [4, 4], corners)
            stages.add_uvs(mesh, values, "faceVarying" if name == "indexed" else name, indices)
        scene = self.load(stage)
        for name, (values, _, expected) in cases.items():
            mesh = scene.meshes[name]
            np.testing.assert_array_equal(mesh.uvs[mesh.uv_indices], np.array(values, np.float32)[expected], err_msg=name)

    def test_holes_and_edges_are_no_faces(self):
        stage = stages.create(self.path)
        mesh = stages.add_mesh(stage, "/m", [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [3, 2, 3], [0, 1, 2, 0, 1, 0, 2, 3])
        mesh.CreateHoleIndicesAttr([0])
        found = self.load(stage).meshes["m"]
        self.assertEqual((found.sizes.tolist(), found.corners.tolist()), ([3], [0, 2, 3]))
        self.assertTrue(self.reported("/m", "1 faces of less than three corners"))

    def test_normals_of_a_primvar_win_over_the_attribute(self):
        stage = stages.create(self.path)
        mesh = stages.add_square(stage, "/m")
        mesh.CreateNormalsAttr([Gf.Vec3f(0, 0, 1)] * 4)
        primvar = UsdGeom.PrimvarsAPI(mesh).CreatePrimvar("normals", Sdf.ValueTypeNames.Normal3fArray, "vertex")
        primvar.Set([Gf.Vec3f(0, 1, 0)])
        primvar.SetIndices([0, 0, 0, 0])
        found = self.load(stage).meshes["m"]
        self.assertEqual(found.normals[found.normal_indices].tolist(), [[0, 1, 0]] * 4)

    def test_subdivision_creases_and_corners(self):
        stage = stages.create(self.path)
        mesh = stages.add_square(stage, "/m", "catmullClark")
        mesh.CreateCreaseIndicesAttr([0, 1, 2, 2, 3])
        mesh.CreateCreaseLengthsAttr([3, 2])
        mesh.CreateCreaseSharpnessesAttr([2.5, 20])
        mesh.CreateCornerIndicesAttr([1])
        mesh.CreateCornerSharpnessesAttr([3])
        mesh.CreateInterpolateBoundaryAttr("edgeOnly")
        mesh.CreateFaceVaryingLinearInterpolationAttr("all")
        found = self.load(stage, subdivision_level=4).meshes["m"]
        self.assertEqual(found.subdivision, {"scheme": "catmark", "level": 4, "uv": "linear", "boundary": "edge-only", "creases": True})
        self.assertEqual(found.creases.tolist(), [[0, 1], [1, 2], [2, 3], [1, 1]])
        self.assertEqual(found.sharpness.tolist(), [2.5, 2.5, 10, 3])

    def test_a_sharpness_for_each_edge_of_a_crease(self):
        stage = stages.create(self.path)
        mesh = stages.add_square(stage, "/m", "bilinear")
        mesh.CreateCreaseIndicesAttr([0, 1, 2])
        mesh.CreateCreaseLengthsAttr([3])
        mesh.CreateCreaseSharpnessesAttr([1, 2])
        found = self.load(stage).meshes["m"]
        self.assertEqual(found.subdivision["scheme"], "bilinear")
        self.assertEqual(found.sharpness.tolist(), [1, 2])

    def test_indices_out_of_range_are_an_error_with_the_prim(self):
        stage = stages.create(self.path)
        stages.add_mesh(stage, "/a/m", [(0, 0, 0)] * 3, [3], [0, 1, 7])
        with self.assertRaises(relief.Error) as caught:
            self.load(stage)
        self.assertIn("/a/m", caught.exception.where)
        self.assertIn("shot.usda", caught.exception.where)
        self.assertIn("0 to 7", caught.exception.message)

    def test_shapes_become_closed_meshes(self):
        stage = stages.create(self.path)
        for kind in ("Cube", "Sphere", "Cylinder", "Cone", "Capsule"):
            stage.DefinePrim(f"/{kind}", kind)
        expected = {"Cube": 8, "Sphere": 4 / 3 * math.pi, "Cylinder": 2 * math.pi, "Cone": 2 / 3 * math.pi,
                    "Capsule": math.pi / 4 + math.pi / 6}
        scene = self.load(stage)
        for kind, volume in expected.items():
            mesh = scene.meshes[kind]
            quads = mesh.positions[mesh.corners.reshape(-1, 4)].astype(float)
            a, b, c, d = (quads[:, k] for k in range(4))
            found = (np.einsum("ij,ij->i", a, np.cross(b, c)) + np.einsum("ij,ij->i", a, np.cross(c, d))).sum() / 6
            self.assertAlmostEqual(found / volume, 1, delta=0.004, msg=kind)  # turned outwards, and round enough


class Places(UsdTest):
    def test_z_up_stages_are_turned_and_meters_asked_for(self):
        stage = stages.create(self.path, "Z", 0.01)
        stages.add_square(stage, "/m").AddTranslateOp().Set(Gf.Vec3d(1, 2, 3))
        np.testing.assert_allclose(self.matrix(self.load(stage).objects[0])[:3, 3], [1, 3, -2])
        np.testing.assert_allclose(self.matrix(self.load(meters=True).objects[0])[:3, 3], [0.01, 0.03, -0.02])
        np.testing.assert_allclose(self.matrix(self.load(meters=True).objects[0])[:3, :3] @ [0, 0, 1], [0, 0.01, 0])

    def test_time_samples_are_read_at_the_time_and_at_the_first_frame(self):
        stage = stages.create(self.path)
        op = stages.add_square(stage, "/m").AddTranslateOp()
        op.Set(Gf.Vec3d(0, 0, 0), 1)
        op.Set(Gf.Vec3d(10, 0, 0), 11)
        self.assertEqual(self.matrix(self.load(stage).objects[0])[0, 3], 0)
        self.assertEqual(self.matrix(self.load(time=6).objects[0])[0, 3], 5)
        stage.SetStartTimeCode(3)
        stage.SetEndTimeCode(11)
        self.assertEqual(self.matrix(self.load(stage).objects[0])[0, 3], 2)

    def test_visibility_and_purpose_decide_what_is_seen(self):
        stage = stages.create(self.path)
        for name in ("hidden", "proxy", "guide", "render", "plain"):
            stages.add_square(stage, f"/{name}/m")
        UsdGeom.Xform.Define(stage, "/hidden").CreateVisibilityAttr("invisible")
        for name in ("proxy", "guide", "render"):
            xform = UsdGeom.Xform.Define(stage, f"/{name}")
            xform.CreatePurposeAttr(name)
        self.assertEqual({o["name"] for o in self.load(stage).objects}, {"/render/m", "/plain/m"})
        self.assertEqual({o["name"] for o in self.load(purposes=("default", "proxy")).objects}, {"/proxy/m", "/plain/m"})

    def test_reset_stacks_leave_the_transforms_above_out(self):
        stage = stages.create(self.path)
        UsdGeom.Xform.Define(stage, "/a").AddTranslateOp().Set(Gf.Vec3d(5, 0, 0))
        mesh = stages.add_square(stage, "/a/m")
        mesh.AddTranslateOp().Set(Gf.Vec3d(0, 1, 0))
        mesh.SetResetXformStack(True)
        np.testing.assert_allclose(self.matrix(self.load(stage).objects[0])[:3, 3], [0, 1, 0])

    def test_instances_share_one_mesh(self):
        stage = stages.create(self.path)
        stage.CreateClassPrim("/_tree")
        stages.add_square(stage, "/_tree/m")
        for k in range(3):
            xform = UsdGeom.Xform.Define(stage, f"/tree{k}")
            xform.GetPrim().GetReferences().AddInternalReference("/_tree")
            xform.GetPrim().SetInstanceable(True)
            xform.AddTranslateOp().Set(Gf.Vec3d(k, 0, 0))
        scene = self.load(stage)
        self.assertEqual((len(scene.meshes), len(scene.objects)), (1, 3))
        self.assertEqual([self.matrix(o)[0, 3] for o in scene.objects], [0, 1, 2])

    def add_instancer(self, stage, count):
        instancer = UsdGeom.PointInstancer.Define(stage, "/points")
        UsdGeom.Xform.Define(stage, "/points/leaf").AddTranslateOp().Set(Gf.Vec3d(0, 0.5, 0))
        stages.add_square(stage, "/points/leaf/m")
        stages.add_mesh(stage, "/points/stick", [(0, 0, 0), (1, 0, 0), (0, 1, 0)], [3], [0, 1, 2])
        instancer.CreatePrototypesRel().SetTargets(["/points/leaf", "/points/stick"])
        instancer.CreatePositionsAttr([Gf.Vec3f(k, 0, 0) for k in range(count)])
        return instancer

    def test_point_instancers_scale_turn_move_and_leave_out(self):
        stage = stages.create(self.path)
        instancer = self.add_instancer(stage, 4)
        instancer.CreateProtoIndicesAttr([0, 1, 0, 0])
        half = math.sqrt(0.5)
        instancer.CreateOrientationsAttr([Gf.Quath(1, 0, 0, 0)] * 2 + [Gf.Quath(half, 0, 0, half), Gf.Quath(1, 0, 0, 0)])
        instancer.CreateScalesAttr([Gf.Vec3f(1, 1, 1), Gf.Vec3f(2, 2, 2), Gf.Vec3f(1, 3, 1), Gf.Vec3f(1, 1, 1)])
        instancer.CreateInvisibleIdsAttr([3])
        scene = self.load(stage)
        self.assertEqual(len(scene.objects), 3)
        sticks = [o for o in scene.objects if "stick" in o["name"]]
        np.testing.assert_allclose(self.matrix(sticks[0]), np.array([[2, 0, 0, 1], [0, 2, 0, 0], [0, 0, 2, 0], [0, 0, 0, 1.0]]))
        turned = self.matrix([o for o in scene.objects if "leaf" in o["name"]][1])
        # The prototype stands half a unit up, is stretched threefold along y, and y is turned onto -x.
        np.testing.assert_allclose(turned @ [0, 0, 0, 1], [2 - 1.5, 0, 0, 1], atol=2e-3)

    def test_many_points_become_one_file(self):
        stage = stages.create(self.path)
        instancer = self.add_instancer(stage, 300)
        instancer.CreateProtoIndicesAttr([0] * 300)
        instancer.CreateOrientationsAttr([Gf.Quath(0.5, 0.5, 0.5, 0.5)] * 300)
        instancer.CreateScalesAttr([Gf.Vec3f(1, 1, 2)] * 300)
        scene = self.load(stage)
        self.assertEqual(len(scene.objects), 1)
        data = pathlib.Path(scene.objects[0]["instances"]["file"]).read_bytes()
        rows = np.frombuffer(data[data.index(b"end_header\n") + 11:], "<f4").reshape(300, 10)
        # x, y, z turn in a circle: half a unit up, along y, becomes half a unit along z.
        np.testing.assert_allclose(rows[7], [7, 0, 0.5, 0.5, 0.5, 0.5, 0.5, 1, 1, 2], atol=1e-3)

    def test_variants_and_payloads_are_taken_as_composed(self):
        other = Usd.Stage.CreateNew(os.path.join(self.folder.name, "heavy.usda"))
        stages.add_square(other, "/heavy/m")
        other.SetDefaultPrim(other.GetPrimAtPath("/heavy"))
        other.GetRootLayer().Save()
        stage = stages.create(self.path)
        prim = stage.DefinePrim("/a", "Xform")
        prim.GetPayloads().AddPayload("./heavy.usda")
        variants = prim.GetVariantSets().AddVariantSet("height")
        for name, height in (("low", 1), ("high", 9)):
            variants.AddVariant(name)
            variants.SetVariantSelection(name)
            with variants.GetVariantEditContext():
                UsdGeom.XformCommonAPI(prim).SetTranslate((0, height, 0))
        self.assertEqual(self.matrix(self.load(stage).objects[0])[1, 3], 9)
        variants.SetVariantSelection("low")
        self.assertEqual(self.matrix(self.load(stage).objects[0])[1, 3], 1)
        self.assertEqual(self.load().objects[0]["name"], "/a/m")

    def test_what_is_not_a_stage_is_an_error(self):
        broken = '#usda 1.0\ndef Xform "a"\n{\n    double x = \n}\n'
        for text, name, words in (("no stage", "bad.usda", "is not a USD file"), (None, "missing.usda", "no such file"),
                                  (broken, "broken.usda", "line 4, column .*double x")):
            path = os.path.join(self.folder.name, name)
            if text:
                pathlib.Path(path).write_text(text)
            with self.assertRaises(relief.Error) as caught:
                relief.usd.load(path)
            self.assertEqual(caught.exception.where, path)
            self.assertRegex(caught.exception.message, words)
            self.assertTrue(caught.exception.hint)
        empty = stages.create(self.path)
        with self.assertRaisesRegex(relief.Error, "no mesh"):
            self.load(empty)

    def test_what_is_left_out_is_named_once_a_prim(self):
        stage = stages.create(self.path)
        stages.add_square(stage, "/m")
        UsdGeom.BasisCurves.Define(stage, "/hair")
        UsdLux.CylinderLight.Define(stage, "/tube")
        self.load(stage)
        self.assertEqual([line for line in self.report if line.startswith("/hair")], ["/hair: BasisCurves is not taken over"])
        self.assertEqual([line for line in self.report if line.startswith("/tube")], ["/tube: CylinderLight is not taken over"])


if __name__ == "__main__":
    unittest.main()
