"""What a file may hold that is not an ordinary scene: it is rendered as by Cycles, or left out and named."""
from support import (BlenderTest, add_light, main, make_grid, make_image, make_material,  # first: it makes the
                     set_world, subdivide)  # add-on known
import math
from unittest import mock

import bpy
import numpy as np
import relief
from relief_blender import engine
from test_geometry import make_cube, set_creases
from relief_blender.remedies import translate
from relief_blender.report import Report
from relief_blender.scene_export import SceneExport


def export_moving(test, socket, last):
    """The relief.Scene of a render with motion blur while a socket goes from 0 to a value, without the render itself."""
    scene = bpy.context.scene
    for frame, value in ((0, 0.0), (2, last)):
        socket.default_value = value
        socket.keyframe_insert("default_value", frame=frame)
    scene.frame_set(1)
    scene.render.use_motion_blur, scene.render.motion_blur_shutter = True, 1.0
    with mock.patch.object(engine, "RenderJob", side_effect=relief.Error("enough")) as job, test.assertRaises(RuntimeError):
        test.render("RELIEF")
    return job.call_args.args[0]


class Modes(BlenderTest):
    def check_in_edit_mode(self, ob):
        """In Edit Mode an object is seen as it was before, by Cycles too."""
        before = self.render("RELIEF", "before", samples=4)
        bpy.context.view_layer.objects.active = ob
        bpy.ops.object.mode_set(mode="EDIT")
        try:
            ours, theirs = self.render("RELIEF", "edit", samples=4), self.render("CYCLES", "edit", samples=4)
        finally:
            bpy.ops.object.mode_set(mode="OBJECT")
        self.assertGreater(before.mask.mean(), 0.03)
        for other in (before, theirs):
            self.assertLess(np.mean(ours.mask != other.mask), 0.01)
        self.assertEqual(self.report(), [])

    def test_a_mesh_in_edit_mode_is_seen(self):
        ob = make_grid(2)
        make_material(ob)
        self.check_in_edit_mode(ob)

    def test_modifiers_of_a_mesh_in_edit_mode_are_applied(self):
        ob = make_grid(2)
        make_material(ob)
        ob.scale = (0.5, 0.5, 0.5)
        ob.modifiers.new("array", "ARRAY")
        self.check_in_edit_mode(ob)

    def test_a_subdivision_of_two_materials_in_edit_mode_is_seen(self):
        ob = make_grid(2)
        make_material(ob), make_material(ob)
        ob.data.polygons[1].material_index = 1
        ob.modifiers.new("subdivision", "SUBSURF")
        self.check_in_edit_mode(ob)


class Materials(BlenderTest):
    def export(self):
        exporter = SceneExport(bpy.context.evaluated_depsgraph_get(), Report())
        return exporter.run()

    def test_a_material_called_default_is_not_that_of_objects_without_one(self):
        for names in (("with", "without"), ("without", "with")):  # whichever is taken over first
            for name in names:
                ob = make_grid(1)
                ob.name = name
                if name == "with":
                    make_material(ob, Base_Color=(1, 0, 0)).name = "default"
            scene = self.export()
            colors = {o["name"]: scene.materials[o["material"]]["base_color"] for o in scene.objects}
            np.testing.assert_allclose(colors["with"], [1, 0, 0], atol=1e-6)
            np.testing.assert_allclose(colors["without"], [0.8, 0.8, 0.8], atol=1e-6)
            for ob in [bpy.data.objects[name] for name in names]:
                bpy.data.objects.remove(ob)
            bpy.data.materials.remove(bpy.data.materials["default"])

    def add_normal_map(self, material):
        tree = material.node_tree
        node, texture = tree.nodes.new("ShaderNodeNormalMap"), tree.nodes.new("ShaderNodeTexImage")
        texture.image = make_image("normals", np.full((4, 4, 3), (0.8, 0.5, 0.8)))
        tree.links.new(texture.outputs["Color"], node.inputs["Color"])
        tree.links.new(node.outputs[0], tree.nodes["Principled BSDF"].inputs["Normal"])

    def test_a_normal_map_on_a_mesh_without_uvs_is_left_out(self):
        ob = make_grid(2)
        ob.data.uv_layers.remove(ob.data.uv_layers[0])
        material = make_material(ob, Roughness=1.0)
        self.add_normal_map(material)
        add_light("SUN", (3, 0, 3), energy=3.0)
        ours = self.render("RELIEF").brightness
        self.assertEqual(self.report(), ['object "thing": it has no uv map: its normal map is left out'])
        tree = material.node_tree
        tree.links.remove(tree.nodes["Principled BSDF"].inputs["Normal"].links[0])
        self.assertAlmostEqual(self.render("RELIEF").brightness, ours, delta=1e-5)
        self.add_normal_map(material)
        other = make_grid(2)  # keeps it
        other.location.z, other.name = 0.5, "other"
        other.data.materials.append(material)
        scene = self.export()
        self.assertEqual({o["name"]: "geometry_normal" in scene.materials[o["material"]] for o in scene.objects},
                         {"thing": False, "other": True})

    def test_materials_without_their_normal_map_move(self):
        ob = make_grid(2)
        ob.data.uv_layers.remove(ob.data.uv_layers[0])
        material = make_material(ob)
        self.add_normal_map(material)
        socket = material.node_tree.nodes["Principled BSDF"].inputs["Roughness"]
        exported = export_moving(self, socket, 1.0)
        self.assertIn("keys", exported.materials[exported.objects[0]["material"]]["roughness"])


