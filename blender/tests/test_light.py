"""Lights, worlds and materials: as bright as by Cycles."""
import math
import unittest

import bpy
import numpy as np
from support import (BlenderTest, add_light, main, make_grid, make_image, make_material, set_world)


def make_ball(radius=1.0):
    def place(u, v):
        a, b = 2 * np.pi * u, np.pi * (np.clip(v, 1e-3, 1 - 1e-3) - 0.5)
        return radius * np.cos(a) * np.cos(b), radius * np.sin(a) * np.cos(b), radius * np.sin(b)
    return make_grid(96, place, (True, False))


def make_diffuse(ob, color=(0.6, 0.6, 0.6)):
    """Lambert's law alone, so that a light is all that differs."""
    material = bpy.data.materials.new("diffuse")
    material.use_nodes = True
    tree = material.node_tree
    node = tree.nodes.new("ShaderNodeBsdfDiffuse")
    node.inputs["Color"].default_value = (*color, 1)
    tree.links.new(node.outputs[0], tree.get_output_node("ALL").inputs["Surface"])
    ob.data.materials.append(material)


class Lights(BlenderTest):
    def setUp(self):
        super().setUp()
        set_world(bpy.context.scene.world, (0, 0, 0))
        ground, ball = make_grid(4), make_ball(0.4)
        ground.scale, ball.location = (3, 3, 1), (0.3, -0.5, 0.4)
        for ob in (ground, ball):
            make_diffuse(ob)

    def test_a_sun(self):
        for name, angle in (("sharp", 0.0), ("wide", 0.6)):
            light = add_light("SUN", (2, 1, 3), energy=2.0)
            light.data.angle, light.data.color = angle, (1, 0.7, 0.4)
            ours, theirs = self.compare_brightness(name)
            ratio = ours["Combined"][..., :3].mean((0, 1)) / theirs["Combined"][..., :3].mean((0, 1))
            np.testing.assert_allclose(ratio, 1, atol=0.02)
            bpy.data.objects.remove(light)

    def test_a_point(self):
        for name, radius in (("small", 0.0), ("large", 0.5)):
            light = add_light("POINT", (0.8, 0.5, 2), energy=150.0)
            light.data.shadow_soft_size, light.data.use_soft_falloff = radius, False
            self.compare_brightness(name)
            bpy.data.objects.remove(light)

    def test_a_spot(self):
        for name, size, blend, radius in (("hard", 0.7, 0.0, 0.0), ("soft", 1.0, 0.7, 0.0), ("large", 1.2, 0.4, 0.3)):
            light = add_light("SPOT", (1, 1, 3), energy=300.0)
            light.data.spot_size, light.data.spot_blend, light.data.shadow_soft_size = size, blend, radius
            light.data.use_soft_falloff = False
            self.compare_brightness(name)
            bpy.data.objects.remove(light)

    def test_areas_of_each_shape(self):
        for shape in ("SQUARE", "RECTANGLE", "DISK", "ELLIPSE"):
            light = add_light("AREA", (1, 0.5, 2), energy=120.0)
            light.data.shape, light.data.size, light.data.size_y = shape, 1.2, 0.4
            light.scale = (1.5, 1, 1)
            self.compare_brightness(shape.lower())
            bpy.data.objects.remove(light)

    @unittest.skipIf(bpy.app.version < (4, 4), "lights have no exposure")
    def test_exposure_temperature_and_nodes_of_a_light(self):
        light = add_light("AREA", (1, 0.5, 2), energy=60.0)
        light.data.exposure, light.data.use_temperature, light.data.temperature = 1.0, True, 3000
        light.data.use_nodes = True
        emission = next(n for n in light.data.node_tree.nodes if n.bl_idname == "ShaderNodeEmission")
        emission.inputs["Color"].default_value, emission.inputs["Strength"].default_value = (0.5, 0.9, 1, 1), 0.7
        self.compare_brightness()

    @unittest.skipIf(bpy.app.version < (4, 4), "all lights are normalized")
    def test_a_light_that_is_not_normalized(self):
        for kind in ("AREA", "POINT", "SPOT", "SUN"):
            light = add_light(kind, (1, 0.5, 2), energy=20.0)
            light.data.normalize = False
            if kind == "SUN":
                light.data.angle, light.data.energy = 0.5, 4.0
            elif kind != "AREA":
                light.data.shadow_soft_size, light.data.use_soft_falloff = 0.4, False
            self.compare_brightness(kind.lower())
            bpy.data.objects.remove(light)

    def test_a_light_that_the_camera_sees(self):
        light = add_light("AREA", (0, 1.5, 1), (0, -6, 3), energy=50.0)
        light.visible_camera = True
        ours, theirs = self.compare_brightness()
        self.assertGreater(ours["Combined"][..., 0].max(), 5)
        self.assertLess(np.mean(ours.mask != theirs.mask), 0.02)

    def test_a_mesh_that_emits(self):
        panel = make_grid(1)
        panel.location, panel.scale, panel.rotation_euler = (0.5, 0.5, 2), (0.4, 0.4, 1), (math.pi, 0, 0)
        make_material(panel, Emission_Color=(1, 0.8, 0.6), Emission_Strength=20.0)
        self.compare_brightness()


