"""Meshes, transforms and values that are not finite or have no size: left out and named, the rest is rendered."""
from support import (BlenderTest, displace, main, make_grid, make_image, make_material, make_object,  # first
                     set_world, subdivide)
import math

import bpy
import numpy as np
from relief_blender import mesh_arrays, mesh_repair
from relief_blender.mesh_arrays import MeshArrays

NO_AREA = 'object "bad": its faces have no area: it is left out'


class Meshes(BlenderTest):
    def setUp(self):
        super().setUp()
        ob = make_grid(1)
        make_material(ob)
        self.plain = self.render("RELIEF", samples=2)

    def add(self, points, faces, name="bad", uvs=None):
        ob = make_object(points, faces, uvs, name)
        ob.location.z = -0.5
        return ob

    def check(self, *lines):
        ours = self.render("RELIEF", samples=2)
        self.assertLess(np.mean(ours.mask != self.plain.mask), 0.001)
        self.assertEqual(self.report(), list(lines))
        return ours

    def test_meshes_without_area_are_left_out(self):
        for points in ([(0, 0, 0)] * 3, [(0, 0, 0), (1, 0, 0), (2, 0, 0)]):
            ob = self.add(points, [(0, 1, 2)])
            self.check(NO_AREA)
            subdivide(ob, "CATMULL_CLARK", 2)
            self.check(NO_AREA)
            bpy.data.objects.remove(ob)

    def test_an_animation_goes_on_where_a_shape_key_collapses(self):
        ob = self.add([(-1, -1, 0), (1, -1, 0), (0, 1, 0)], [(0, 1, 2)])
        make_material(ob)
        ob.shape_key_add(name="Basis")
        key = ob.shape_key_add(name="collapse")
        for point in key.data:
            point.co = (0, 0, 0)
        for frame, value in ((1, 0.0), (2, 1.0)):
            key.value = value
            key.keyframe_insert("value", frame=frame)
        scene = bpy.context.scene
        scene.frame_start, scene.frame_end = 1, 2
        scene.render.engine, scene.relief.samples = "RELIEF", 1
        scene.render.filepath = str(self.folder / "f")
        for has_blur in (False, True):
            scene.render.use_motion_blur = has_blur
            bpy.ops.render.render(animation=True)
            self.assertIn(NO_AREA, self.report())

    def test_faces_with_a_point_that_is_not_finite_are_left_out(self):
        line = 'object "{}": faces with points that are not finite or too far away are left out: {}'
        for value in (math.nan, math.inf, 1e25):
            ob = self.add([(value, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)])
            self.check(line.format("bad", 1))
            bpy.data.objects.remove(ob)
        ob = make_grid(4)
        ob.name, ob.location.z = "holed", -0.001
        ob.data.vertices[0].co.x = math.nan
        for prepare in (lambda: None, lambda: make_material(ob), lambda: subdivide(ob, "CATMULL_CLARK", 1)):
            prepare()
            ours = self.check(line.format("holed", 1))
            self.assertTrue(np.all(np.isfinite(ours["Combined"])))

    def test_displaced_parts_beside_a_point_that_is_not_finite(self):
        ob = make_grid(4)
        ob.name, ob.location.z = "holed", -0.001
        ob.data.vertices[6].co.x = math.nan
        for _ in range(2):
            displace(make_material(ob), make_image("map", np.zeros((4, 4, 3), np.float32)))
        ob.data.polygons[1].material_index = 1
        ours = self.render("RELIEF", samples=2)
        self.assertTrue(np.all(np.isfinite(ours["Combined"])))
        self.assertLess(np.mean(ours.mask != self.plain.mask), 0.001)

    def test_a_crease_that_is_not_finite_is_the_sharpest(self):
        ob = make_grid(2)
        ob.name, ob.location.z = "creased", -0.001
        for point, value in ((0, math.inf), (4, math.nan)):
            attribute = ob.data.attributes.get("crease_vert") or ob.data.attributes.new("crease_vert", "FLOAT", "POINT")
            attribute.data[point].value = value
        subdivide(ob, "CATMULL_CLARK", 2)
        self.check()

    def test_uvs_that_are_not_finite(self):
        image = make_image("map", np.zeros((4, 4, 3), np.float32))
        for value in (math.nan, 1e9):
            ob = self.add([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)], uvs=[(0, 0), (value, 0), (0, 1)])
            ob.location.z = -0.001
            displace(make_material(ob), image)
            self.check('object "bad": uvs that are not finite or beyond 1e+06 are 0')
            bpy.data.objects.remove(ob)

    def test_further_uvs_that_are_not_finite(self):
        ob = make_grid(1)
        ob.data.uv_layers.new(name="other").uv[1].vector = (math.nan, 0)
        ob.data.vertices[0].co.x = math.nan
        arrays = mesh_arrays.read_mesh(ob.data, "UVMap", ("other",))
        self.assertIsNone(mesh_repair.repair(arrays, print))
        ob.data.vertices[0].co.x = -1
        lines = []
        arrays, _ = mesh_repair.repair(mesh_arrays.read_mesh(ob.data, "UVMap", ("other",)), lines.append)
        self.assertEqual(lines, ["uvs that are not finite or beyond 1e+06 are 0"])
        self.assertTrue(np.all(np.isfinite(arrays.further_uvs[0])))

    def test_transforms_that_are_not_finite(self):
        ob = self.add([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)])
        for name, value in (("scale", math.nan), ("location", math.inf)):
            setattr(ob, name, (value, 1, 1))
            self.check('object "bad": its transform is not finite: it is left out')
            setattr(ob, name, (1, 1, -0.5))

    def test_a_face_with_area_is_found_among_many_without(self):
        count = 3 * mesh_repair.CHUNK
        positions = np.zeros((3 * count + 4, 3), np.float32)
        positions[-4:] = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
        for sizes in (np.full(count, 3), np.append(np.full(count, 3), 4)):
            corners = np.arange(sizes.sum())
            arrays = MeshArrays(positions, sizes, corners, sizes * 0, positions[corners])
            self.assertEqual(mesh_repair.has_area(arrays), len(sizes) > count)

    def test_an_odd_camera_is_no_fault_of_the_add_on(self):
        scene = bpy.context.scene
        for prepare in (lambda: setattr(self.camera, "scale", (0, 0, 0)),
                        lambda: setattr(self.camera, "location", (math.nan, 0, 0)),
                        lambda: setattr(scene, "camera", bpy.data.objects["thing"])):
            prepare()
            with self.assertRaises(RuntimeError) as raised:
                self.render("RELIEF", samples=1)
            self.assertNotIn("fault of the add-on", str(raised.exception))


