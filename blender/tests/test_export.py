"""What becomes of nodes, meshes and settings, without a render."""
from support import (BlenderTest, displace, main, make_grid, make_hook, make_image, make_material,  # first: finds the add-on
                     make_object, subdivide)
import bpy
import numpy as np
from relief_blender import images, mesh_arrays, topology, world_export
from relief_blender.camera_export import find_shift
from relief_blender.material_export import MaterialExport
from relief_blender.mesh_arrays import MeshArrays, index_equal
from relief_blender.report import Report
from relief_blender.scene_export import SceneExport

import relief


class Materials(BlenderTest):
    def setUp(self):
        super().setUp()
        self.report_lines = Report()
        self.material = make_material()
        self.tree = self.material.node_tree
        self.principled = self.tree.nodes["Principled BSDF"]

    def export(self, material=None):
        """Keys of the exported material."""
        scene = relief.Scene()
        self.exported = MaterialExport(scene, self.report_lines).export(material or self.material)
        self.scene = scene
        return scene.materials[self.exported.material]

    def node(self, kind, **settings):
        node = self.tree.nodes.new(kind)
        for name, value in settings.items():
            setattr(node, name, value)
        return node

    def feed(self, output, name="Base Color"):
        self.tree.links.new(output, self.principled.inputs[name])

    def texture(self, color=(0.25, 0.5, 0.75), size=4):
        image = make_image("picture", np.broadcast_to(np.array(color, np.float32), (size, size, 3)))
        return self.node("ShaderNodeTexImage", image=image)

    def test_a_texture_stays_one_and_takes_a_constant_factor(self):
        texture, mix = self.texture(), self.node("ShaderNodeMix", data_type="RGBA", blend_type="MULTIPLY")
        sockets = {socket.identifier: socket for socket in [*mix.inputs, *mix.outputs]}
        sockets["Factor_Float"].default_value, sockets["B_Color"].default_value = 1.0, (0.5, 1, 1, 1)
        self.tree.links.new(texture.outputs[0], sockets["A_Color"])
        self.feed(sockets["Result_Color"])
        keys = self.export()
        texels = relief._relief.read_texture(keys["base_color"]["file"])  # of the packed image
        np.testing.assert_allclose(texels[0, 0, :3] * keys["base_color"]["factor"], [0.125, 0.5, 0.75])
        self.assertEqual(self.report_lines.lines, [])

    def test_channels_math_and_ramps_are_computed_texel_by_texel(self):
        texture, parts = self.texture(), self.node("ShaderNodeSeparateColor")
        math, ramp = self.node("ShaderNodeMath", operation="MULTIPLY_ADD"), self.node("ShaderNodeValToRGB")
        math.inputs[1].default_value, math.inputs[2].default_value = 0.5, 0.1
        self.tree.links.new(texture.outputs[0], parts.inputs[0])
        self.tree.links.new(parts.outputs[1], math.inputs[0])
        self.tree.links.new(parts.outputs[2], ramp.inputs[0])
        self.feed(math.outputs[0], "Roughness")
        self.feed(ramp.outputs[0], "Base Color")
        keys = self.export()
        np.testing.assert_allclose(keys["roughness"]["file"][..., 0], 0.35, atol=1e-6)
        np.testing.assert_allclose(keys["base_color"]["file"], 0.75, atol=1e-3)

    def test_hue_and_saturation(self):
        hue = self.node("ShaderNodeHueSaturation")
        for socket, value in zip(hue.inputs, (0.5 + 1 / 3, 0.5, 2.0, 1.0)):
            socket.default_value = value
        hue.inputs["Color"].default_value = (0.4, 0.2, 0.2, 1)
        self.feed(hue.outputs[0])
        np.testing.assert_allclose(self.export()["base_color"], [0.6, 0.8, 0.6], atol=1e-6)

    def test_mapping_becomes_scale_and_offset(self):
        texture, mapping, uv = self.texture(), self.node("ShaderNodeMapping"), self.node("ShaderNodeUVMap", uv_map="second")
        mapping.inputs["Scale"].default_value, mapping.inputs["Location"].default_value = (2, 3, 1), (0.5, -0.25, 0)
        self.tree.links.new(uv.outputs[0], mapping.inputs[0])
        self.tree.links.new(mapping.outputs[0], texture.inputs[0])
        self.feed(texture.outputs[0])
        keys = self.export()["base_color"]
        self.assertEqual((keys["uv_scale"], keys["uv_offset"]), ([2, 3], [0.5, -0.25]))
        self.assertEqual(self.exported.base.uv_map, "second")

    def test_textures_on_other_uv_maps_have_sets_of_their_own(self):
        for name, uv_map, scale in (("Base Color", "second", 2), ("Roughness", "third", 3), ("Coat Weight", "second", 4)):
            texture, mapping, uv = self.texture(), self.node("ShaderNodeMapping"), self.node("ShaderNodeUVMap", uv_map=uv_map)
            mapping.inputs["Scale"].default_value = (scale, scale, 1)
            self.tree.links.new(uv.outputs[0], mapping.inputs[0])
            self.tree.links.new(mapping.outputs[0], texture.inputs[0])
            self.feed(texture.outputs[0], name)
        displaced = displace(self.material, make_image("hook", make_hook()))
        mapping = self.node("ShaderNodeMapping")
        mapping.inputs["Scale"].default_value = (5, 5, 1)
        self.tree.links.new(mapping.outputs[0], displaced.inputs[0])
        keys = self.export()
        self.assertEqual((self.exported.base.uv_map, self.exported.base.scale), ("", (5, 5)))
        for name, uv_map, scale in (("base_color", "second", 2), ("roughness", "third", 3), ("coat_weight", "second", 4)):
            self.assertEqual(self.exported.further[keys[name]["uv_set"] - 1], uv_map)
            self.assertEqual(keys[name]["uv_scale"], [scale, scale])  # the mapping of the displacement is not of these
        self.assertEqual(self.report_lines.lines, [])
        grid = make_grid(2)
        for name, size in (("second", 0.5), ("third", 0.25)):
            layer = grid.data.uv_layers.new(name=name)
            layer.uv.foreach_set("vector", np.full(2 * len(grid.data.loops), size, np.float32))
        arrays = mesh_arrays.read_mesh(grid.data, "", self.exported.further)
        for uv_map, uvs in zip(self.exported.further, arrays.further_uvs):
            self.assertTrue((uvs == {"second": 0.5, "third": 0.25}[uv_map]).all())

    def test_a_mapping_of_the_displacement_moves_the_uvs_and_not_the_other_textures(self):
        texture = displace(self.material, make_image("hook", make_hook()))
        mapping, color = self.node("ShaderNodeMapping"), self.texture()
        mapping.inputs["Scale"].default_value, mapping.inputs["Location"].default_value = (2, 4, 1), (0.5, 0.25, 0)
        self.tree.links.new(mapping.outputs[0], texture.inputs[0])
        self.feed(color.outputs[0])
        keys = self.export()["base_color"]
        self.assertEqual(self.exported.base.scale, (2, 4))
        # At uv the mesh has 2 u + 0.5, so that the texture is read at half of it less a quarter.
        self.assertEqual((keys["uv_scale"], keys["uv_offset"]), ([0.5, 0.25], [-0.25, -0.0625]))

    def test_groups_reroutes_and_muted_nodes_are_passed(self):
        group = bpy.data.node_groups.new("group", "ShaderNodeTree")
        group.interface.new_socket("In", in_out="INPUT", socket_type="NodeSocketColor")
        group.interface.new_socket("Out", in_out="OUTPUT", socket_type="NodeSocketColor")
        start, end = group.nodes.new("NodeGroupInput"), group.nodes.new("NodeGroupOutput")
        invert = group.nodes.new("ShaderNodeInvert")
        group.links.new(start.outputs[0], invert.inputs["Color"])
        group.links.new(invert.outputs[0], end.inputs[0])
        inside = self.node("ShaderNodeGroup", node_tree=group)
        inside.inputs[0].default_value = (0.2, 0.4, 0.9, 1)
        muted, reroute = self.node("ShaderNodeGamma", mute=True), self.node("NodeReroute")
        muted.inputs["Gamma"].default_value = 3
        self.tree.links.new(inside.outputs[0], muted.inputs[0])
        self.tree.links.new(muted.outputs[0], reroute.inputs[0])
        self.feed(reroute.outputs[0])
        np.testing.assert_allclose(self.export()["base_color"], [0.8, 0.6, 0.1], atol=1e-6)

    def test_what_cannot_be_expressed_is_named_once_and_never_black(self):
        noise = self.node("ShaderNodeTexNoise")
        self.feed(noise.outputs["Color"])
        self.feed(noise.outputs["Fac"], "Roughness")
        self.principled.inputs["Subsurface Weight"].default_value = 0.5
        self.principled.inputs["Base Color"].default_value = (0.3, 0.6, 0.2, 1)
        keys = self.export()
        np.testing.assert_allclose(keys["base_color"], [0.3, 0.6, 0.2], atol=1e-6)
        lines = "\n".join(self.report_lines.lines)
        self.assertEqual(lines.count("Base Color"), 1)
        self.assertIn("Noise Texture", lines)
        self.assertIn("subsurface", lines)

    def test_an_unknown_shader_is_grey(self):
        hair = self.node("ShaderNodeBsdfHair")
        self.tree.links.new(hair.outputs[0], self.tree.get_output_node("ALL").inputs["Surface"])
        self.assertEqual(np.round(self.export()["base_color"], 3).tolist(), [0.8, 0.8, 0.8])
        self.assertIn("Hair BSDF", "".join(self.report_lines.lines))

    def test_mixed_with_transparent_it_is_a_cut_out(self):
        mix, clear = self.node("ShaderNodeMixShader"), self.node("ShaderNodeBsdfTransparent")
        mix.inputs["Fac"].default_value = 0.3
        self.tree.links.new(clear.outputs[0], mix.inputs[1])
        self.tree.links.new(self.principled.outputs[0], mix.inputs[2])
        self.tree.links.new(mix.outputs[0], self.tree.get_output_node("ALL").inputs["Surface"])
        self.assertAlmostEqual(self.export()["geometry_opacity"], 0.3, places=6)

    def test_glass_coat_and_cut_outs_that_emit_are_settled(self):
        for name, value in (("Transmission Weight", 1), ("Coat Weight", 1), ("Alpha", 0.5), ("Emission Strength", 1)):
            self.principled.inputs[name].default_value = value
        keys = self.export()
        self.assertNotIn("coat_weight", keys)
        self.assertNotIn("emission", keys)
        self.assertEqual(len(self.report_lines.lines), 2)
        self.validate()

    def validate(self):
        """The scene reader takes the material."""
        self.scene.add(relief.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]), material=self.exported.material)
        self.scene.validate()

    def test_all_inputs_together_are_taken_by_the_scene_reader(self):
        for socket in self.principled.inputs:
            if socket.name in {"Coat Weight", "Sheen Weight", "Diffuse Roughness", "Emission Strength", "Metallic"}:
                socket.default_value = 0.5
        names = ["Roughness", "Coat Roughness", "Sheen Roughness", "Coat Weight"]
        names.append("Diffuse Roughness" if "Diffuse Roughness" in self.principled.inputs else "Sheen Weight")
        for name in names:
            self.feed(self.texture().outputs[0], name)
        self.export()
        self.assertTrue(any("fifth texture" in line for line in self.report_lines.lines))
        self.validate()

    def test_byte_images_are_decoded_from_srgb_and_data_is_not(self):
        for is_data, wanted in ((False, 0.2140), (True, 0.5)):
            image = bpy.data.images.new("bytes", 2, 2, is_data=is_data)
            image.pixels.foreach_set([0.5, 0.5, 0.5, 1.0] * 4)
            self.assertAlmostEqual(float(images.read_tiles(image, print)[1001][0, 0, 0]), wanted, delta=0.003)

    def test_images_have_row_0_at_the_top(self):
        texels = np.zeros((2, 2, 3), np.float32)
        texels[0] = 1
        np.testing.assert_array_equal(images.read_tiles(make_image("rows", texels), print)[1001][..., 0], [[1, 1], [0, 0]])

    def test_a_file_stays_a_file(self):
        image = make_image("hook", make_hook())
        image.filepath_raw, image.file_format = str(self.folder / "hook.exr"), "OPEN_EXR"
        image.save()
        displace(self.material, bpy.data.images.load(str(self.folder / "hook.exr")))
        self.material.node_tree.nodes["Image Texture"].image.colorspace_settings.name = "Non-Color"
        self.export()
        self.assertEqual(self.scene.displacements["material"]["file"], str(self.folder / "hook.exr"))
        self.assertEqual(self.scene.displacements["material"]["axes"], "t,n,b")


