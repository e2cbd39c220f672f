"""relief.usd over a range of frames: keys against the stage itself, evaluated at frames and between them."""
import contextlib
import io
import json
import os
import tempfile
import unittest

import numpy as np

import relief
import relief.usd
import usd_stages as stages

try:
    from pxr import Gf, Usd, UsdGeom, UsdLux, UsdShade, UsdSkel, Vt
except ImportError:
    Usd = None

FRAMES = range(1, 9)
TIMES = [*FRAMES, *(frame + 0.5 for frame in range(1, 8))]


def blend(keyed, time, rotates=False):
    """As docs/shots.md says it, for numbers and lists of them."""
    if not isinstance(keyed, dict):
        return np.array(keyed, float)
    frames = [frame for frame, _ in keyed["keys"]]
    values = np.array([value for _, value in keyed["keys"]], float)
    index = int(np.clip(np.searchsorted(frames, time, "right") - 1, 0, len(frames) - 1))
    if time <= frames[0] or time >= frames[-1]:
        return values[0 if time < frames[0] else index]
    part = (time - frames[index]) / (frames[index + 1] - frames[index])
    if rotates and (np.ptp(values, axis=0) > 0).sum() > 1:
        a, b = (turn(value).GetQuat() for value in values[index:index + 2])
        return rotation_matrix(Gf.Rotation(Gf.Slerp(part, a, b)))
    found = values[index] * (1 - part) + values[index + 1] * part
    return rotation_matrix(turn(found)) if rotates else found


def turn(degrees):
    x, y, z = (Gf.Rotation(Gf.Vec3d(*axis), float(d)) for axis, d in zip(np.eye(3).tolist(), degrees))
    return x * y * z


def rotation_matrix(rotation):
    return np.array(Gf.Matrix3d(rotation)).T


def compose(transform, time):
    matrix = np.eye(4)
    rotation = transform.get("rotate_degrees", [0, 0, 0])
    linear = blend(rotation, time, rotates=True)
    if linear.ndim == 1:
        linear = rotation_matrix(turn(linear))
    matrix[:3, :3] = linear * blend(transform.get("scale", [1, 1, 1]), time)
    matrix[:3, 3] = blend(transform.get("translate", [0, 0, 0]), time)
    return matrix


@unittest.skipIf(Usd is None, "usd-core is not installed: pip install relief[usd]")
class MotionTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder, self.path = folder.name, os.path.join(folder.name, "shot.usda")
        self.stage = stages.create(self.path)
        self.stage.SetStartTimeCode(1)
        self.stage.SetEndTimeCode(8)
        UsdGeom.Camera.Define(self.stage, "/camera").AddTranslateOp().Set(Gf.Vec3d(0, 1, 12))
        self.report = []

    def load(self, frames="all", **options):
        self.stage.GetRootLayer().Save()
        self.report = []
        return relief.usd.load(self.path, report=self.report, frames=frames, **options)

    def reported(self, path, text):
        return any(line.startswith(f"{path}: ") and text in line for line in self.report)

    def check_transforms(self, *paths, accuracy=1e-3, times=TIMES, **options):
        """Returns the transforms of the scene with keys."""
        found = {entry["name"]: entry["transform"] for entry in self.load(**options).objects if "transform" in entry}
        for time in times:
            still = {entry["name"]: entry.get("transform", {"matrix": np.eye(4)})["matrix"]
                     for entry in self.load(None, time=time, **options).objects}
            for path in paths:
                np.testing.assert_allclose(compose(found[path], time), np.reshape(still[path], (4, 4)), atol=accuracy,
                                           err_msg=f"{path} at {time}")
        return [found[path] for path in paths]


def set_samples(attribute, samples):
    for time, value in samples.items():
        attribute.Set(value, time)


