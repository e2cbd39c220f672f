"""Scenes made by bpy, rendered by Relief and by Cycles in one process, and read back as arrays."""
import pathlib
import sys
import tempfile
import unittest

import bpy
import numpy as np

ADDON = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ADDON))

import relief_blender  # noqa: E402  (from the folder above)
from exr import read_exr  # noqa: E402
from relief_blender import statistics  # noqa: E402
from relief_blender.images import make_image  # noqa: E402, F401  (for the tests)

WIDTH, HEIGHT = 200, 150
KEEP = pathlib.Path(sys.argv[sys.argv.index("--keep") + 1]).resolve() if "--keep" in sys.argv else None


class Layers:
    """Passes of a render, (height, width) or (height, width, channels), row 0 at the top."""

    def __init__(self, file):
        self._channels = {name.split(".", 1)[1]: array for name, array in read_exr(file).items()}

    def __getitem__(self, name):
        for letters in ("RGBA", "RGB", "XYZ", "UVA", "rgba", "V", "Z"):
            found = [self._channels.get(f"{name}.{letter}") for letter in letters]
            if all(channel is not None for channel in found):
                return found[0] if len(found) == 1 else np.stack(found, -1)
        raise KeyError(f"{name}: {sorted(self._channels)}")

    @property
    def names(self):
        """Of all passes."""
        return {channel.rsplit(".", 1)[0] for channel in self._channels}

    @property
    def mask(self):
        return self["Combined"][..., 3] > 0.5

    @property
    def brightness(self):
        return float(self["Combined"][..., :3].mean())


class BlenderTest(unittest.TestCase):
    """An empty scene with a camera; film transparent, so that alpha is the silhouette."""

    @classmethod
    def setUpClass(cls):
        relief_blender.register()

    @classmethod
    def tearDownClass(cls):
        relief_blender.unregister()

    def setUp(self):
        bpy.ops.wm.read_factory_settings(use_empty=True)
        self.folder = pathlib.Path(tempfile.mkdtemp())
        scene = bpy.context.scene
        scene.render.resolution_x, scene.render.resolution_y = WIDTH, HEIGHT
        scene.render.film_transparent = True
        scene.cycles.use_adaptive_sampling = scene.cycles.use_denoising = False
        scene.cycles.pixel_filter_type = "BOX"
        scene.cycles.max_bounces = scene.cycles.diffuse_bounces = scene.cycles.glossy_bounces = 4
        scene.cycles.transparent_max_bounces, scene.cycles.blur_glossy = 8, 0
        scene.cycles.sample_clamp_indirect = scene.relief.clamp_indirect = 0
        scene.relief.samples = scene.cycles.samples = 16
        bpy.context.view_layer.use_pass_z = bpy.context.view_layer.use_pass_position = True
        world = bpy.data.worlds.new("world")
        scene.world = world
        set_world(world, (1, 1, 1))
        self.camera = add_camera((0, -6, 3), (0, 0, 0))

    def render(self, engine, name="picture", samples=None):
        """The Layers of a render."""
        scene = bpy.context.scene
        scene.render.engine = engine
        if samples is not None:
            scene.relief.samples = scene.cycles.samples = samples
        file = (KEEP or self.folder) / f"{self.id().split('.')[-1]}_{name}_{engine.lower()}.exr"
        write_layers(scene, file)
        bpy.ops.render.render(write_still=True)
        return Layers(file)

    def report(self):
        """Lines of what the last render by Relief did not take over."""
        return statistics.find(bpy.context.scene).lines

    def find_depths(self, layers):
        """Along the view axis, from positions: depths are those of one point of each pixel, in Relief of the nearest."""
        matrix = np.array(self.camera.matrix_world.inverted())
        return -(layers["Position"] @ matrix[2, :3] + matrix[2, 3])

    def compare(self, name="picture", samples=16, mask_share=0.005, depth_share=0.003, before_cycles=None):
        """Renders by both; silhouettes, positions and depths agree. Returns both."""
        ours = self.render("RELIEF", name, samples)
        if before_cycles is not None:
            before_cycles()
        theirs = self.render("CYCLES", name, samples)
        differing = np.mean(ours.mask != theirs.mask)
        both = (ours["Combined"][..., 3] == 1) & (theirs["Combined"][..., 3] == 1)
        self.assertGreater(both.mean(), 0.03, "the thing is hardly in the picture")
        self.assertLess(both.mean(), 0.99, "the thing has no silhouette")
        size = np.ptp(theirs["Depth"][both])
        error = np.abs(self.find_depths(ours) - self.find_depths(theirs))[both] / size
        nearest = np.abs(ours["Depth"] - theirs["Depth"])[both] / size
        print(f"{self.id().split('.')[-1]} {name}: mask {100 * differing:.3f} %, depth median {np.median(error):.5f}, "
              f"95 % {np.quantile(error, 0.95):.5f}, of the pass {np.median(nearest):.5f}", flush=True)
        self.assertLess(differing, mask_share)
        self.assertLess(np.median(error), depth_share)
        self.assertLess(np.quantile(error, 0.95), 10 * depth_share)
        self.assertLess(np.median(nearest), 0.03)
        return ours, theirs

    def compare_brightness(self, name="picture", samples=16, tolerance=0.02):
        ours, theirs = self.render("RELIEF", name, samples), self.render("CYCLES", name, samples)
        ratio = ours.brightness / theirs.brightness
        print(f"{self.id().split('.')[-1]} {name}: brightness {ratio:.4f} of Cycles' {theirs.brightness:.4f}", flush=True)
        self.assertGreater(theirs.brightness, 0.003, "the picture is dark")
        self.assertAlmostEqual(ratio, 1, delta=tolerance)
        return ours, theirs


