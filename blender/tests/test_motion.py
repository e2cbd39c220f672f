"""Motion blur: the same pictures as by Cycles, and what Cycles does not blur as the mean of stills."""
import pathlib
import unittest

import bpy
import numpy as np
from support import (BlenderTest, Layers, add_light, aim, displace, find_curves, main, make_grid, make_hook, make_image, make_material,
                     make_object, set_world, subdivide)
from test_geometry import CUBE, CUBE_FACES

from relief_blender import motion_export, panels, poses

SAMPLES = 64
# All pixels of Relief see the same 64 times, multiples of the golden ratio: an interval has at most 2/64 too many or too few.
ALPHA_OF_A_PIXEL = 0.05


def animate(owner, path, *values, frames=(0, 2)):
    """Keys at two or more frames, lines through them: few steps are all of the motion."""
    for frame, value in zip(frames, values):
        setattr(owner, path, value)
        owner.keyframe_insert(path, frame=frame)
    for curve in find_curves(owner):
        curve.extrapolation = "LINEAR"
        for point in curve.keyframe_points:
            point.interpolation = "LINEAR"


def emit(ob, strength=1.0):
    material = make_material(ob, Base_Color=(0, 0, 0), Emission_Color=(1, 0.5, 0.25), Specular_IOR_Level=0.0)
    material.node_tree.nodes["Principled BSDF"].inputs["Emission Strength"].default_value = strength
    return material


def make_box(size=(1.2, 0.4, 0.3)):
    return make_object(np.array(CUBE) * size, CUBE_FACES, smooth=False)


class Motion(BlenderTest):
    def setUp(self):
        super().setUp()
        scene = bpy.context.scene
        scene.render.resolution_x, scene.render.resolution_y = 120, 90
        scene.render.use_motion_blur, scene.render.motion_blur_shutter = True, 1.0
        scene.frame_set(1)
        bpy.context.view_layer.use_pass_z = bpy.context.view_layer.use_pass_position = False

    def render_still(self, at, name="still", samples=16):
        """Without motion blur, at a time between two frames."""
        scene = bpy.context.scene
        frame = scene.frame_current
        scene.render.use_motion_blur = False
        scene.frame_set(int(np.floor(at)), subframe=at - np.floor(at))
        try:
            return self.render("RELIEF", name, samples)["Combined"]
        finally:
            scene.frame_set(frame)
            scene.render.use_motion_blur = True

    def average(self, times, samples=4):
        return np.mean([self.render_still(at, samples=samples) for at in times], 0)

    def check_alike(self, ours, theirs, name, mean=0.01, pixel=ALPHA_OF_A_PIXEL, least=0.05):
        """Two blurred pictures: in the region where alpha is between 0 and 1 the means and the pixels agree.

        `mean`: what a thing covers does not depend on the time, so that the mean has the noise of thousands of rays alone."""
        region = ((ours[..., 3] > 0.02) & (ours[..., 3] < 0.98)) | ((theirs[..., 3] > 0.02) & (theirs[..., 3] < 0.98))
        self.assertGreater(region.mean(), least, "hardly anything is blurred")
        means = [picture[region].mean(0) for picture in (ours, theirs)]
        error = np.abs(ours - theirs)[..., 3][region]
        print(f"{self.id().split('.')[-1]} {name}: blurred {100 * region.mean():.1f} %, means {np.round(means[0], 4)} "
              f"{np.round(means[1], 4)}, alpha of a pixel {error.mean():.4f}", flush=True)
        self.assertLess(np.abs(means[0] - means[1]).max(), mean * max(1, means[1].max()))
        self.assertLess(error.mean(), pixel)

    def compare_blur(self, name="picture", **bounds):
        """By Relief and by Cycles."""
        ours, theirs = (self.render(engine, name, SAMPLES)["Combined"] for engine in ("RELIEF", "CYCLES"))
        self.check_alike(ours, theirs, name, **bounds)
        return ours, theirs