class Objects(MotionTest):
    def test_what_moves_straight_has_a_key_a_sample(self):
        mesh = stages.add_square(self.stage, "/m")
        set_samples(mesh.AddTranslateOp(), {1: Gf.Vec3d(0, 1, 0), 4: Gf.Vec3d(3, 1, 0), 8: Gf.Vec3d(3, 1, 5)})
        scene = self.load()
        self.assertEqual(scene.objects[0]["transform"], {"translate": {"keys": [[1, [0, 1, 0]], [4, [3, 1, 0]], [8, [3, 1, 5]]]}})
        self.assertEqual((scene.render["frames"], scene.render["fps"]), ("1-8", 24))
        self.assertNotIn("keys", json.dumps(self.load(None).objects))

    def test_what_turns_and_circles_is_as_in_the_stage(self):
        arm = UsdGeom.Xform.Define(self.stage, "/arm")
        set_samples(arm.AddRotateYOp(), {1: 0.0, 8: 800.0})
        mesh = stages.add_square(self.stage, "/arm/m")
        mesh.AddTranslateOp().Set(Gf.Vec3d(2, 0, 0))
        set_samples(mesh.AddRotateXYZOp(), {1: Gf.Vec3f(0, 0, 0), 8: Gf.Vec3f(90, 150, -60)})
        set_samples(mesh.AddScaleOp(), {1: Gf.Vec3f(1, 1, 1), 6: Gf.Vec3f(2, 0.5, 1)})
        self.check_transforms("/arm/m", accuracy=2e-3)
        self.assertFalse(any(line.startswith("/arm") for line in self.report))

    def test_full_turns_about_each_axis(self):
        for axis in "XYZ":
            mesh = stages.add_square(self.stage, f"/m{axis}")
            set_samples(getattr(mesh, f"AddRotate{axis}Op")(), {1: -90.0, 8: 1350.0})
        found = self.check_transforms("/mX", "/mY", "/mZ")
        for axis, transform in zip("XYZ", found):
            keys = transform["rotate_degrees"]["keys"]
            self.assertAlmostEqual(abs(np.subtract(keys[-1][1], keys[0][1])).max(), 1440, msg=axis)

    def test_z_up_and_meters(self):
        UsdGeom.SetStageUpAxis(self.stage, "Z")
        UsdGeom.SetStageMetersPerUnit(self.stage, 0.01)
        mesh = stages.add_square(self.stage, "/m")
        set_samples(mesh.AddTranslateOp(), {1: Gf.Vec3d(0, 100, 0), 8: Gf.Vec3d(300, 100, 50)})
        set_samples(mesh.AddRotateZOp(), {1: 0.0, 8: 90.0})
        self.check_transforms("/m", meters=True)

    def test_matrices_shrink_between_their_samples_as_in_the_stage(self):
        mesh = stages.add_square(self.stage, "/m")
        turned = Gf.Matrix4d().SetRotate(Gf.Rotation(Gf.Vec3d(0, 0, 1), 120))
        set_samples(mesh.AddTransformOp(), {1: Gf.Matrix4d(1), 8: turned.SetTranslateOnly(Gf.Vec3d(1, 2, 3))})
        self.assertIn("keys", self.check_transforms("/m")[0]["scale"])
        self.assertFalse(self.reported("/m", "sheared"))

    def test_what_is_mirrored_and_what_grows_out_of_nothing(self):
        mesh = stages.add_square(self.stage, "/m")
        set_samples(mesh.AddRotateYOp(), {1: 0.0, 8: 90.0})
        set_samples(mesh.AddScaleOp(), {1: Gf.Vec3f(0, 0, 0), 8: Gf.Vec3f(-1, 2, 1)})
        stages.add_square(self.stage, "/still")
        self.check_transforms("/m", accuracy=2e-3, times=TIMES[1:])  # at frame 1 there is none

    def test_shear_is_reported(self):
        xform = UsdGeom.Xform.Define(self.stage, "/a")
        xform.AddScaleOp().Set(Gf.Vec3f(1, 2, 1))
        set_samples(stages.add_square(self.stage, "/a/m").AddRotateZOp(), {1: 0.0, 8: 60.0})
        scene = self.load()
        self.assertIn("keys", scene.objects[0]["transform"]["rotate_degrees"])
        self.assertTrue(self.reported("/a/m", "is sheared on its way"))

    def test_instancers_are_moved_as_a_whole(self):
        for count in (3, 300):
            path = f"/points{count}"
            instancer = UsdGeom.PointInstancer.Define(self.stage, path)
            stages.add_square(self.stage, f"{path}/m")
            instancer.CreatePrototypesRel().SetTargets([f"{path}/m"])
            instancer.CreatePositionsAttr([Gf.Vec3f(k, 0, 0) for k in range(count)])
            instancer.CreateProtoIndicesAttr([0] * count)
            set_samples(instancer.AddRotateYOp(), {1: 0.0, 8: 90.0})
        self.check_transforms("/points3/points3/m[2]", accuracy=2e-3)
        many = next(entry for entry in self.load().objects if "instances" in entry)
        np.testing.assert_allclose(compose(many["transform"], 8)[:3, 0], [0, 0, -1], atol=1e-6)
        set_samples(instancer.GetPositionsAttr(), {t: [Gf.Vec3f(k, t, 0) for k in range(300)] for t in (1, 8)})
        self.load()
        self.assertTrue(self.reported("/points300", "positions changes with time: taken as of frame 1"))


