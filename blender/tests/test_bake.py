"""Maps baked from detailed meshes: the base with the map looks like the mesh that it was baked from."""
from support import BlenderTest, main, make_grid  # first: it makes the add-on known
import bpy
import numpy as np
from relief_blender import bake, bake_texels
from relief_blender.bake_texels import Raster, add_margin


def bump(u, v):
    return np.exp(-((u - 0.55) ** 2 + (v - 0.5) ** 2) / 0.02)


class Bake(BlenderTest):
    def select(self, active, *others):
        for ob in bpy.context.scene.objects:
            ob.select_set(ob in (active, *others))
        bpy.context.view_layer.objects.active = active

    def check_silhouette(self, base, detailed):
        detailed.hide_render = False
        base.hide_render = True
        wanted = self.render("RELIEF", "detailed", 8)
        detailed.hide_render, base.hide_render = True, False
        ours = self.render("RELIEF", "baked", 8)
        differing = np.mean(wanted.mask != ours.mask)
        both = (wanted["Combined"][..., 3] == 1) & (ours["Combined"][..., 3] == 1)
        error = np.abs(self.find_depths(wanted) - self.find_depths(ours))[both] / np.ptp(wanted["Depth"][both])
        print(f"{self.id().split('.')[-1]}: mask {100 * differing:.3f} %, depth median {np.median(error):.5f}", flush=True)
        self.assertLess(differing, 0.005)
        self.assertLess(np.median(error), 0.003)

    def test_a_hill_is_baked_by_rays_onto_a_plane_that_is_elsewhere(self):
        for space in ("TANGENT", "OBJECT"):
            detailed = make_grid(128, lambda u, v: (2 * u - 1, 2 * v - 1, 0.8 * bump(u, v) - 0.05))
            base = make_grid(2)
            base.location, base.rotation_euler = (0.3, 0.2, -0.1), (0.2, 0, 0.4)
            detailed.location, detailed.rotation_euler = base.location, base.rotation_euler
            bpy.context.view_layer.update()
            self.select(base, detailed)
            self.assertEqual(bpy.ops.relief.bake_map(width=256, height=256, space=space), {"FINISHED"})
            self.check_silhouette(base, detailed)
            for ob in (base, detailed):
                bpy.data.objects.remove(ob)

    def test_a_ball_is_baked_onto_a_coarser_ball(self):
        def ball(radius):
            def place(u, v):
                a, b, r = 2 * np.pi * u, np.pi * (np.clip(v, 0.02, 0.98) - 0.5), radius(u, v)
                return r * np.cos(a) * np.cos(b), r * np.sin(a) * np.cos(b), r * np.sin(b)
            return place
        detailed = make_grid(128, ball(lambda u, v: 1 + 0.3 * np.sin(6 * np.pi * u) * np.sin(np.pi * v) ** 2), (True, False))
        base = make_grid(32, ball(lambda u, v: 1 + 0 * u), (True, False))
        self.select(base, detailed)
        self.assertEqual(bpy.ops.relief.bake_map(width=512, height=512), {"FINISHED"})
        self.check_silhouette(base, detailed)

    def test_a_multires_sculpt_with_an_overhang(self):
        ob = make_grid(4)
        self.select(ob)
        modifier = ob.modifiers.new("multires", "MULTIRES")
        for _ in range(4):
            bpy.ops.object.multires_subdivide(modifier=modifier.name)
        sculpt = self.sculpt(ob)
        self.select(ob)
        self.assertEqual(bpy.ops.relief.bake_map(width=256, height=256), {"FINISHED"})
        self.assertEqual(ob.modifiers[-1].type, "SUBSURF")
        self.check_silhouette(ob, sculpt)

    def sculpt(self, ob):
        """Moves the points of the finest level by reshaping; returns a mesh of the result."""
        evaluated = ob.evaluated_get(bpy.context.evaluated_depsgraph_get())
        mesh = bpy.data.meshes.new_from_object(evaluated)
        positions = np.empty(3 * len(mesh.vertices), np.float32)
        mesh.vertices.foreach_get("co", positions)
        x, y, z = positions.reshape(-1, 3).T
        hill = np.exp(-(x ** 2 + y ** 2) / 0.12)
        mesh.vertices.foreach_set("co", np.stack([x + 0.5 * hill ** 2, y, z + hill], -1).astype(np.float32).ravel())
        mesh.update()
        sculpt = bpy.data.objects.new("sculpt", mesh)
        bpy.context.scene.collection.objects.link(sculpt)
        bpy.context.view_layer.update()
        self.select(ob, sculpt)
        self.assertEqual(bpy.ops.object.multires_reshape(modifier=ob.modifiers[0].name), {"FINISHED"})
        return sculpt

    def test_mistakes_are_named(self):
        ob = make_grid(2)
        self.select(ob)
        with self.assertRaisesRegex(RuntimeError, "Multiresolution"):
            bpy.ops.relief.bake_map()
        other = make_grid(2)
        ob.data.uv_layers.remove(ob.data.uv_layers[0])
        ob.data.update_tag()
        self.select(ob, other)
        with self.assertRaisesRegex(RuntimeError, "no uv map"):
            bpy.ops.relief.bake_map()

    def test_meshes_without_faces_are_named(self):
        ob, other = make_grid(2), make_grid(2)
        self.select(ob, other)
        other.data.clear_geometry()
        with self.assertRaisesRegex(RuntimeError, "the detailed mesh has no faces"):
            bpy.ops.relief.bake_map(width=16, height=16)
        self.select(other, ob)
        with self.assertRaisesRegex(RuntimeError, "the base has no faces"):
            bpy.ops.relief.bake_map(width=16, height=16)

    def test_a_base_without_height_is_named(self):
        ob, other = make_grid(2), make_grid(2)
        ob.scale.z = 0
        bpy.context.view_layer.update()
        self.select(ob, other)
        with self.assertRaisesRegex(RuntimeError, "has a scale of zero"):
            bpy.ops.relief.bake_map(width=16, height=16)

    def test_uvs_that_a_map_cannot_hold_are_named(self):
        detailed, ob = make_grid(2), make_grid(2)
        self.select(ob, detailed)
        layer = ob.data.uv_layers[0].uv
        uvs = np.empty(2 * len(layer), np.float32)
        layer.foreach_get("vector", uvs)
        uvs = uvs.reshape(-1, 2)
        cases = ((np.abs(2 * uvs - 1), "first one counts"), (2 * uvs, "outside of the unit square"),
                 (uvs + 3, "no texel is inside"))
        for moved, wanted in cases:
            layer.foreach_set("vector", moved.astype(np.float32).ravel())
            ob.data.update()
            bpy.context.view_layer.update()
            texts = self.bake_and_listen()
            self.assertTrue(any(wanted in text for text in texts), texts)

    def bake_and_listen(self):
        """What the operator tells, without its kind."""
        texts = []
        original = bake.make_raster
        bake.make_raster = lambda base, settings, report: original(base, settings, texts.append)
        try:
            bpy.ops.relief.bake_map(width=32, height=32)
        except RuntimeError as fault:
            texts.append(str(fault))
        finally:
            bake.make_raster = original
        return texts

    def test_no_triangles_and_uvs_that_are_no_numbers_have_no_texels(self):
        nothing = Raster(np.zeros((0, 3, 2)), 8, 4)
        self.assertEqual((nothing.texels.shape, nothing.weights.shape, nothing.overlap), ((0,), (0, 3), 0))
        self.assertEqual(nothing.make_image(nothing.interpolate(np.zeros((0, 3, 3))))[0].shape, (4, 8, 3))
        good = [[0, 0], [1, 0], [1, 1]]
        for bad in (np.nan, np.inf, -np.inf):
            with np.errstate(all="raise"):
                raster = Raster(np.array([[[bad, 0], [1, 0], [0, 1]], good, [[0, 0], [bad, bad], [0, 1]]]), 8, 8)
            only = Raster(np.array([good], float), 8, 8)
            np.testing.assert_array_equal(raster.texels[raster.triangles == 1], only.texels, str(bad))
            self.assertEqual(set(raster.triangles), {1}, str(bad))

    def test_triangles_far_outside_have_no_texels(self):
        far = np.array([[[5, 5], [6, 5], [5, 6]], [[-3, 0], [-2, 0], [-2, 1]]], float)
        self.assertEqual(len(Raster(far, 16, 16).texels), 0)

    def test_of_triangles_that_overlap_the_first_one_counts(self):
        half = np.array([[[0, 0], [1, 0], [0, 1]]], float)
        raster = Raster(np.concatenate([half, half, 1 - half]), 16, 16)
        self.assertEqual(set(raster.triangles), {0, 2})
        self.assertGreater(raster.overlap, 0.3)
        self.assertEqual(Raster(np.concatenate([half, 1 - half]), 16, 16).overlap, 0)

    def test_large_triangles_are_cut_into_bands_with_the_same_texels(self):
        rng = np.random.default_rng(3)
        uvs = rng.uniform(-0.2, 1.2, (20, 3, 2))
        whole, original = Raster(uvs, 70, 50), bake_texels.CHUNK
        try:
            for bake_texels.CHUNK in (1, 64, 200, 1000):
                cut = Raster(uvs, 70, 50)
                for name in ("texels", "triangles", "weights", "overlap"):
                    np.testing.assert_array_equal(getattr(cut, name), getattr(whole, name), name)
        finally:
            bake_texels.CHUNK = original

    def test_no_chunk_is_larger_than_two(self):
        sizes = []
        fill, Raster._fill = Raster._fill, lambda raster, at, owners, low, high: (
            sizes.append(int(np.prod(high - low, -1).sum())), fill(raster, at, owners, low, high))[1]
        original, bake_texels.CHUNK = bake_texels.CHUNK, 4096
        try:
            Raster(np.array([[[0, 0], [1, 0], [0, 1]]] * 3, float), 512, 256)
        finally:
            Raster._fill, bake_texels.CHUNK = fill, original
        self.assertLessEqual(max(sizes), 2 * 4096)
        self.assertGreaterEqual(sum(sizes), 3 * 512 * 256)

    def test_texels_are_those_whose_middles_are_inside(self):
        uvs = np.array([[[0, 0], [1, 0], [1, 1]], [[0, 0], [1, 1], [0, 1]]], float)
        raster = Raster(uvs, 8, 4)
        self.assertEqual(len(raster.texels), 32)
        at = raster.interpolate(uvs)
        np.testing.assert_allclose(at[:, 0], (raster.texels % 8 + 0.5) / 8)
        np.testing.assert_allclose(at[:, 1], 1 - (raster.texels // 8 + 0.5) / 4)

    def test_a_margin_takes_the_values_beside_it(self):
        image, mask = np.zeros((5, 5, 1), np.float32), np.zeros((5, 5), bool)
        image[2, 2], mask[2, 2] = 3, True
        grown = add_margin(image, mask, 1)[..., 0]
        self.assertEqual((grown[2, 1], grown[1, 2], grown[1, 1]), (3, 3, 0))


if __name__ == "__main__":
    main()