class Bodies(Motion):
    """Beside Cycles."""

    def test_a_rotating_body(self):
        ob = make_box()
        emit(ob)
        animate(ob, "rotation_euler", (0.3, -0.8, 0.2), (0.3, 0.8, 1.4))
        ob.cycles.motion_steps = 3
        self.compare_blur()

    def test_a_translating_body(self):
        ob = make_box((0.4, 0.4, 0.4))
        emit(ob)
        animate(ob, "location", (-1.5, 0, 0), (1.5, 0, 0.4))
        self.compare_blur()

    def test_a_body_in_the_light_of_a_sun_and_the_world(self):
        ob = make_box((0.7, 0.5, 0.4))
        make_material(ob, Base_Color=(0.8, 0.4, 0.2), Roughness=1.0, Specular_IOR_Level=0.0)
        set_world(bpy.context.scene.world, (0.3, 0.4, 0.5))
        add_light("SUN", (1, -2, 3), energy=2.0)
        animate(ob, "rotation_euler", (0, 0, -0.5), (0.4, 0.2, 1.0))
        animate(ob, "location", (-0.5, 0, 0), (0.5, 0, 0.3))
        ob.cycles.motion_steps = 2
        self.compare_blur()

    def test_steps_of_an_object_are_those_of_cycles(self):
        ob = make_box((0.3, 0.3, 0.3))
        emit(ob)
        pictures = []
        animate(ob, "location", (-1.5, 0, 0), (0, 0, 1), (0.5, 0, -1), (1.5, 0, 0), frames=(0, 1, 1.25, 2))
        for steps in (1, 3):
            ob.cycles.motion_steps = steps
            pictures.append(self.compare_blur(f"steps {steps}")[0])
        self.assertGreater(np.abs(pictures[0] - pictures[1]).mean(), 0.005)

    def test_instances_mirrored_and_scaled(self):
        ob = make_box((0.5, 0.3, 0.2))
        emit(ob)
        collection = bpy.data.collections.new("many")
        bpy.context.scene.collection.objects.unlink(ob)
        collection.objects.link(ob)
        for x in (-1.2, 1.2):
            empty = bpy.data.objects.new("empty", None)
            empty.instance_type, empty.instance_collection = "COLLECTION", collection
            bpy.context.scene.collection.objects.link(empty)
            animate(empty, "location", (x, 0, -0.5), (x, 0, 0.5))
            animate(empty, "scale", (np.sign(x), 1, 1), (1.6 * np.sign(x), 1.2, 1))
        self.compare_blur()

    def test_a_sheared_body(self):
        parent = bpy.data.objects.new("parent", None)
        bpy.context.scene.collection.objects.link(parent)
        parent.scale = (1, 1, 2)
        ob = make_box((0.6, 0.3, 0.3))
        emit(ob)
        ob.parent = parent
        ob.rotation_euler = (0, 0.7, 0)
        animate(parent, "location", (-0.8, 0, 0), (0.8, 0, 0))
        self.compare_blur()
        self.assertIn("shears", " ".join(self.report()))

    def test_a_fast_turn(self):
        """Half a turn in two steps, and one and a quarter in 128."""
        ob = make_box()
        emit(ob)
        for steps, angle in ((1, 3.0), (7, 8.0)):
            animate(ob, "rotation_euler", (0, -angle, 0), (0, angle, 0))
            ob.cycles.motion_steps = steps
            self.compare_blur(f"{2 ** steps} steps")

    def test_a_noise_threshold(self):
        ob = make_box((0.4, 0.4, 0.4))
        emit(ob)
        animate(ob, "location", (-1.5, 0, 0), (1.5, 0, 0.4))
        bpy.context.scene.relief.noise = 0.02
        self.compare_blur(pixel=0.08)

    def test_an_object_that_comes_or_goes_is_told(self):
        for frame, name in ((1, "comes"), (2, "goes")):
            ob = make_box()
            ob.name = name
            animate(ob, "hide_render", frame == 1, frame == 2, frames=(1, 1.25))
        self.render("RELIEF", samples=1)
        lines = [line for line in self.report() if "comes or goes while" in line]
        self.assertEqual([line.split('"')[1] for line in lines], ["comes", "goes"])

    def test_an_object_that_is_not_to_be_blurred(self):
        ob = make_box()
        emit(ob)
        animate(ob, "location", (-1, 0, 0), (1, 0, 0))
        ob.cycles.use_motion_blur = False
        blurred = self.render("RELIEF", "blurred")["Combined"]
        self.assertTrue(np.array_equal(blurred, self.render_still(1)))


