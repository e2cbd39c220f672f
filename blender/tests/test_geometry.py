"""Subdivision, instances, animation, cameras and the border: the same pictures as by Cycles."""
import unittest

import bpy
import numpy as np
from support import (BlenderTest, Layers, aim, displace, main, make_grid, make_hook, make_image, make_material, make_object,
                     set_world, subdivide, write_layers)

CUBE = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
CUBE_FACES = [(0, 1, 3, 2), (2, 3, 7, 6), (6, 7, 5, 4), (4, 5, 1, 0), (0, 2, 6, 4), (1, 5, 7, 3)]
FACE_UVS = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]


def make_cube():
    uvs = [((i % 3 + u) / 3, (i // 3 + v) / 2) for i in range(6) for u, v in FACE_UVS]
    return make_object(CUBE, CUBE_FACES, uvs)


def set_creases(mesh, edges=(), points=()):
    """edges: pairs of points with a crease in [0, 1]; points likewise."""
    edge = mesh.attributes.new("crease_edge", "FLOAT", "EDGE")
    for (a, b), value in edges:
        index = next(e.index for e in mesh.edges if set(e.vertices) == {a, b})
        edge.data[index].value = value
    point = mesh.attributes.new("crease_vert", "FLOAT", "POINT")
    for index, value in points:
        point.data[index].value = value


class Geometry(BlenderTest):
    def test_subdivision_with_creases(self):
        ob = make_cube()
        set_creases(ob.data, [((0, 1), 1.0), ((1, 3), 1.0), ((3, 2), 1.0), ((2, 0), 1.0), ((5, 7), 0.6)], [(6, 1.0)])
        make_material(ob)
        subdivide(ob, "CATMULL_CLARK", 5)
        ours, theirs = self.compare()
        ob.modifiers[0].use_creases = False
        plain = self.render("RELIEF", "plain")
        self.assertGreater(np.mean(ours.mask != plain.mask), 0.01, "creases change nothing")

    @unittest.skipIf(bpy.app.version < (4, 3), "adaptive surfaces of Cycles 4.2 differ from its own uniform ones")
    def test_displaced_subdivision_with_creases_adaptively(self):
        ob = make_cube()
        set_creases(ob.data, [((0, 1), 0.5), ((1, 3), 0.5), ((3, 2), 0.5), ((2, 0), 0.5)])
        height = np.repeat(make_hook()[..., 1:2], 3, -1)
        displace(make_material(ob), make_image("height", height), "HEIGHT", 0.5)
        subdivide(ob, "CATMULL_CLARK", 2, adaptive=True)
        self.compare()

    def test_an_open_boundary(self):
        for smooth in ("ALL", "PRESERVE_CORNERS"):
            ob = make_grid(2, lambda u, v: (2 * u - 1, 2 * v - 1, 0.8 * np.sin(6 * u)))
            make_material(ob)
            subdivide(ob, "CATMULL_CLARK", 5).boundary_smooth = smooth
            self.compare(smooth.lower())
            bpy.data.objects.remove(ob)

    def test_simplify_limits_the_levels_of_subdivisions(self):
        ob, render = make_cube(), bpy.context.scene.render
        make_material(ob)
        subdivide(ob, "CATMULL_CLARK", 5)
        for level in (0, 1, 5):
            render.use_simplify, render.simplify_subdivision_render = True, level
            ours, _ = self.compare(f"level{level}")
            if level == 0:
                cube = ours
        self.assertGreater(np.mean(ours.mask != cube.mask), 0.03)
        ob.modifiers[0].render_levels = 0
        self.compare("none")

    @unittest.skipIf(bpy.app.version < (4, 3), "adaptive surfaces of Cycles 4.2 differ from its own uniform ones")
    def test_simplify_of_adaptive_subdivisions(self):
        ob, render = make_cube(), bpy.context.scene.render
        make_material(ob)
        subdivide(ob, "CATMULL_CLARK", 3, adaptive=True)
        for level in (0, 1):
            render.use_simplify, render.simplify_subdivision_render = True, level
            self.compare(f"level{level}")

    def test_modifiers_below_the_subdivision_are_applied(self):
        ob = make_cube()
        make_material(ob)
        array = ob.modifiers.new("array", "ARRAY")
        array.count, array.relative_offset_displace = 2, (0.7, 0.3, 0.2)
        subdivide(ob, "CATMULL_CLARK", 4)
        ob.scale = (0.6, 0.6, 0.6)
        self.compare()

    def test_instances_of_a_collection_and_of_geometry_nodes(self):
        ob = make_grid(64)
        displace(make_material(ob), make_image("hook", make_hook()))
        subdivide(ob, levels=1)
        collection = bpy.data.collections.new("many")
        bpy.context.scene.collection.objects.unlink(ob)
        collection.objects.link(ob)
        for i in range(3):
            empty = bpy.data.objects.new(f"empty {i}", None)
            empty.instance_type, empty.instance_collection = "COLLECTION", collection
            empty.location, empty.rotation_euler, empty.scale = (1.6 * i - 1.6, 0.3 * i, 0.2 * i), (0.1 * i, 0, i), [0.6] * 3
            bpy.context.scene.collection.objects.link(empty)
        self._scatter(ob)
        self.compare()
        self.assertEqual(self._count_meshes(), 2, "a mesh of the plane, one of the empty carrier")

    def _count_meshes(self):
        from relief_blender.report import Report
        from relief_blender.scene_export import SceneExport
        scene = SceneExport(bpy.context.evaluated_depsgraph_get(), Report()).run()
        self.assertEqual(len(scene.objects), 8)
        return len(scene.meshes)

    def _scatter(self, ob):
        """Geometry nodes that put the object at the points of a quad."""
        carrier = make_object([(-2, 1.5, -0.5), (2, 1.5, -0.5), (2, 1.5, 1), (-2, 1.5, 1)], [(0, 1, 2, 3)], name="carrier")
        tree = bpy.data.node_groups.new("scatter", "GeometryNodeTree")
        tree.interface.new_socket("Geometry", in_out="INPUT", socket_type="NodeSocketGeometry")
        tree.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
        nodes = tree.nodes
        start, end = nodes.new("NodeGroupInput"), nodes.new("NodeGroupOutput")
        info, put, join = nodes.new("GeometryNodeObjectInfo"), nodes.new("GeometryNodeInstanceOnPoints"), nodes.new(
            "GeometryNodeJoinGeometry")
        info.inputs["Object"].default_value, info.inputs["As Instance"].default_value = ob, True
        put.inputs["Scale"].default_value = (0.3, 0.3, 0.3)
        tree.links.new(start.outputs[0], put.inputs["Points"])
        tree.links.new(info.outputs["Geometry"], put.inputs["Instance"])
        tree.links.new(put.outputs[0], join.inputs[0])
        tree.links.new(start.outputs[0], join.inputs[0])
        tree.links.new(join.outputs[0], end.inputs[0])
        carrier.modifiers.new("scatter", "NODES").node_group = tree

    def test_two_frames_of_an_animation(self):
        ob = make_grid(64)
        material = make_material(ob)
        displace(material, make_image("hook", make_hook()))
        subdivide(ob, levels=1)
        ob.keyframe_insert("rotation_euler", frame=1)
        ob.rotation_euler = (0.3, 0.2, 1.2)
        ob.keyframe_insert("rotation_euler", frame=2)
        node = next(n for n in material.node_tree.nodes if n.bl_idname == "ShaderNodeVectorDisplacement")
        for frame, scale in ((1, 1.0), (2, 0.5)):
            node.inputs["Scale"].default_value = scale
            node.inputs["Scale"].keyframe_insert("default_value", frame=frame)
        masks = []
        for frame in (1, 2):
            bpy.context.scene.frame_set(frame)
            masks.append(self.compare(f"frame{frame}")[0].mask)
        self.assertGreater(np.mean(masks[0] != masks[1]), 0.05, "nothing moves")

    def test_an_animation_render_writes_each_frame(self):
        ob = make_grid(2)
        ob.keyframe_insert("location", frame=1)
        ob.location = (0, 0, 1.5)
        ob.keyframe_insert("location", frame=2)
        scene = bpy.context.scene
        strength = set_world(scene.world, (1, 1, 1)).inputs["Strength"]
        for frame, value in ((1, 0.0), (2, 1.0)):
            strength.default_value = value
            strength.keyframe_insert("default_value", frame=frame)
        scene.frame_start, scene.frame_end, scene.render.engine = 1, 2, "RELIEF"
        write_layers(scene, self.folder / "frame_####.exr")
        scene.relief.samples = 2
        bpy.ops.render.render(animation=True)
        first, second = (Layers(self.folder / f"frame_000{i}.exr") for i in (1, 2))
        self.assertGreater(np.mean(first.mask != second.mask), 0.02)
        self.assertEqual(first.brightness, 0)
        self.assertGreater(second.brightness, 0.01)

    def test_lens_shift_sensor_fit_and_border(self):
        make_material(make_cube())
        data, render = self.camera.data, bpy.context.scene.render
        data.shift_x, data.shift_y, data.sensor_fit, data.lens = 0.137, -0.0711, "VERTICAL", 30
        self.compare("shift")
        render.use_border, render.use_crop_to_border = True, True
        render.border_min_x, render.border_max_x, render.border_min_y, render.border_max_y = 0.1, 0.7, 0.3, 0.9
        ours, theirs = self.compare("border", mask_share=0.008)
        self.assertEqual(ours.mask.shape, theirs.mask.shape)
        render.use_crop_to_border = False
        self.compare("window")

    def test_an_orthographic_view_is_nearly_one_and_named(self):
        make_material(make_cube())
        self.camera.data.type, self.camera.data.ortho_scale = "ORTHO", 5
        for name, place, target in (("even", (0, -6, 3), (0, 0, 0)), ("uneven", (2.1, -6.1, 0.37), (0.03, 0, 0.1))):
            aim(self.camera, place, target)
            self.compare(name)
        self.assertTrue(any("orthographic" in line for line in self.report()), self.report())

    def test_depth_of_field(self):
        make_material(make_cube())
        self.camera.data.dof.use_dof = True
        self.camera.data.dof.focus_distance, self.camera.data.dof.aperture_fstop = 3.0, 0.05
        ours, theirs = (self.render(engine, samples=64)["Combined"][..., 3] for engine in ("RELIEF", "CYCLES"))
        self.assertGreater(np.mean((ours > 0.05) & (ours < 0.95)), 0.05, "nothing is out of focus")
        self.assertLess(np.abs(ours - theirs).mean(), 0.012)

    def test_curves_and_text_are_meshes(self):
        bpy.ops.object.text_add()
        bpy.context.object.data.body, bpy.context.object.data.extrude = "Relief", 0.1
        bpy.context.object.location = (-1, 0, 0)
        bpy.ops.mesh.primitive_torus_add(location=(0, 1, 0.5))
        self.compare()

    def test_passes_have_the_names_that_cycles_gives_them(self):
        make_material(make_grid(2))
        for name in ("z", "position", "normal", "uv", "diffuse_color", "emit", "environment"):
            setattr(bpy.context.view_layer, f"use_pass_{name}", True)
        self.assertEqual(self.render("RELIEF").names, self.render("CYCLES").names)

    def test_passes(self):
        make_material(make_cube())
        layer = bpy.context.view_layer
        layer.use_pass_normal = layer.use_pass_uv = layer.use_pass_cryptomatte_object = True
        ours, theirs = self.compare()
        inner = (ours["Combined"][..., 3] == 1) & (theirs["Combined"][..., 3] == 1)
        for name, most in (("Position", 0.05), ("UV", 0.05)):
            error = np.abs(ours[name] - theirs[name])[inner].max(-1)
            self.assertLess(np.quantile(error, 0.9), most, name)
        self.assertEqual({1}, set(np.unique(np.round(ours["CryptoObject00"][..., 1][inner], 3))))
        self.assertEqual(len(np.unique(np.concatenate([ours["CryptoObject00"][..., 0][inner],
                                                       theirs["CryptoObject00"][..., 0][inner]]))), 1)

    def test_a_moved_camera_in_a_far_place(self):
        ob = make_grid(64)
        ob.location = (1000, -2000, 500)
        displace(make_material(ob), make_image("hook", make_hook()))
        subdivide(ob, levels=1)
        aim(self.camera, (1004, -2004, 503), (1000, -2000, 500))
        self.compare()


if __name__ == "__main__":
    main()
