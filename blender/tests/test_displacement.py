"""Displaced surfaces by Relief and by Cycles: the same silhouettes and depths."""
import bpy
import numpy as np
from support import (BlenderTest, displace, main, make_grid, make_hook, make_image, make_material, subdivide)

from relief_blender import passes


class Displacement(BlenderTest):
    def make_plane(self, count=64, **keys):
        return make_grid(count, **keys)

    def test_tangent_space_on_a_plane(self):
        ob = self.make_plane()
        displace(make_material(ob), make_image("hook", make_hook()))
        subdivide(ob, levels=2)
        self.compare()

    def test_object_space_on_a_turned_and_stretched_plane(self):
        ob = self.make_plane()
        ob.rotation_euler, ob.scale = (0.4, 0.2, 0.8), (1.2, 0.8, 1.5)
        displace(make_material(ob), make_image("hook", make_hook()[..., [0, 2, 1]]), "OBJECT")
        subdivide(ob, levels=2)
        self.compare()

    def test_world_space_on_a_turned_plane(self):
        ob = self.make_plane()
        ob.rotation_euler, ob.scale = (0.5, 0.2, 0.7), (1.2, 1.2, 1.2)
        displace(make_material(ob), make_image("hook", make_hook()[..., [0, 2, 1]]), "WORLD")
        subdivide(ob, levels=2)
        self.compare()

    def test_tangent_space_on_a_scaled_torus_with_mirrored_uvs(self):
        def torus(u, v):
            a, b = 2 * np.pi * u, 2 * np.pi * v
            return (1.3 + 0.6 * np.cos(b)) * np.cos(a), (1.3 + 0.6 * np.cos(b)) * np.sin(a), 0.6 * np.sin(b)
        ob = make_grid(96, torus, (True, True), lambda u, v: (1 - 2 * abs(u - 0.5), 2 * v))
        ob.scale = (1.1, 1.1, 1.1)
        displace(make_material(ob), make_image("hook", make_hook()), scale=0.6)
        subdivide(ob, "CATMULL_CLARK", 2)
        self.compare()

    def test_an_object_that_is_mirrored_by_its_scale(self):
        ob = self.make_plane()
        ob.scale = (-1, 1, 1)
        displace(make_material(ob), make_image("hook", make_hook()))
        subdivide(ob, levels=2)
        self.compare()

    def test_heights_with_midlevel_and_scale(self):
        ob = self.make_plane()
        height = np.repeat(make_hook()[..., 1:2] + 0.5, 3, -1)
        displace(make_material(ob), make_image("height", height), "HEIGHT", 1.4, 0.4)
        subdivide(ob, levels=2)
        self.compare()

    def test_tiles(self):
        ob = self.make_plane(uv=lambda u, v: (2 * u, v))
        for number, scale in ((1001, 1.0), (1002, -0.6)):
            tile = make_image("tile", make_hook() * np.array([scale, abs(scale), 1], np.float32))
            tile.filepath_raw, tile.file_format = str(self.folder / f"hook.{number}.exr"), "OPEN_EXR"
            tile.save()
        bpy.ops.image.open(filepath=str(self.folder / "hook.1001.exr"), use_udim_detecting=True)
        image = bpy.data.images["hook.<UDIM>.exr"]
        self.assertEqual([tile.number for tile in image.tiles], [1001, 1002])
        image.colorspace_settings.name = "Non-Color"
        material = make_material(ob)
        texture = displace(material, image)
        subdivide(ob, levels=2)
        # Cycles 4.5 displaces by the first tile alone, so that it gets both as one picture.
        self.compare(before_cycles=lambda: self.join_tiles(material, texture))

    def join_tiles(self, material, texture):
        right = make_hook() * np.array([-0.6, 0.6, 1], np.float32)
        texture.image = make_image("joined", np.concatenate([make_hook(), right], 1))
        self.add_mapping(material, texture, Scale=(0.5, 1, 1))

    def add_mapping(self, material, texture, **inputs):
        tree = material.node_tree
        mapping, coordinates = tree.nodes.new("ShaderNodeMapping"), tree.nodes.new("ShaderNodeTexCoord")
        for name, value in inputs.items():
            mapping.inputs[name].default_value = value
        tree.links.new(coordinates.outputs["UV"], mapping.inputs["Vector"])
        tree.links.new(mapping.outputs[0], texture.inputs["Vector"])

    def test_mapping_of_the_map(self):
        ob = self.make_plane()
        material = make_material(ob)
        texture = displace(material, make_image("hook", make_hook()), scale=0.6)
        self.add_mapping(material, texture, Scale=(2, 1, 1), Location=(0.25, 0.1, 0))
        subdivide(ob, levels=2)
        self.compare()

    def test_a_color_on_another_uv_map(self):
        """Seen from above, so that pixels of both look at the same places."""
        ob, (v, u) = make_grid(8), np.mgrid[0:64, 0:64] / 64
        layer, uvs = ob.data.uv_layers.new(name="second"), np.empty(2 * len(ob.data.loops), np.float32)
        ob.data.uv_layers[0].uv.foreach_get("vector", uvs)
        layer.uv.foreach_set("vector", 0.5 + 0.4 * uvs.reshape(-1, 2)[:, ::-1].reshape(-1))
        material = make_material(ob, Roughness=1.0, Specular_IOR_Level=0.0)
        displace(material, make_image("hook", make_hook()), scale=0.3)
        tree = material.node_tree
        texture, uv = tree.nodes.new("ShaderNodeTexImage"), tree.nodes.new("ShaderNodeUVMap")
        texture.image = make_image("stripes", np.stack([u, v, 0.5 + 0.5 * np.sin(20 * u)], -1).astype(np.float32))
        uv.uv_map = "second"
        tree.links.new(uv.outputs[0], texture.inputs[0])
        tree.links.new(texture.outputs[0], tree.nodes["Principled BSDF"].inputs["Base Color"])
        bpy.context.view_layer.use_pass_diffuse_color = True
        subdivide(ob, levels=4)
        self.camera.location, self.camera.rotation_euler = (0, 0, 6), (0, 0, 0)
        ours, theirs = self.compare("color")
        both = ours.mask & theirs.mask
        name = next(p.name for p in passes.PASSES if p.layer == "albedo")
        error = np.abs(ours[name] - theirs[name])[both]
        print(f"color: median {np.median(error):.4f}, 95 % {np.quantile(error, 0.95):.4f}", flush=True)
        self.assertLess(np.median(error), 0.01)
        self.assertEqual(self.report(), [])

    def test_bump_only_is_not_displaced_and_named(self):
        ob = self.make_plane(8)
        material = make_material(ob)
        displace(material, make_image("hook", make_hook()))
        material.displacement_method = "BUMP"
        self.compare()
        self.assertTrue(any("Bump Only" in line for line in self.report()), self.report())

    def test_two_materials_stay_closed_at_their_border(self):
        ob = self.make_plane()
        image = make_image("hook", make_hook())
        for _ in range(2):
            displace(make_material(ob), image)
        ob.data.polygons.foreach_set("material_index", [i % 64 // 32 for i in range(64 * 64)])
        subdivide(ob, levels=2)
        ours, theirs = self.compare()
        inner = theirs["Combined"][..., 3] == 1
        self.assertLess(np.mean(ours["Combined"][..., 3][inner] < 0.99), 0.004, "the border is open")


if __name__ == "__main__":
    main()