class Deformation(Motion):
    def make_bending(self):
        """A strip with a shape key that moves its end."""
        ob = make_grid(8, lambda u, v: (3 * u - 1.5, 0.3 * (2 * v - 1), 0 * u))
        emit(ob)
        ob.shape_key_add(name="basis")
        key = ob.shape_key_add(name="bent")
        for point in key.data:
            point.co.z += 0.5 * (point.co.x + 1.5)
        animate(key, "value", 0.0, 1.0)
        aim(self.camera, (0, -6, 1), (0, 0, 0.4))
        return ob

    def test_shape_keys(self):
        ob = self.make_bending()
        ours, _ = self.compare_blur()
        ob.cycles.use_deform_motion = False
        still = self.render("RELIEF", "still", SAMPLES)["Combined"]
        self.assertGreater(np.abs(ours - still).mean(), 0.01)
        self.assertTrue(np.array_equal(still, self.render_still(1, samples=SAMPLES)))

    def test_a_subdivision_surface_that_moves_as_a_whole_too(self):
        ob = self.make_bending()
        subdivide(ob, "CATMULL_CLARK", 2)
        animate(ob, "location", (-0.3, 0, 0), (0.3, 0, 0.2))
        self.compare_blur()

    def test_an_armature(self):
        ob = make_grid(8, lambda u, v: (3 * u - 1.5, 0.3 * (2 * v - 1), 0 * u))
        emit(ob)
        bpy.ops.object.armature_add()
        armature = bpy.context.object
        armature.name = "armature"
        group = ob.vertex_groups.new(name=armature.data.bones[0].name)
        group.add([v.index for v in ob.data.vertices if v.co.x > 0.2], 1.0, "REPLACE")
        ob.modifiers.new("armature", "ARMATURE").object = armature
        bone = armature.pose.bones[0]
        bone.rotation_mode = "XYZ"
        animate(bone, "rotation_euler", (0, 0, -0.6), (0, 0, 0.6))
        animate(bone, "location", (0, 0, -0.6), (0, 0, 0.6))
        ob.cycles.motion_steps = 3
        self.compare_blur(least=0.03)

    def test_a_displaced_surface(self):
        """Cycles gets it subdivided."""
        ob = make_grid(16)
        displace(make_material(ob), make_image("hook", make_hook()))
        ob.shape_key_add(name="basis")
        key = ob.shape_key_add(name="raised")
        for point in key.data:
            point.co.z += 1
        animate(key, "value", 0.0, 1.0)
        ours = self.render("RELIEF", samples=SAMPLES)["Combined"]
        subdivide(ob, levels=4)
        theirs = self.render("CYCLES", samples=SAMPLES)["Combined"]
        self.check_alike(ours[..., 3:].repeat(4, -1), theirs[..., 3:].repeat(4, -1), "displaced", least=0.03)
        self.assertEqual(list(pathlib.Path(bpy.app.tempdir).glob("relief_*")), [])

    def test_a_driven_place_and_extrusion_of_text(self):
        bpy.ops.object.text_add()
        ob = bpy.context.object
        ob.data.body = "abc"
        emit(ob)
        ob.driver_add("location", 2).driver.expression = "frame - 1.0"
        ob.data.driver_add("extrude").driver.expression = "0.1 * frame"
        self.compare_blur()

    def test_more_steps_than_meshes_may_have_are_told(self):
        self.make_bending().cycles.motion_steps = 7
        self.compare_blur()
        self.assertIn("it deforms in 32 steps", " ".join(self.report()))

    def test_borders_of_displaced_materials_are_told(self):
        ob = self.make_bending()
        for index in range(2):
            displace(make_material(ob), make_image("hook", make_hook()))
        for face in ob.data.polygons:
            face.material_index = 1 + face.index % 2
        self.render("RELIEF", samples=1)
        self.assertIn("several materials that displace it", " ".join(self.report()))

    def test_other_faces_are_told(self):
        ob = make_box()
        emit(ob)
        animate(ob.modifiers.new("array", "ARRAY"), "count", 1, 3, frames=(1, 2))
        self.render("RELIEF")
        self.assertIn("its faces or uvs are others", " ".join(self.report()))