class ViewLayers(BlenderTest):
    def check_colors(self):
        """Both renderers have the same mean colour."""
        ours, theirs = (self.render(engine, samples=16)["Combined"][..., :3].mean((0, 1)) for engine in ("RELIEF", "CYCLES"))
        np.testing.assert_allclose(ours, theirs, rtol=0.04)
        self.assertEqual(self.report(), [])
        return ours

    def test_a_material_override(self):
        ob = make_grid(2)
        for color in ((1, 0, 0), (0, 0, 1)):
            make_material(ob, Base_Color=color)
        ob.data.polygons[1].material_index = 1
        other = make_grid(2)
        other.location.z, other.scale = 0.5, (0.3, 0.3, 0.3)
        bpy.context.view_layer.material_override = make_material(Base_Color=(0, 0.8, 0), Specular_IOR_Level=0.0)
        color = self.check_colors()
        self.assertLess(max(color[0], color[2]), 0.02 * color[1])

    def test_a_world_override(self):
        scene, layer = bpy.context.scene, bpy.context.view_layer
        make_material(make_grid(2))
        scene.render.film_transparent = False
        layer.world_override = bpy.data.worlds.new("other")
        background = set_world(layer.world_override, (1, 0.2, 0.1))
        color = self.check_colors()
        self.assertGreater(color[0], 3 * color[1])
        strength = background.inputs["Strength"]
        self.assertIn("keys", export_moving(self, strength, 2.0).environment["strength"])

    def test_collections_that_are_held_out_or_indirect_are_named(self):
        scene, layer = bpy.context.scene, bpy.context.view_layer
        collection = bpy.data.collections.new("own")
        scene.collection.children.link(collection)
        ob, empty = make_grid(2), bpy.data.objects.new("empty", None)
        scene.collection.objects.unlink(ob)
        collection.objects.link(empty)
        source = bpy.data.collections.new("source")
        source.objects.link(ob)
        empty.instance_type, empty.instance_collection = "COLLECTION", source
        for text, is_seen, attribute in (("holdout is left out: it is seen", True, "holdout"),
                                         ("its collection is Indirect Only: it is left out, its shadows and reflections too",
                                          False, "indirect_only")):
            own = layer.layer_collection.children["own"]
            setattr(own, attribute, True)
            ours = self.render("RELIEF", samples=1)
            self.assertIn(f'object "thing": {text}', self.report())
            self.assertEqual(ours.mask.any(), is_seen)
            setattr(own, attribute, False)

    def test_the_range_of_the_camera_is_named_where_it_cuts(self):
        make_grid(2).scale = (0.5, 0.5, 0.5)
        data = self.camera.data
        start, end = (f'camera "camera": its clip {name} is left out: what is {place} is seen'
                      for name, place in (("start", "nearer"), ("end", "farther away")))
        for kind in ("PERSP", "ORTHO"):
            data.type = kind
            for clip_start, clip_end, lines in ((0.1, 1000, []), (6.5, 1000, [start] if kind == "PERSP" else []),
                                                (0.1, 6.6, [end]), (8, 1000, [start])):
                data.clip_start, data.clip_end = clip_start, clip_end
                self.render("RELIEF", samples=1)
                named = [line for line in self.report() if "clip" in line]
                self.assertEqual(named, lines, (kind, clip_start, clip_end))