def write_layers(scene, file):
    """Renders are written as read_exr reads them: all layers in one part, as floats, without compression."""
    settings = scene.render.image_settings
    if hasattr(settings, "media_type"):  # from 5.0 on
        settings.media_type, settings.use_exr_interleave = "MULTI_LAYER_IMAGE", True
    settings.file_format, settings.color_depth, settings.exr_codec = "OPEN_EXR_MULTILAYER", "32", "NONE"
    scene.render.filepath = str(file)


def find_curves(owner):
    """The animation curves of what an object, camera, material, ... is a part of."""
    action = owner.id_data.animation_data.action
    if hasattr(action, "fcurves"):
        return list(action.fcurves)
    return [curve for layer in action.layers for strip in layer.strips for bag in strip.channelbags for curve in bag.fcurves]


def add_camera(place, target, lens=50.0):
    data = bpy.data.cameras.new("camera")
    data.lens = lens
    camera = bpy.data.objects.new("camera", data)
    bpy.context.scene.collection.objects.link(camera)
    bpy.context.scene.camera = camera
    aim(camera, place, target)
    return camera


def aim(ob, place, target):
    from mathutils import Vector
    ob.location = place
    ob.rotation_euler = (Vector(target) - Vector(place)).to_track_quat("-Z", "Y").to_euler()


def set_world(world, color, strength=1.0):
    world.use_nodes = True
    tree = world.node_tree
    tree.nodes.clear()
    output, background = tree.nodes.new("ShaderNodeOutputWorld"), tree.nodes.new("ShaderNodeBackground")
    background.inputs["Color"].default_value = (*color, 1)
    background.inputs["Strength"].default_value = strength
    tree.links.new(background.outputs[0], output.inputs["Surface"])
    return background


def add_light(kind, place=(0, 0, 3), target=(0, 0, 0), energy=100.0):
    data = bpy.data.lights.new("light", kind)
    data.energy = energy
    light = bpy.data.objects.new("light", data)
    bpy.context.scene.collection.objects.link(light)
    aim(light, place, target)
    return light


def make_object(positions, faces, uvs=None, name="thing", smooth=True):
    """An object of a new mesh; uvs one a corner."""
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata([tuple(p) for p in positions], [], [tuple(f) for f in faces])
    if uvs is not None:
        layer = mesh.uv_layers.new(name="UVMap")
        layer.uv.foreach_set("vector", np.asarray(uvs, np.float32).reshape(-1))
    mesh.polygons.foreach_set("use_smooth", [smooth] * len(faces))
    mesh.update()
    ob = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(ob)
    return ob