class View(Motion):
    def test_a_camera_that_moves_and_turns(self):
        emit(make_box())
        self.camera.cycles.motion_steps = 2
        turned = self.camera.rotation_euler.copy()
        animate(self.camera, "location", (-0.6, -6, 3), (0.6, -6, 3))
        animate(self.camera, "rotation_euler", (turned.x, 0, -0.1), (turned.x, 0.2, 0.25))
        self.compare_blur()

    def test_an_orthographic_camera_that_turns(self):
        emit(make_box())
        self.camera.data.type, self.camera.data.ortho_scale, self.camera.cycles.motion_steps = "ORTHO", 5, 2
        turned = self.camera.rotation_euler.copy()
        animate(self.camera, "rotation_euler", (turned.x, 0, -0.15), (turned.x, 0.3, 0.15))
        self.compare_blur()

    def test_a_camera_with_a_large_lens(self):
        emit(make_box())
        lens = self.camera.data.dof
        lens.use_dof, lens.aperture_fstop, lens.focus_distance = True, 0.1, 5
        animate(self.camera, "location", (-0.3, -6, 2.7), (0.3, -6, 3.3))
        self.compare_blur()

    def test_a_camera_that_zooms(self):
        emit(make_box())
        animate(self.camera.data, "lens", 35.0, 65.0)
        self.compare_blur(least=0.03)

    def test_a_shift_that_changes(self):
        """Cycles does not blur it."""
        emit(make_box())
        animate(self.camera.data, "shift_x", -0.1, 0.1)
        blurred = self.render("RELIEF", "blurred", SAMPLES)["Combined"]
        self.check_alike(blurred, self.average(np.linspace(0.5, 1.5, 33)[:-1] + 1 / 64), "stills")