class Creases(BlenderTest):
    def test_creases_along_edges_without_a_face_are_left_out(self):
        ob = make_cube()
        loose = [len(ob.data.vertices) + k for k in range(2)]
        ob.data.vertices.add(2)
        ob.data.edges.add(1)
        ob.data.edges[-1].vertices = (0, loose[0])
        ob.data.update()
        make_material(ob)
        set_creases(ob.data, [((0, 1), 1.0), ((1, 3), 1.0), ((0, loose[0]), 1.0)], [(loose[1], 1.0), (7, 1.0)])
        modifier = subdivide(ob, "CATMULL_CLARK", 4)
        self.compare(samples=4)
        self.assertEqual(self.report(), ['object "thing": creases that are not along an edge of a face are left out'])
        modifier.use_creases = False  # the point of the loose edge stays sharp
        self.compare("plain", samples=4)
        self.assertEqual(self.report(), [])


class Lights(BlenderTest):
    def setUp(self):
        super().setUp()
        ground = make_grid(1)
        ground.scale = (3, 3, 1)
        make_material(ground)

    def test_a_spot_of_180_degrees(self):
        set_world(bpy.context.scene.world, (0, 0, 0))
        light = add_light("SPOT", (0.5, 0, 2), energy=300.0)
        light.data.spot_size, light.data.shadow_soft_size = math.pi, 0.1
        self.compare_brightness(tolerance=0.04)

    def check_left_out(self, kind, text, prepare):
        plain = self.render("RELIEF", samples=1).brightness
        light = add_light(kind)
        prepare(light)
        with self.subTest(kind=kind, text=text):
            self.assertAlmostEqual(self.render("RELIEF", samples=1).brightness, plain, delta=1e-5)
            self.assertEqual(self.report(), [f'light "light": {text}: it is left out'])
        bpy.data.objects.remove(light)
        bpy.data.lights.remove(bpy.data.lights["light"])

    def test_lights_that_cannot_be_rendered_are_left_out(self):
        def scale(*scales):
            return lambda light: setattr(light, "scale", scales)

        def shape(name):
            return lambda light: (setattr(light.data, "shape", name), setattr(light.data, "size", 0))
        self.check_left_out("SUN", "it has no direction by its scale", scale(0, 0, 0))
        self.check_left_out("SPOT", "it has no direction by its scale", scale(1, 1, 0))
        self.check_left_out("AREA", "its face has no area", scale(0, 0, 0))
        self.check_left_out("AREA", "its face has no area", shape("SQUARE"))
        self.check_left_out("AREA", "its face has no area", shape("DISK"))
        not_finite = "its power, colour, size or transform is not finite"
        self.check_left_out("POINT", not_finite, lambda light: setattr(light.data, "energy", math.inf))
        self.check_left_out("POINT", not_finite, lambda light: setattr(light, "location", (math.nan, 0, 0)))

    def test_a_light_without_power_or_size_at_the_end_of_the_shutter(self):
        scene = bpy.context.scene
        for name, least, text in (("scale", (0, 0, 0), ""), ("location", (0, 0, math.inf), "not finite meanwhile")):
            light = add_light("AREA")
            for frame in (2, 3):
                setattr(light, name, getattr(light, name) if frame == 2 else least)
                light.keyframe_insert(name, frame=frame)
            scene.frame_set(2)
            scene.render.use_motion_blur, scene.render.motion_blur_shutter = True, 2.0
            with self.subTest(name=name):
                self.render("RELIEF", samples=1)
                self.assertIn(text, " ".join(self.report()))
            bpy.data.objects.remove(light)


class Volumes(BlenderTest):
    def add_fog(self):
        """A box around all that has a volume alone, as fog is made."""
        box = make_cube()
        box.name, box.scale = "fog", (20, 20, 20)
        material = make_material(box)
        tree = material.node_tree
        tree.nodes.clear()
        output, scatter = tree.nodes.new("ShaderNodeOutputMaterial"), tree.nodes.new("ShaderNodeVolumeScatter")
        scatter.inputs["Density"].default_value = 0.0
        tree.links.new(scatter.outputs[0], output.inputs["Volume"])
        return material, output

    def test_a_fog_box_is_left_out_and_named(self):
        make_material(make_grid(2))
        material, output = self.add_fog()
        self.compare_brightness()
        line = f'object "fog": material "{material.name}" has a volume and no surface: its faces are left out'
        self.assertIn(line, self.report())
        clear = self.render("RELIEF", samples=2).brightness
        diffuse = material.node_tree.nodes.new("ShaderNodeBsdfDiffuse")
        material.node_tree.links.new(diffuse.outputs[0], output.inputs["Surface"])
        self.assertLess(self.render("RELIEF", samples=2).brightness, 0.5 * clear)
        self.assertNotIn(line, self.report())

    def test_a_material_without_anything_stays_black(self):
        material = make_material(make_grid(2), Base_Color=(1, 1, 1))
        plain = self.render("RELIEF", samples=2)
        material.node_tree.nodes.clear()
        material.node_tree.nodes.new("ShaderNodeOutputMaterial")
        ours = self.render("RELIEF", samples=2)
        self.assertEqual(np.mean(ours.mask != plain.mask), 0)
        self.assertLess(ours["Combined"][..., :3][ours.mask].mean(), 0.01)