class Ranges(MotionTest):
    def test_a_range_clips_keys_and_a_wrong_one_is_an_error(self):
        set_samples(stages.add_square(self.stage, "/m").AddTranslateOp(), {1: Gf.Vec3d(0, 0, 0), 8: Gf.Vec3d(7, 0, 0)})
        scene = self.load("3-5x2")
        self.assertEqual(scene.render["frames"], "3-5x2")
        self.assertEqual(scene.objects[0]["transform"]["translate"]["keys"], [[3, [2, 0, 0]], [5, [4, 0, 0]]])
        self.assertEqual(self.load("5").objects[0]["transform"], {"translate": [4, 0, 0]})
        with self.assertRaises(relief.Error):
            self.load("five")
        self.stage.ClearMetadata("startTimeCode")
        self.stage.ClearMetadata("endTimeCode")
        with self.assertRaisesRegex(relief.Error, "names no range"):
            self.load("all")

    def test_what_cannot_change_is_reported(self):
        mesh = stages.add_square(self.stage, "/a/m")
        set_samples(mesh.CreateVisibilityAttr(), {1: "inherited", 4: "invisible"})
        hidden = stages.add_square(self.stage, "/hidden")
        set_samples(hidden.CreateVisibilityAttr(), {1: "invisible", 4: "inherited"})
        ball = UsdGeom.Sphere.Define(self.stage, "/ball")
        set_samples(ball.CreateRadiusAttr(), {1: 1.0, 8: 2.0})
        self.load()
        self.assertTrue(self.reported("/a/m", "visibility changes with time: taken as of frame 1"))
        self.assertTrue(self.reported("/hidden", "visibility changes with time: it is hidden"))
        self.assertTrue(self.reported("/ball", "radius changes with time: taken as of frame 1"))
        self.load(time=8)
        self.assertTrue(self.reported("/ball", "taken as of frame 8"))