class Values(BlenderTest):
    def test_displacements_that_are_not_finite(self):
        ob = make_grid(1)
        material = make_material(ob)
        displace(material, make_image("map", np.ones((4, 4, 3), np.float32)))
        node = next(n for n in material.node_tree.nodes if n.bl_idname == "ShaderNodeVectorDisplacement")
        for name in ("Scale", "Midlevel"):
            node.inputs[name].default_value = math.nan
            self.render("RELIEF", samples=1)
            self.assertEqual(self.report(), ['material "material": displacement: a scale, midlevel or value that is not '
                                             'finite is not taken over'])
            node.inputs[name].default_value = 0

    def test_numbers_of_materials_that_are_not_finite(self):
        make_material(make_grid(1), Emission_Color=(1, 1, 1), Emission_Strength=math.inf, Roughness=math.nan)
        ours = self.render("RELIEF", samples=1)
        self.assertEqual(sorted(self.report()), [f'material "material": {name} is not finite: 0 is used'
                                                 for name in ("emission", "roughness")])
        self.assertTrue(np.all(np.isfinite(ours["Combined"])))

    def make_world(self, scale, kind="POINT"):
        scene = bpy.context.scene
        scene.render.film_transparent = False
        background = set_world(scene.world, (1, 1, 1))
        tree = scene.world.node_tree
        texture, mapping = tree.nodes.new("ShaderNodeTexEnvironment"), tree.nodes.new("ShaderNodeMapping")
        pixels = np.zeros((8, 16, 3), np.float32) + np.linspace(0.2, 1, 16)[None, :, None]
        texture.image = make_image("sky", pixels)
        mapping.vector_type = kind
        mapping.inputs["Scale"].default_value = scale
        tree.links.new(tree.nodes.new("ShaderNodeTexCoord").outputs["Generated"], mapping.inputs["Vector"])
        tree.links.new(mapping.outputs[0], texture.inputs["Vector"])
        tree.links.new(texture.outputs[0], background.inputs["Color"])

    def test_worlds_whose_mapping_has_a_scale_of_zero(self):
        for scale in ((0, 0, 0), (1, 1, 0), (0, 1, 1)):
            for kind in ("POINT", "TEXTURE"):
                self.make_world(scale, kind)
                with self.subTest(scale=scale, kind=kind):
                    self.compare_brightness(f"{scale}_{kind}", samples=4, tolerance=0.05)
                    self.assertNotIn("world", " ".join(self.report()))

    def test_worlds_that_are_not_finite(self):
        bpy.context.scene.render.film_transparent = False
        for name, value, text in (("Strength", math.inf, "not finite"), ("Color", (math.nan, 0, 0, 1), "not finite"),
                                  ("Strength", -1, "negative")):
            set_world(bpy.context.scene.world, (0.5, 0.5, 0.5)).inputs[name].default_value = value
            ours = self.render("RELIEF", samples=1)
            self.assertEqual(ours.brightness, 0)
            self.assertTrue([line for line in self.report() if line.startswith("world") and text in line])


if __name__ == "__main__":
    main()