class Worlds(BlenderTest):
    def setUp(self):
        super().setUp()
        bpy.context.scene.render.film_transparent = False
        make_diffuse(make_ball())
        self.background = set_world(bpy.context.scene.world, (1, 1, 1))
        texels = np.full((64, 128, 3), 0.05, np.float32)
        texels[10:20, 20:40], texels[20:40, 80:100] = (8, 4, 2), (0.5, 2, 6)
        tree = bpy.context.scene.world.node_tree
        self.texture = tree.nodes.new("ShaderNodeTexEnvironment")
        self.texture.image = make_image("sky", texels)
        tree.links.new(self.texture.outputs["Color"], self.background.inputs["Color"])

    def check(self, name="picture"):
        """Brightness, and that each part of the picture, background included, is the same."""
        ours, theirs = self.compare_brightness(name)
        means = [layers["Combined"][:144, :, :3].reshape(12, 12, 10, 20, 3).mean((1, 3)) for layers in (ours, theirs)]
        np.testing.assert_allclose(*means, rtol=0.1, atol=0.02)

    def add_mapping(self, kind="POINT", **inputs):
        tree = bpy.context.scene.world.node_tree
        mapping, coordinates = tree.nodes.new("ShaderNodeMapping"), tree.nodes.new("ShaderNodeTexCoord")
        mapping.vector_type = kind
        for name, value in inputs.items():
            mapping.inputs[name].default_value = value
        tree.links.new(coordinates.outputs["Generated"], mapping.inputs["Vector"])
        tree.links.new(mapping.outputs[0], self.texture.inputs["Vector"])

    def test_a_picture(self):
        self.background.inputs["Strength"].default_value = 0.7
        self.check()

    def test_a_picture_turned_about_the_vertical(self):
        self.add_mapping(Rotation=(0, 0, 0.8))
        self.check()

    def test_a_picture_turned_about_all_axes(self):
        self.add_mapping(Rotation=(0.4, -0.7, 1.1))
        self.check()

    def test_a_texture_mapping(self):
        self.add_mapping("TEXTURE", Rotation=(0.3, 0.2, -0.6))
        self.check()

    def test_a_mirror_ball(self):
        self.texture.projection = "MIRROR_BALL"
        self.check()

    def test_a_picture_from_a_file(self):
        image = self.texture.image
        image.filepath_raw, image.file_format = str(self.folder / "sky.exr"), "OPEN_EXR"
        image.save()
        self.texture.image = bpy.data.images.load(str(self.folder / "sky.exr"))
        self.check()


class Principled(BlenderTest):
    """Under a uniform sky, and a sun where that leaves little noise."""

    def setUp(self):
        super().setUp()
        set_world(bpy.context.scene.world, (0.7, 0.8, 1.0))
        add_light("SUN", (2, -3, 4), energy=2.0)

    def check(self, has_sun=True, tolerance=0.02, **inputs):
        if not has_sun:
            bpy.data.objects.remove(bpy.data.objects["light"])
        make_material(make_ball(), **inputs)
        return self.compare_brightness(tolerance=tolerance)

    def test_the_default(self):
        self.check()

    def test_colours_and_roughness(self):
        self.check(Base_Color=(0.7, 0.3, 0.1), Roughness=0.2)

    def test_a_rough_metal(self):
        self.check(Base_Color=(0.9, 0.6, 0.3), Metallic=1.0, Roughness=0.4)

    def test_half_a_metal(self):
        self.check(Base_Color=(0.9, 0.6, 0.3), Metallic=0.5, Roughness=0.5)

    def test_a_smooth_metal(self):
        self.check(False, Metallic=1.0, Roughness=0.05, Base_Color=(0.5, 0.5, 0.5))

    def test_ior_and_specular_level(self):
        self.check(IOR=1.8, Specular_IOR_Level=0.8, Base_Color=(0.1, 0.1, 0.1))

    def test_no_specular(self):
        self.check(Specular_IOR_Level=0.0)

    def test_specular_tint(self):
        self.check(Specular_Tint=(0.4, 0.6, 1.0), Roughness=0.3, Base_Color=(0.2, 0.2, 0.2))

    def test_a_coat(self):
        self.check(False, 0.035, Coat_Weight=1.0, Coat_Roughness=0.1, Base_Color=(0.5, 0.1, 0.1))

    def test_a_tinted_coat(self):
        self.check(False, Coat_Weight=0.8, Coat_Tint=(0.9, 0.6, 0.3), Base_Color=(0.5, 0.5, 0.5))

    def test_sheen(self):
        self.check(False, 0.03, Sheen_Weight=0.5, Sheen_Roughness=0.5, Base_Color=(0.2, 0.2, 0.3))

    @unittest.skipIf(bpy.app.version < (4, 3), "Blender has no diffuse roughness")
    def test_diffuse_roughness(self):
        self.check(Diffuse_Roughness=0.5, Specular_IOR_Level=0.0)

    def test_alpha(self):
        self.check(Alpha=0.4)

    def test_emission(self):
        self.check(Emission_Color=(0.3, 0.8, 0.2), Emission_Strength=1.5)


if __name__ == "__main__":
    main()
