"""Stereoscopy: each view as by Cycles."""
from support import BlenderTest, Layers, main, make_grid, make_material, write_layers  # first: it makes the add-on known
import bpy
import numpy as np


class Stereo(BlenderTest):
    def setUp(self):
        super().setUp()
        self.ob = make_grid(2, lambda u, v: (2 * u - 1, 2 * v - 1, 0.5 * u))
        make_material(self.ob)
        scene = bpy.context.scene
        scene.render.use_multiview = True
        scene.render.image_settings.views_format = "INDIVIDUAL"
        self.stereo = self.camera.data.stereo
        self.stereo.interocular_distance, self.stereo.convergence_distance = 1.2, 5.0

    def render_views(self, engine, samples=4):
        """Layers of the left and the right view."""
        scene = bpy.context.scene
        scene.render.engine = engine
        scene.relief.samples = scene.cycles.samples = samples
        file = self.folder / f"{engine}.exr"
        write_layers(scene, file)
        bpy.ops.render.render(write_still=True)
        return [Layers(self.folder / f"{engine}_{letter}.exr") for letter in "LR"]

    def compare_views(self, name, samples=4):
        ours, theirs = self.render_views("RELIEF", samples), self.render_views("CYCLES", samples)
        for view, our, their in zip("LR", ours, theirs):
            differing = np.mean(np.abs(our["Combined"][..., 3] - their["Combined"][..., 3]))
            print(f"{name} {view}: alpha {100 * differing:.3f} %", flush=True)
            self.assertGreater(our.mask.mean(), 0.02)
            self.assertLess(differing, 0.01)
        self.assertGreater(np.mean(ours[0].mask != ours[1].mask), 0.01, "the views are equal")
        return ours

    def test_each_view_is_that_of_cycles(self):
        for mode in ("OFFAXIS", "PARALLEL", "TOE"):
            self.stereo.convergence_mode = mode
            left, _ = self.compare_views(mode)
        both = left.mask & (left["Depth"] < 1e9)
        self.assertLess(np.ptp(left["Depth"][both]), 5)

    def test_shifts_and_sensors(self):
        data = self.camera.data
        for fit, size in (("AUTO", (100, 150)), ("VERTICAL", (150, 100)), ("HORIZONTAL", (100, 150))):
            data.sensor_fit, data.shift_x, data.lens = fit, 0.05, 40
            bpy.context.scene.render.resolution_x, bpy.context.scene.render.resolution_y = size
            self.compare_views(fit)

    def test_an_orthographic_camera(self):
        self.camera.data.type, self.camera.data.ortho_scale = "ORTHO", 4
        self.stereo.convergence_mode = "TOE"
        self.compare_views("orthographic")

    def test_cameras_of_their_own(self):
        scene = bpy.context.scene
        scene.render.views_format = "MULTIVIEW"
        scene.render.views["left"].camera_suffix, scene.render.views["right"].camera_suffix = "_L", "_R"
        self.camera.name = "eye_L"
        other = bpy.data.objects.new("eye_R", self.camera.data)
        other.matrix_world = self.camera.matrix_world
        other.rotation_euler, other.location = self.camera.rotation_euler, self.camera.location
        other.location.x += 0.8
        scene.collection.objects.link(other)
        self.compare_views("own")

    def test_motion_blur(self):
        scene = bpy.context.scene
        for frame, x in ((0, -0.3), (2, 0.3)):
            self.camera.location.x = x
            self.camera.keyframe_insert("location", frame=frame)
        scene.frame_set(1)
        scene.render.use_motion_blur, scene.render.motion_blur_shutter = True, 1.0
        self.compare_views("motion", 16)

    def test_a_view_that_is_off(self):
        scene = bpy.context.scene
        scene.render.views["left"].use = False
        scene.render.engine, scene.relief.samples = "RELIEF", 1
        write_layers(scene, self.folder / "one.exr")
        bpy.ops.render.render(write_still=True)
        files = [file for file in self.folder.iterdir() if file.name.startswith("one")]
        self.assertEqual(len(files), 1)
        self.assertGreater(Layers(files[0]).mask.mean(), 0.03)


if __name__ == "__main__":
    main()