class Others(Motion):
    """What Cycles does not blur is the mean of stills."""

    def check_stills(self, pixel=0.04):
        """The mean is as far off as 64 times that are no random ones, at most 2/64 of what changes; pixels have noise too."""
        blurred = self.render("RELIEF", "blurred", SAMPLES)["Combined"][..., :3]
        mean = self.average(np.linspace(0.5, 1.5, 17)[:-1] + 1 / 32, samples=16)[..., :3]
        middle = self.render_still(1, samples=SAMPLES)[..., :3]
        error, change = (np.abs(blurred - other).mean() / mean.mean() for other in (mean, middle))
        ratio = blurred.mean() / mean.mean()
        print(f"{self.id().split('.')[-1]}: mean {ratio:.4f} of that of stills, pixels off by {error:.4f}, those of the middle "
              f"by {change:.4f}", flush=True)
        self.assertAlmostEqual(ratio, 1, delta=2 / 64)
        self.assertLess(error, pixel)
        self.assertGreater(change, 2 * error, "nothing is blurred")

    def test_lights_that_move_and_turn(self):
        make_material(make_object([(-3, -3, 0), (3, -3, 0), (3, 3, 0), (-3, 3, 0)], [(0, 1, 2, 3)]), Roughness=1.0)
        set_world(bpy.context.scene.world, (0, 0, 0))
        spot = add_light("SPOT", (0, 0, 2), energy=300)
        animate(spot, "rotation_euler", (0, -0.9, 0), (0, 0.9, 0))
        point = add_light("POINT", energy=20)
        animate(point, "location", (-2, -1, 0.5), (2, -1, 0.5))
        animate(point.data, "energy", 10.0, 30.0)
        self.check_stills()

    def test_displacement_and_materials(self):
        ob = make_grid(16)
        material = make_material(ob, Base_Color=(0, 0, 0), Emission_Strength=1.0, Specular_IOR_Level=0.0)
        displace(material, make_image("hook", make_hook()))
        node = next(n for n in material.node_tree.nodes if n.bl_idname == "ShaderNodeVectorDisplacement")
        animate(node.inputs["Scale"], "default_value", 0.2, 1.8)
        principled = material.node_tree.nodes["Principled BSDF"]
        animate(principled.inputs["Emission Strength"], "default_value", 0.0, 3.0)
        self.check_stills()

    def test_heights_of_the_world_on_a_scaled_object(self):
        ob = make_grid(16)
        ob.scale = (1.5, 1.5, 1.5)
        material = emit(ob)
        displace(material, make_image("hook", make_hook()), "HEIGHT")
        node = next(n for n in material.node_tree.nodes if n.bl_idname == "ShaderNodeDisplacement")
        node.space = "WORLD"
        animate(node.inputs["Scale"], "default_value", 0.0, 0.0, 12.0, frames=(0, 1, 2))
        self.check_stills()

    def test_the_world(self):
        """Its strength rises from the frame on, so that the middle of the shutter is not the mean."""
        strength = set_world(bpy.context.scene.world, (1, 1, 1)).inputs["Strength"]
        animate(strength, "default_value", 0.0, 0.1, 2.0, frames=(0, 1, 2))
        make_material(make_box(), Roughness=1.0)
        self.check_stills(0.1)


class Times(Motion):
    def find_middle(self, picture):
        """Of what is seen, along x."""
        alpha = picture[..., 3]
        return float((alpha * np.arange(alpha.shape[1])).sum() / alpha.sum())

    def test_positions_of_the_shutter(self):
        ob = make_box((0.3, 0.3, 0.3))
        emit(ob)
        animate(ob, "location", (-1.2, 0, 0), (1.2, 0, 0))
        middles = {}
        for position in ("START", "CENTER", "END"):
            bpy.context.scene.render.motion_blur_position = position
            ours, theirs = self.compare_blur(position)
            middles[position] = self.find_middle(ours)
            self.assertAlmostEqual(middles[position], self.find_middle(theirs), delta=0.5)
        self.assertGreater(middles["START"] - middles["CENTER"], 5)
        self.assertGreater(middles["CENTER"] - middles["END"], 5)

    def test_nothing_changes_without_motion_blur(self):
        ob = make_box()
        emit(ob)
        animate(ob, "location", (-1, 0, 0), (1, 0, 0.5))
        moving = self.render_still(1)
        place = ob.matrix_world.copy()
        ob.animation_data_clear()
        ob.matrix_world = place
        self.assertTrue(np.array_equal(moving, self.render_still(1)))
        self.assertTrue(np.array_equal(moving, self.render("RELIEF", "no motion")["Combined"]))

    def test_each_frame_of_an_animation(self):
        ob = make_box((0.4, 0.4, 0.4))
        emit(ob)
        animate(ob, "location", (-1.5, 0, 0), (1.5, 0, 0.4))
        scene = bpy.context.scene
        alone = []
        for frame in (0, 1):
            scene.frame_set(frame)
            alone.append(self.render("RELIEF", f"alone {frame}", 8)["Combined"])
        scene.frame_start, scene.frame_end = 0, 1
        scene.render.filepath = str(self.folder / "frame_####.exr")
        bpy.ops.render.render(animation=True)
        for frame in (0, 1):
            self.assertTrue(np.array_equal(Layers(self.folder / f"frame_{frame:04}.exr")["Combined"], alone[frame]))

    def test_the_frame_is_as_it_was(self):
        ob = make_box()
        emit(ob)
        animate(ob, "location", (-1, 0, 0), (1, 0, 0.5))
        scene = bpy.context.scene
        scene.frame_set(1, subframe=0.25)
        place = ob.matrix_world.copy()
        self.render("RELIEF", samples=2)
        self.assertEqual((scene.frame_current, scene.frame_subframe, ob.matrix_world), (1, 0.25, place))

    def test_a_fault_leaves_the_frame_as_it_was(self):
        emit(make_box())
        scene = bpy.context.scene
        scene.render.engine = "RELIEF"
        original, motion_export.export_world = motion_export.export_world, self.fail_to_export
        animate(scene.world, "color", (0, 0, 0), (1, 1, 1))
        try:
            with self.assertRaisesRegex(RuntimeError, "no such world"):
                bpy.ops.render.render()
        finally:
            motion_export.export_world = original
        self.assertEqual((scene.frame_current, scene.frame_subframe), (1, 0.0))

    @staticmethod
    def fail_to_export(*arguments):
        raise RuntimeError("no such world")

    def test_the_panels_are_those_of_blenders_settings(self):
        ob = make_box()
        scene = bpy.context.scene
        bpy.context.view_layer.objects.active = ob
        for engine, is_shown in (("RELIEF", True), ("CYCLES", False)):
            scene.render.engine = engine
            for panel in (panels.RELIEF_PT_motion_blur, panels.RELIEF_PT_object_motion_blur):
                self.assertEqual(panel.poll(bpy.context), is_shown)

    def test_a_curve_and_a_rolling_shutter_are_told(self):
        scene = bpy.context.scene
        emit(make_box())
        self.render("RELIEF", samples=1)
        self.assertFalse(any("motion blur" in line for line in self.report()), self.report())
        scene.render.motion_blur_shutter_curve.curves[0].points[0].location = (0, 0)
        scene.cycles.rolling_shutter_type = "TOP"
        self.render("RELIEF", samples=1)
        self.assertIn("the shutter curve is taken for flat", " ".join(self.report()))
        self.assertIn("rolling shutter", " ".join(self.report()))