class Meshes(BlenderTest):
    def export(self):
        self.report_lines = Report()
        return SceneExport(bpy.context.evaluated_depsgraph_get(), self.report_lines).run()

    def test_a_subdivision_surface_is_its_cage(self):
        ob = make_grid(3)
        modifier = subdivide(ob, "CATMULL_CLARK", 4)
        scene = self.export()
        mesh = next(iter(scene.meshes.values()))
        self.assertEqual(len(mesh.sizes), 9)
        self.assertEqual(mesh.subdivision, {"scheme": "catmark", "level": 4, "uv": "smooth", "boundary": "edge-only",
                                            "creases": True})
        modifier.uv_smooth, modifier.boundary_smooth, modifier.use_creases = "NONE", "PRESERVE_CORNERS", False
        mesh = next(iter(self.export().meshes.values()))
        self.assertEqual(mesh.subdivision, {"scheme": "catmark", "level": 4, "uv": "linear",
                                            "boundary": "edge-and-corner", "creases": False})
        scene.validate()

    def test_a_cage_that_is_no_surface_is_subdivided_by_blender_and_named(self):
        make_object([(0, 0, 0), (0, 0, 1), (1, 0, 0), (1, 0, 1), (0, 1, 0), (0, 1, 1), (-1, 0, 0), (-1, 0, 1)],
                    [(0, 2, 3, 1), (0, 4, 5, 1), (0, 6, 7, 1)])
        subdivide(bpy.context.scene.objects["thing"], "CATMULL_CLARK", 2)
        scene = self.export()
        self.assertEqual(sum(len(mesh.sizes) for mesh in scene.meshes.values()), 48)
        self.assertTrue(any("it is subdivided by its Levels" in line for line in self.report_lines.lines))

    def test_objects_that_share_a_mesh_share_it_here(self):
        ob = make_grid(2)
        other = bpy.data.objects.new("other", ob.data)
        other.location = (0, 0, 2)
        bpy.context.scene.collection.objects.link(other)
        scene = self.export()
        self.assertEqual((len(scene.objects), len(scene.meshes)), (2, 1))
        # Two units up is two units along y.
        matrix = np.reshape(next(o for o in scene.objects if o["name"] == "other")["transform"]["matrix"], (4, 4))
        np.testing.assert_allclose(matrix @ [0, 0, 0, 1], [0, 2, 0, 1])

    def test_topology(self):
        def arrays(positions, *faces):
            sizes = np.array([len(f) for f in faces], np.int32)
            return MeshArrays(np.array(positions, np.float32), sizes, np.concatenate(faces).astype(np.int32), sizes * 0, None)
        points = [(x, y, 0) for y in range(3) for x in range(3)]
        self.assertTrue(topology.can_be_subdivided(arrays(points, [0, 1, 4, 3], [1, 2, 5, 4], [3, 4, 7, 6])))
        self.assertFalse(topology.can_be_subdivided(arrays(points, [0, 1, 4, 3], [4, 5, 8, 7])), "they touch in a point")
        self.assertFalse(topology.can_be_subdivided(arrays(points, [0, 1, 4, 3], [4, 5, 2, 1])), "they are turned")

    def test_equal_uvs_of_one_point_are_one_and_those_of_others_are_not(self):
        rows, indices = index_equal(np.array([0, 1, 0, 1]), np.array([[0, 0], [0, 0], [0, 0], [1, 0]], np.float32))
        self.assertEqual(len(rows), 3)
        self.assertEqual(indices[0], indices[2])
        self.assertNotEqual(indices[0], indices[1])

    def test_joining_corners_finds_what_sorting_all_columns_finds(self):
        rng = np.random.default_rng(5)
        for columns in (2, 3):
            corners = rng.integers(0, 300, 5000).astype(np.int32)
            rows = rng.integers(-2, 3, (5000, columns)).astype(np.float32) / 3
            rows[:50] = np.nan
            for is_hashed in (True, False):
                joined, indices = self.join(corners, rows, is_hashed)
                np.testing.assert_array_equal(joined[indices], rows)
                bits = np.concatenate([corners[:, None], rows.view(np.int32)], -1)
                self.assertEqual(len(joined), len(np.unique(bits, axis=0)))
                owners = np.full(len(joined), -1)
                owners[indices] = corners
                np.testing.assert_array_equal(owners[indices], corners)
                self.assertTrue(np.all(np.diff(owners) >= 0), "in the order of points")

    @staticmethod
    def join(corners, rows, is_hashed):
        """index_equal, or with a hash that is the same for all rows."""
        original = mesh_arrays._hash
        if not is_hashed:
            mesh_arrays._hash = lambda keys: np.zeros(len(keys), np.uint64)
        try:
            return index_equal(corners, rows)
        finally:
            mesh_arrays._hash = original

    def test_corners_of_no_mesh_are_joined_to_nothing(self):
        rows, indices = index_equal(np.zeros(0, np.int32), np.zeros((0, 3), np.float32))
        self.assertEqual((rows.shape, indices.shape), ((0, 3), (0,)))

    def test_places_are_counted_whatever_the_sign_of_zero(self):
        self.assertEqual(mesh_arrays.count_places(np.array([[0, 1, 2], [-0.0, 1, 2], [0, 1, 3]], np.float32)), 2)

    def test_hidden_and_unknown_objects(self):
        make_grid(2).hide_render = True
        make_grid(2).visible_camera = False
        bpy.context.scene.collection.objects.link(bpy.data.objects.new("cloud", bpy.data.volumes.new("cloud")))
        self.export()
        text = "\n".join(self.report_lines.lines)
        self.assertIn('object "cloud": volume objects', text)
        self.assertIn("the camera does not see it", text)


class Cameras(BlenderTest):
    def test_a_shifted_lens_looks_past_the_axis(self):
        for offset in (0, 0.1, 0.3337, -0.21):
            projection = np.diag([2.0, 3.0, -1.0, 0.0])
            projection[0][2], projection[1][2] = offset, -offset / 2
            right, up = find_shift(projection, 200, 151)
            # Of a point on the axis, in pixels from the middle.
            axis = projection @ np.array([0, 0, -1, 1])
            self.assertAlmostEqual(-right * 151, axis[0] * 100, places=4)
            self.assertAlmostEqual(-up * 151, axis[1] * 75.5, places=4)

    def test_rotations_are_those_of_blender(self):
        from mathutils import Euler
        angles = (0.3, -0.8, 1.9)
        np.testing.assert_allclose(world_export.rotate_by_euler(angles), np.array(Euler(angles).to_matrix()), atol=1e-6)


if __name__ == "__main__":
    main()