class CamerasAndLights(MotionTest):
    def setUp(self):
        super().setUp()
        stages.add_square(self.stage, "/m")

    def check_part(self, find, names, accuracy):
        part = find(self.load())
        for time in TIMES:
            still = find(self.load(None, time=time))
            for name in names:
                np.testing.assert_allclose(blend(part[name], time), still.get(name, [0, 0]), atol=accuracy, err_msg=f"{name} at {time}")
                self.assertIn("keys", part[name], name)
        return part

    def test_cameras_move_turn_zoom_and_focus(self):
        camera = UsdGeom.Camera.Define(self.stage, "/camera")
        camera.ClearXformOpOrder()
        set_samples(camera.AddRotateYOp(), {1: 0.0, 8: 120.0})
        camera.AddTranslateOp(opSuffix="arm").Set(Gf.Vec3d(0, 1, 9))
        set_samples(camera.AddRotateXYZOp(opSuffix="look"), {1: Gf.Vec3f(0, 0, 0), 8: Gf.Vec3f(-20, 30, 45)})
        set_samples(camera.CreateFocalLengthAttr(), {1: 20.0, 8: 80.0})
        set_samples(camera.CreateFocusDistanceAttr(), {1: 9.0, 8: 5.0})
        set_samples(camera.CreateFStopAttr(), {1: 2.8, 8: 8.0})
        set_samples(camera.CreateVerticalApertureOffsetAttr(), {1: 0.0, 8: 3.0})
        names = ("from", "to", "up", "fov_degrees", "aperture_radius", "focus_distance", "shift")
        part = self.check_part(lambda scene: scene.camera, names, 1e-2)
        self.assertNotIn("shutter", part)
        self.assertFalse(any(line.startswith("/camera") for line in self.report))

    def test_shutters_and_the_keys_that_they_see(self):
        camera = UsdGeom.Camera.Define(self.stage, "/camera")
        set_samples(camera.GetOrderedXformOps()[0].GetAttr(), {0: Gf.Vec3d(0, 1, 9), 10: Gf.Vec3d(10, 1, 9)})
        camera.CreateShutterOpenAttr(-0.25)
        camera.CreateShutterCloseAttr(0.5)
        scene = self.load()
        self.assertEqual(scene.camera["shutter"], [-0.25, 0.5])
        self.assertEqual([key[0] for key in scene.camera["from"]["keys"]], [0.75, 8.5])
        self.assertNotIn("shutter", self.load(None).camera)
        motion = relief.render(scene, frame=2, spp=4, size=(64, 36), layers=["motion"])["motion.X"]
        self.assertLess(motion.min(), -1)  # the camera goes to the right
        camera.CreateShutterCloseAttr(-0.5)
        self.load()
        self.assertTrue(self.reported("/camera", "shutter:open -0.25 comes after"))

    def test_lights_change_and_move(self):
        light = UsdLux.RectLight.Define(self.stage, "/light")
        set_samples(light.CreateIntensityAttr(), {1: 1.0, 8: 5.0})
        set_samples(light.CreateExposureAttr(), {1: 0.0, 8: 3.0})
        set_samples(light.CreateColorAttr(), {1: Gf.Vec3f(1, 0, 0), 5: Gf.Vec3f(0, 1, 0.5)})
        set_samples(light.CreateWidthAttr(), {1: 1.0, 8: 2.0})
        set_samples(light.AddTranslateOp(), {1: Gf.Vec3d(0, 5, 0), 8: Gf.Vec3d(3, 5, 0)})
        set_samples(light.AddRotateXYZOp(), {1: Gf.Vec3f(-90, 0, 0), 8: Gf.Vec3f(-40, 50, 10)})
        names = ("strength", "color", "width", "position", "direction", "up")
        self.check_part(lambda scene: scene.lights[0], names, 2e-2)
        self.assertFalse(any(line.startswith("/light") for line in self.report))

    def test_domes_turn_and_fade(self):
        stages.write_png(os.path.join(self.folder, "sky.png"), stages.make_picture())
        dome = UsdLux.DomeLight.Define(self.stage, "/dome")
        dome.CreateTextureFileAttr("./sky.png")
        set_samples(dome.CreateIntensityAttr(), {1: 1.0, 8: 2.0})
        set_samples(dome.AddRotateYOp(), {1: 0.0, 8: 720.0})
        environment = self.load().environment
        for time in TIMES:
            still = self.load(None, time=time).environment
            off = blend(environment["rotate_degrees"], time) - still["rotate_degrees"]
            self.assertLess(abs((off + 180) % 360 - 180), 0.02)
            self.assertAlmostEqual(blend(environment["strength"], time), still["strength"], 3)