class Angles(unittest.TestCase):
    @staticmethod
    def rotate(degrees):
        """About x, then y, then z."""
        result = np.eye(3)
        for axis, angle in zip(np.eye(3), np.radians(degrees)):
            result = poses.rotate(axis, angle) @ result
        return result

    def test_angles_mean_the_rotation_and_go_on_from_those_before(self):
        random = np.random.default_rng(7)
        for _ in range(500):
            degrees = random.uniform(-720, 720, 3)
            if random.random() < 0.3:
                degrees[1] = random.choice([-90, 90, 270])
            found = poses.find_angles(self.rotate(degrees), random.uniform(-400, 400, 3))
            np.testing.assert_allclose(self.rotate(found), self.rotate(degrees), atol=1e-9)
        before = np.zeros(3)
        for angle in range(0, 1000, 10):
            before = poses.find_angles(self.rotate([0, angle, 0]), before)
        np.testing.assert_allclose(before, [0, 990, 0], atol=1e-6)

    def test_poses_in_between_turn_at_one_speed(self):
        first, second = (poses.Pose(np.zeros(3), self.rotate(d), np.ones(3)) for d in ([10, 20, 30], [-40, 60, 200]))
        times, fine = poses.refine([0.0, 1.0], [first, second], 5)
        np.testing.assert_allclose(fine[-1].rotation, second.rotation, atol=1e-9)
        angles = [poses.find_turn(a.rotation, b.rotation)[1] for a, b in zip(fine, fine[1:])]
        np.testing.assert_allclose(angles, angles[0], atol=1e-6)
        self.assertLessEqual(np.degrees(angles[0]), 5.001)
        self.assertEqual(len(times), len(fine))

    def test_what_shears_has_no_pose(self):
        shear = np.eye(4)
        self.assertIsNotNone(poses.find_pose(shear))
        shear[0, 1] = 0.01
        self.assertIsNone(poses.find_pose(shear))
        self.assertIsNone(poses.find_pose(np.diag([1, 0, 1, 1])))


if __name__ == "__main__":
    main()