class Named(BlenderTest):
    """What would be another picture without a word."""

    def setUp(self):
        super().setUp()
        make_material(make_grid(2))

    def check(self, *lines):
        self.render("RELIEF", samples=1)
        self.assertEqual(self.report(), list(lines))

    def test_a_portal_gives_no_light(self):
        light = add_light("AREA", (0, 0, 3), energy=300.0)
        light.data.cycles.is_portal = True
        self.compare_brightness()
        self.assertEqual(self.report(), [
            f'light "{light.name}": a portal gives no light of its own: it is left out, and guides no rays to the world'])

    def test_ray_visibility_of_lights_and_worlds(self):
        light = add_light("POINT")
        light.visible_diffuse = light.visible_glossy = False
        bpy.context.scene.world.cycles_visibility.camera = False
        bpy.context.scene.world.cycles_visibility.diffuse = False
        self.check(f'light "{light.name}": ray visibility (diffuse, glossy) is left out: it lights all',
                   'world "world": ray visibility (camera, diffuse) is left out: all rays see it')

    def test_the_exposure_of_the_film(self):
        bpy.context.scene.cycles.film_exposure = 4
        self.check("scene: Film > Exposure 4 of Cycles is left out: Color Management > Exposure 2 does the same to what is shown")

    def test_passes_that_are_not_made(self):
        layer = bpy.context.view_layer
        layer.use_pass_mist = layer.use_pass_diffuse_direct = layer.cycles.denoising_store_passes = True
        layer.cycles.use_pass_shadow_catcher = layer.cycles.use_pass_volume_direct = True
        layer.aovs.add().name = "mask"
        layer.lightgroups.add(name="key")
        self.render("RELIEF", samples=1)
        lines = self.report()
        for name in ("the pass Mist", "the pass Diffuse Direct", "the pass Denoising Data", "the pass Shadow Catcher",
                     "the pass Volume Direct", 'the pass of the shader AOV "mask"', 'the pass of the light group "key"'):
            self.assertIn(f"scene: {name} is not made", lines)
        self.assertEqual(len(lines), 7, lines)


class Remedies(BlenderTest):
    def test_warnings_name_what_blender_has(self):
        for given, wanted in (
                ("x; write displacement.axes = t,b,n, as presets blender-brush, genvdm, 3dcoat",
                 "x; put Separate Color and Combine Color between the image and the displacement node: Red from Red, "
                 "Green from Blue, Blue from Green"),
                ("write axes = -b,t,n", "put Separate Color and Combine Color between the image and the displacement node: "
                 "Red from Green, Green from Blue, Blue from minus Red"),
                ("y; write displacement.space = object, or inspect the map",
                 "y; set Space of the node Vector Displacement to Object Space"),
                ("or write displacement.wrap = repeat", "or set Extension of the node Image Texture to Repeat"),
                ("set displacement.axes to an order with B along n: the values do not show which of the other two is along t "
                 "(presets blender-brush, genvdm, 3dcoat write t,b,n)",
                 "put Separate Color and Combine Color between the image and the displacement node: Green from Blue, Red and "
                 "Blue from the other two"),
                ("mesh 'a' is fine", "mesh 'a' is fine")):
            self.assertEqual(translate(given), wanted)

    def test_a_sculpted_brush_in_another_order_is_told_in_words_of_blender(self):
        with mock.patch.object(engine.ReliefEngine, "_show"):
            ob = make_grid(2)
            make_material(ob)
            picture = mock.Mock(warnings=["write displacement.axes = t,b,n"], statistics={})
            own = mock.Mock(_report=Report(), _views={"": None})
            engine.ReliefEngine._finish(own, picture, mock.Mock(), "")
            self.assertIn("Separate Color", own._report.lines[0])


if __name__ == "__main__":
    main()