class Deforming(MotionTest):
    def add_wave(self, path="/m", scheme="none"):
        mesh = stages.add_square(self.stage, path, scheme)
        set_samples(mesh.GetPointsAttr(), {1: Vt.Vec3fArray([Gf.Vec3f(*p) for p in stages.SQUARE]),
                                           8: Vt.Vec3fArray([Gf.Vec3f(x, 7, z) for x, _, z in stages.SQUARE])})
        return mesh

    def test_points_go_into_a_file_a_frame(self):
        self.add_wave()
        scene = self.load(folder=os.path.join(self.folder, "out"))
        pattern = scene.meshes["m"]["file"]
        self.assertTrue(pattern.endswith("m.####.obj"))
        for frame in FRAMES:
            found = relief.Mesh.load(pattern.replace("####", f"{frame:04}"))
            np.testing.assert_allclose(found.positions, self.load(None, time=frame).meshes["m"].positions, atol=1e-6)
            self.assertEqual(len(found.uvs), 4)
        self.assertFalse(any(line.startswith("/m") for line in self.report))
        blended, still = (relief.render(given, frame=frame, spp=4, size=(32, 18)).color
                          for given, frame in ((scene, 2.5), (self.load(None, time=2.5), None)))
        np.testing.assert_allclose(blended, still, atol=1e-4)
        self.assertGreater(np.ptp(still), 0.1)

    def test_instances_share_the_files_of_a_mesh(self):
        self.stage.CreateClassPrim("/_fish")
        self.add_wave("/_fish/m")
        for k in range(2):
            xform = UsdGeom.Xform.Define(self.stage, f"/fish{k}")
            xform.GetPrim().GetReferences().AddInternalReference("/_fish")
            xform.GetPrim().SetInstanceable(True)
            set_samples(xform.AddTranslateOp(), {1: Gf.Vec3d(k, 0, 0), 8: Gf.Vec3d(k, 0, 7)})
        scene = self.load(folder=self.folder)
        self.assertEqual([entry["mesh"] for entry in scene.objects], ["m", "m"])
        self.assertEqual([compose(entry["transform"], 4)[:3, 3].tolist() for entry in scene.objects], [[0, 0, 3], [1, 0, 3]])
        self.assertFalse(any("change" in line for line in self.report))

    def test_without_a_folder_points_stay_and_it_is_said(self):
        self.add_wave()
        scene = self.load(time=8)
        self.assertEqual(scene.meshes["m"].positions[:, 1].tolist(), [7] * 4)
        self.assertTrue(self.reported("/m", "no folder for a file a frame: they stay as of frame 8"))

    def test_subdivision_stays_and_other_faces_are_told(self):
        self.add_wave(scheme="catmullClark").CreateCornerIndicesAttr([0])
        UsdGeom.Mesh(self.stage.GetPrimAtPath("/m")).CreateCornerSharpnessesAttr([10])
        other = self.add_wave("/other")
        set_samples(other.GetFaceVertexIndicesAttr(), {1: [0, 1, 2, 3], 8: [1, 2, 3, 0]})
        scene = self.load(folder=self.folder)
        self.assertEqual(scene.meshes["m"]["subdivision"]["scheme"], "catmark")
        self.assertEqual(relief.Mesh.load(scene.meshes["m"]["file"].replace("####", "0003")).creases.tolist(), [[0, 0]])
        self.assertIsInstance(scene.meshes["other"], relief.Mesh)
        self.assertTrue(self.reported("/other", "faces change with time"))

    def test_parts_of_one_material_each_have_files_of_their_own(self):
        mesh = stages.add_mesh(self.stage, "/m", [(x, 0, z) for z in (1, 0) for x in (-1, 0, 1)], [4, 4], [0, 1, 4, 3, 1, 2, 5, 4],
                               "catmullClark")
        points = mesh.GetPointsAttr().Get()
        set_samples(mesh.GetPointsAttr(), {1: points, 8: Vt.Vec3fArray([p + Gf.Vec3f(0, 7, 0) for p in points])})
        for k in range(2):
            subset = UsdGeom.Subset.Define(self.stage, f"/m/part{k}")
            subset.CreateIndicesAttr([k])
            subset.CreateFamilyNameAttr("materialBind")
            material = UsdShade.Material.Define(self.stage, f"/material{k}")
            UsdShade.MaterialBindingAPI.Apply(subset.GetPrim()).Bind(material)
        scene = self.load(folder=self.folder)
        for name in ("part0", "part1"):
            found = relief.Mesh.load(scene.meshes[name]["file"].replace("####", "0003"))
            expected = self.load(None, time=3).meshes[name]
            np.testing.assert_allclose(found.positions, expected.positions, atol=1e-6)
            np.testing.assert_allclose(found.normals[found.normal_indices], expected.normals[expected.normal_indices], atol=1e-6)

    def test_samples_between_frames_are_told(self):
        mesh = self.add_wave()
        mesh.GetPointsAttr().Set(mesh.GetPointsAttr().Get(1), 3.25)
        self.load(folder=self.folder)
        self.assertTrue(self.reported("/m", "samples between frames"))

    def test_the_command_writes_keys_and_numbered_files(self):
        set_samples(self.add_wave().AddTranslateOp(), {1: Gf.Vec3d(0, 0, 0), 8: Gf.Vec3d(7, 0, 0)})
        camera = UsdGeom.Camera.Define(self.stage, "/camera")
        set_samples(camera.GetOrderedXformOps()[0].GetAttr(), {1: Gf.Vec3d(0, 0, 9), 8: Gf.Vec3d(7, 0, 9)})
        camera.CreateShutterCloseAttr(0.5)
        light = UsdLux.SphereLight.Define(self.stage, "/light")
        set_samples(light.CreateIntensityAttr(), {1: 1.0, 8: 5.0})
        self.stage.GetRootLayer().Save()
        name = os.path.join(self.folder, "out", "shot.json")
        with contextlib.redirect_stdout(io.StringIO()):
            self.assertEqual(relief.usd.main([self.path, "-o", name, "--frames", "2-4", "-q"]), 0)
        scene = relief.Scene.load(name)
        self.assertEqual(sorted(os.listdir(os.path.join(self.folder, "out", "meshes"))),
                         [f"m.{frame:04}.obj" for frame in (2, 3, 4, 5)])
        self.assertEqual(scene.meshes["m"]["file"], "meshes/m.####.obj")
        self.assertEqual((scene.camera["shutter"], scene.render["frames"]), ([0, 0.5], "2-4"))
        for keyed in (scene.camera["from"], scene.objects[0]["transform"]["translate"], scene.lights[0]["strength"]):
            self.assertEqual([key[0] for key in keyed["keys"]], [2, 4.5])
        self.assertTrue(relief.render(name, frame=3, spp=2, size=(16, 9)).complete)