def make_grid(count, place=lambda u, v: (2 * u - 1, 2 * v - 1, 0 * u), wrap=(False, False), uv=lambda u, v: (u, v)):
    """A grid of count x count quads over the unit square; `wrap` joins its sides."""
    u, v = np.meshgrid(np.linspace(0, 1, count + 1), np.linspace(0, 1, count + 1))
    columns, rows = (count if w else count + 1 for w in wrap)
    points = np.stack(np.broadcast_arrays(*place(u, v)), -1)[:rows, :columns].reshape(-1, 3)
    faces, uvs = [], []
    for r in range(count):
        for c in range(count):
            corners = [(r, c), (r, c + 1), (r + 1, c + 1), (r + 1, c)]
            faces.append([(i % rows) * columns + j % columns for i, j in corners])
            uvs += [uv(j / count, i / count) for i, j in corners]
    return make_object(points, faces, uvs)


def make_material(ob=None, **inputs):
    """A material of a Principled BSDF with some inputs, on an object."""
    material = bpy.data.materials.new("material")
    material.use_nodes = True
    node = material.node_tree.nodes.get("Principled BSDF")
    for name, value in inputs.items():
        socket = node.inputs[name.replace("_", " ")]
        socket.default_value = (*value, 1) if socket.type == "RGBA" else value
    if ob is not None:
        ob.data.materials.append(material)
    return material


def displace(material, image, kind="TANGENT", scale=1.0, midlevel=0.0):
    """Vector Displacement (TANGENT, OBJECT, WORLD) or Displacement (HEIGHT) by an image."""
    tree = material.node_tree
    node = tree.nodes.new("ShaderNodeDisplacement" if kind == "HEIGHT" else "ShaderNodeVectorDisplacement")
    if kind != "HEIGHT":
        node.space = kind
    node.inputs["Midlevel"].default_value, node.inputs["Scale"].default_value = midlevel, scale
    texture = tree.nodes.new("ShaderNodeTexImage")
    texture.image = image
    tree.links.new(texture.outputs["Color"], node.inputs["Height" if kind == "HEIGHT" else "Vector"])
    tree.links.new(node.outputs[0], tree.get_output_node("ALL").inputs["Displacement"])
    material.displacement_method = "DISPLACEMENT"
    return texture


def make_hook(size=128):
    """A vector map in the order of the node (tangent, normal, bitangent): a hill that leans over in one corner."""
    v, u = np.meshgrid(1 - (np.arange(size) + 0.5) / size, (np.arange(size) + 0.5) / size, indexing="ij")
    hill = np.exp(-((u - 0.6) ** 2 + (v - 0.55) ** 2) / 0.02)
    small = np.exp(-((u - 0.25) ** 2 + (v - 0.8) ** 2) / 0.006)
    edge = np.clip(np.minimum.reduce([u, v, 1 - u, 1 - v]) / 0.1, 0, 1)
    return (np.stack([0.35 * hill ** 2, 0.7 * hill + 0.3 * small, 0.2 * hill * (2 * u - 1)], -1)
            * edge[..., None]).astype(np.float32)


def subdivide(ob, kind="SIMPLE", levels=5, adaptive=False):
    modifier = ob.modifiers.new("subdivision", "SUBSURF")
    modifier.subdivision_type = kind
    modifier.levels = modifier.render_levels = levels
    if not adaptive:
        return modifier
    if hasattr(bpy.context.scene.cycles, "feature_set"):
        bpy.context.scene.cycles.feature_set = "EXPERIMENTAL"
    if hasattr(modifier, "use_adaptive_subdivision"):
        modifier.use_adaptive_subdivision = True
    else:
        ob.cycles.use_adaptive_subdivision = True
    bpy.context.scene.cycles.dicing_rate = 1
    return modifier


def main():
    """Runs the tests of the calling file. A bpy module whose classes are registered would hang at the end."""
    arguments = [a for i, a in enumerate(sys.argv) if a != "--keep" and (i == 0 or sys.argv[i - 1] != "--keep")]
    unittest.main(module="__main__", argv=arguments, verbosity=1)