class Skinning(MotionTest):
    def test_skinned_points_follow_the_animation(self):
        root = UsdSkel.Root.Define(self.stage, "/r")
        skeleton = UsdSkel.Skeleton.Define(self.stage, "/r/s")
        skeleton.CreateJointsAttr(["a"])
        skeleton.CreateBindTransformsAttr([Gf.Matrix4d(1)])
        skeleton.CreateRestTransformsAttr([Gf.Matrix4d(1)])
        animation = UsdSkel.Animation.Define(self.stage, "/r/anim")
        animation.CreateJointsAttr(["a"])
        set_samples(animation.CreateTranslationsAttr(), {1: [Gf.Vec3f(0, 0, 0)], 8: [Gf.Vec3f(0, 7, 0)]})
        animation.CreateRotationsAttr([Gf.Quatf(1)])
        animation.CreateScalesAttr([Gf.Vec3h(1)])
        mesh = stages.add_square(self.stage, "/r/m")
        binding = UsdSkel.BindingAPI.Apply(mesh.GetPrim())
        binding.CreateSkeletonRel().SetTargets(["/r/s"])
        binding.CreateJointIndicesPrimvar(False, 1).Set([0] * 4)
        binding.CreateJointWeightsPrimvar(False, 1).Set([1.0] * 4)
        UsdSkel.BindingAPI.Apply(skeleton.GetPrim()).CreateAnimationSourceRel().SetTargets(["/r/anim"])
        self.assertTrue(root)
        scene = self.load(folder=self.folder)
        for frame in FRAMES:
            found = relief.Mesh.load(scene.meshes["m"]["file"].replace("####", f"{frame:04}"))
            np.testing.assert_allclose(found.positions[:, 1], frame - 1, atol=1e-5)
        self.load()
        self.assertTrue(self.reported("/r/m", "no folder"))


if __name__ == "__main__":
    unittest.main()
