"""Builds a scene folder of Relief in Blender and renders it with Cycles.

Displaced and smooth meshes are diced adaptively at one pixel. Coordinates stay as they are, y up: the camera is placed and the sky is
turned accordingly. Runs inside Blender: blender -b --factory-startup --python cycles_scene.py -- OPTIONS
"""
import argparse
import json
import math
import os
import sys

import bpy
from mathutils import Euler, Matrix, Vector


def make_parser():
    parser = argparse.ArgumentParser()
    parser.add_argument("--scene", required=True, help="scene.json, as `relief scene` writes it")
    parser.add_argument("--size", required=True, help="WxH pixels")
    parser.add_argument("--samples", type=int, required=True)
    parser.add_argument("--bounces", type=int, required=True)
    parser.add_argument("--threads", type=int, required=True)
    parser.add_argument("--importance-map", type=int, required=True, help="width in texels; 0: Blender's default")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--denoise", type=int, default=0, help="1: by Open Image Denoise, with albedo and normal")
    parser.add_argument("--output", help="EXR with the background left out, written after the render")
    return parser


def list_words():
    """The words of the command line that are for the script."""
    return sys.argv[sys.argv.index("--") + 1:]


def tell(line):
    """Prints a line for the log reader, which timestamps it on arrival."""
    print("relief:", line, flush=True)


def read_obj(file):
    """Positions, faces, the uv of each corner, and creases as (a, b, sharpness); of corners b is a.

    Supports only OBJ as Relief writes it: no negative indices, one crease a tag."""
    positions, uvs, faces, corner_uvs, creases = [], [], [], [], []
    with open(file, encoding="ascii") as stream:
        for line in stream:
            words = line.split()
            if not words:
                continue
            if words[0] == "v":
                positions.append(tuple(map(float, words[1:4])))
            elif words[0] == "vt":
                uvs.append(tuple(map(float, words[1:3])))
            elif words[0] == "f":
                corners = [word.split("/") for word in words[1:]]
                faces.append([int(corner[0]) - 1 for corner in corners])
                corner_uvs += [uvs[int(corner[1]) - 1] for corner in corners if len(corner) > 1 and corner[1]]
            elif words[:2] == ["t", "crease"]:
                creases.append((int(words[3]), int(words[4]), float(words[5])))
            elif words[:2] == ["t", "corner"]:
                creases.append((int(words[3]), int(words[3]), float(words[4])))
    return positions, faces, corner_uvs, creases


def add_creases(mesh, creases):
    """Cycles takes ten times the value of an edge or point for its sharpness, Blender and Relief ten times its square."""
    is_cycles = bpy.context.scene.render.engine == "CYCLES"

    def find_value(sharpness):
        return min(sharpness / 10, 1) if is_cycles else math.sqrt(min(sharpness / 10, 1))

    values = {frozenset((a, b)): find_value(sharpness) for a, b, sharpness in creases}
    edges = mesh.attributes.new("crease_edge", "FLOAT", "EDGE")
    edges.data.foreach_set("value", [values.get(frozenset(edge.vertices), 0) for edge in mesh.edges])
    points = mesh.attributes.new("crease_vert", "FLOAT", "POINT")
    points.data.foreach_set("value", [values.get(frozenset((k,)), 0) for k in range(len(mesh.vertices))])


def make_mesh(name, file, flips_v, is_smooth):
    positions, faces, corner_uvs, creases = read_obj(file)
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(positions, [], faces)
    if corner_uvs:
        layer = mesh.uv_layers.new(name="UVMap")
        layer.data.foreach_set("uv", [x for u, v in corner_uvs for x in (u, 1 - v if flips_v else v)])
    mesh.polygons.foreach_set("use_smooth", [is_smooth] * len(faces))
    mesh.update()
    if creases:
        add_creases(mesh, creases)
    return mesh


def list_tiles(pattern):
    """{number: file} of the tiles that are there."""
    folder, name = os.path.split(pattern)
    start, end = name.split("<UDIM>")
    found = {file[len(start):len(start) + 4]: file for file in os.listdir(folder) if file.startswith(start) and file.endswith(end)}
    return {int(number): os.path.join(folder, file) for number, file in found.items() if number.isdigit()}


def load_image(file):
    """One image, or all tiles of a name with <UDIM>."""
    if "<UDIM>" in file:
        tiles = list_tiles(file)
        image = bpy.data.images.load(tiles[min(tiles)])
        image.source, image.filepath = "TILED", file
        for number in sorted(tiles):
            if image.tiles.get(number) is None:
                image.tiles.new(tile_number=number)
        image.tiles.active_index = 0
    else:
        image = bpy.data.images.load(file)
    image.colorspace_settings.name = "Non-Color"
    return image


def parse_axes(text):
    """Index of the axis and the sign of each channel, from "x,-z,y"."""
    return [("xyztbn".index(word[-1]) % 3 if word[-1] in "xyz" else "tbn".index(word[-1]), -1 if word[0] == "-" else 1)
            for word in text.split(",")]


def add_displacement(tree, entry, folder):
    """Nodes for (texel - midlevel) scale along signed axes. Height maps move along the normal."""
    if entry["wrap"] not in ("clamp", "repeat", "black"):
        raise SystemExit("a map that is mirrored cannot be handed to Cycles")
    texture = tree.nodes.new("ShaderNodeTexImage")
    texture.image = load_image(os.path.join(folder, entry["file"]))
    texture.extension = {"clamp": "EXTEND", "repeat": "REPEAT", "black": "CLIP"}[entry["wrap"]]
    parts = tree.nodes.new("ShaderNodeSeparateXYZ")
    tree.links.new(texture.outputs["Color"], parts.inputs[0])
    joined = tree.nodes.new("ShaderNodeCombineXYZ")
    is_height = entry["type"] == "height"
    is_tangent = is_height or entry["space"] == "tangent"
    axes = [(2, 1)] if is_height else parse_axes(entry["axes"])
    for channel, (axis, sign) in enumerate(axes):
        moved = tree.nodes.new("ShaderNodeMath")
        moved.operation = "MULTIPLY_ADD"
        scale = sign * entry["scale"][channel]
        moved.inputs[1].default_value = scale
        moved.inputs[2].default_value = -scale * entry.get("midlevel", (0, 0, 0))[channel]
        tree.links.new(parts.outputs[channel], moved.inputs[0])
        # Cycles takes tangent, normal, bitangent.
        tree.links.new(moved.outputs[0], joined.inputs[(0, 2, 1)[axis] if is_tangent else axis])
    vector = tree.nodes.new("ShaderNodeVectorDisplacement")
    vector.space = "TANGENT" if is_tangent else entry["space"].upper()
    vector.inputs["Midlevel"].default_value = 0
    vector.inputs["Scale"].default_value = 1
    tree.links.new(joined.outputs[0], vector.inputs["Vector"])
    return vector.outputs[0]


def make_material(scene, item, folder):
    """Diffuse, in the base colour of the scene's material."""
    material = bpy.data.materials.new(item.get("name", "material"))
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    diffuse = tree.nodes.new("ShaderNodeBsdfDiffuse")
    diffuse.inputs["Color"].default_value = (*scene["materials"][item["material"]]["base_color"], 1)
    tree.links.new(diffuse.outputs[0], output.inputs["Surface"])
    if "displacement" in item:
        entry = scene["displacements"][item["displacement"]]
        tree.links.new(add_displacement(tree, entry, folder), output.inputs["Displacement"])
        # Blender 4.2 moved it.
        owner = material if hasattr(material, "displacement_method") else material.cycles
        owner.displacement_method = "DISPLACEMENT"
    return material


def dice(thing, subdivision):
    """Adaptive subdivision. Blender first evaluates the modifier at its own level, which must be 0."""
    modifier = thing.modifiers.new("dice", "SUBSURF")
    modifier.subdivision_type = "CATMULL_CLARK" if subdivision.get("scheme") == "catmark" else "SIMPLE"
    modifier.levels = modifier.render_levels = 0
    modifier.uv_smooth = "NONE" if subdivision.get("uv") == "linear" else "PRESERVE_CORNERS_AND_JUNCTIONS"
    modifier.boundary_smooth = "ALL" if subdivision.get("boundary") == "edge-only" else "PRESERVE_CORNERS"
    modifier.use_creases = subdivision.get("creases", True) is not False
    if hasattr(modifier, "use_adaptive_subdivision"):  # Blender 5.0 moved it
        modifier.use_adaptive_subdivision, modifier.adaptive_pixel_size = True, 1.0
    else:
        thing.cycles.use_adaptive_subdivision = True
        thing.cycles.dicing_rate = 1.0


def add_object(scene, item, folder, meshes):
    """`meshes`: those made so far; objects share them, and have materials of their own."""
    entry = scene["meshes"][item["mesh"]]
    subdivision = entry.get("subdivision", {})
    is_displaced = "displacement" in item
    is_smooth = is_displaced or bool(subdivision)
    flips_v = is_displaced and scene["displacements"][item["displacement"]]["flip_v"]
    key = (item["mesh"], flips_v, is_smooth)
    if key not in meshes:
        meshes[key] = make_mesh(item["mesh"], os.path.join(folder, entry["file"]), flips_v, is_smooth)
        meshes[key].materials.append(None)
    thing = bpy.data.objects.new(item.get("name", "object"), meshes[key])
    bpy.context.scene.collection.objects.link(thing)
    thing.material_slots[0].link = "OBJECT"
    thing.material_slots[0].material = make_material(scene, item, folder)
    if "transform" in item:
        values = item["transform"]["matrix"]
        thing.matrix_world = Matrix([values[row * 4:row * 4 + 4] for row in range(4)])
    if is_smooth:
        dice(thing, subdivision)
    return thing


def look(thing, camera):
    """Places the camera's object."""
    back = (Vector(camera["from"]) - Vector(camera["to"])).normalized()
    right = Vector(camera["up"]).cross(back).normalized()
    thing.matrix_world = Matrix.Translation(camera["from"]) @ Matrix((right, back.cross(right), back)).transposed().to_4x4()


def place_camera(camera):
    data = bpy.data.cameras.new("camera")
    data.sensor_fit = "VERTICAL"
    data.angle = math.radians(camera["fov_degrees"])
    # With this sensor fit, in heights of the picture.
    data.shift_x, data.shift_y = camera.get("shift", (0, 0))
    data.clip_start, data.clip_end = 1e-3, 1e5
    thing = bpy.data.objects.new("camera", data)
    bpy.context.scene.collection.objects.link(thing)
    look(thing, camera)
    bpy.context.scene.camera = thing
    return thing


def make_world(environment, folder, importance_map):
    world = bpy.data.worlds.new("world")
    bpy.context.scene.world = world
    world.use_nodes = True
    if importance_map:
        world.cycles.sampling_method = "MANUAL"
        world.cycles.sample_map_resolution = importance_map
    tree = world.node_tree
    background = tree.nodes["Background"]
    background.inputs["Strength"].default_value = environment["strength"]
    background.inputs["Color"].default_value = (*environment["color"], 1)
    if "file" not in environment:
        return
    if environment["color"] != [1, 1, 1]:
        raise SystemExit("a sky with a colour of its own cannot be handed to Cycles")
    texture = tree.nodes.new("ShaderNodeTexEnvironment")
    texture.image = load_image(os.path.join(folder, environment["file"]))
    # Relief looks along -z at the middle of the image and has y up; Blender looks along +x and has z up.
    to_blender = Matrix(((0, 0, -1), (-1, 0, 0), (0, 1, 0)))
    turned = to_blender @ Euler((0, -math.radians(environment["rotate_degrees"]), 0)).to_matrix()
    mapping = tree.nodes.new("ShaderNodeMapping")
    mapping.inputs["Rotation"].default_value = turned.to_euler("XYZ")
    place = tree.nodes.new("ShaderNodeTexCoord")
    tree.links.new(place.outputs["Generated"], mapping.inputs["Vector"])
    tree.links.new(mapping.outputs[0], texture.inputs[0])
    tree.links.new(texture.outputs[0], background.inputs["Color"])


def choose_settings(arguments):
    render = bpy.context.scene.render
    render.engine = "CYCLES"
    render.resolution_x, render.resolution_y = map(int, arguments.size.split("x"))
    render.resolution_percentage = 100
    render.threads_mode, render.threads = "FIXED", arguments.threads
    render.use_compositing = render.use_sequencer = False
    render.film_transparent = arguments.output is not None
    cycles = bpy.context.scene.cycles
    cycles.device = "CPU"
    if hasattr(cycles, "feature_set"):  # adaptive subdivision is no experiment from Blender 5.0 on
        cycles.feature_set = "EXPERIMENTAL"
    cycles.dicing_rate, cycles.max_subdivisions = 1.0, 12
    cycles.samples, cycles.seed = arguments.samples, arguments.seed
    cycles.use_adaptive_sampling = cycles.use_auto_tile = False
    cycles.use_denoising = arguments.denoise != 0
    cycles.denoiser, cycles.denoising_input_passes = "OPENIMAGEDENOISE", "RGB_ALBEDO_NORMAL"
    cycles.pixel_filter_type, cycles.filter_width = "BOX", 1.0
    cycles.max_bounces = cycles.diffuse_bounces = arguments.bounces
    cycles.sample_clamp_indirect = 0
    cycles.caustics_reflective = cycles.caustics_refractive = False


def read_peak_resident():
    """Bytes of this process, Blender included."""
    with open("/proc/self/status", encoding="ascii") as stream:
        return next(int(line.split()[1]) * 1024 for line in stream if line.startswith("VmHWM:"))


def build_scene(arguments):
    """Returns the scene as JSON has it, the objects in its order, and the camera."""
    if getattr(bpy.app, "module", False):  # without the command `blender` and its --factory-startup
        bpy.ops.wm.read_factory_settings()
    with open(arguments.scene, encoding="utf-8") as stream:
        scene = json.load(stream)
    folder = os.path.dirname(os.path.abspath(arguments.scene))
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)
    choose_settings(arguments)
    meshes = {}
    things = [add_object(scene, item, folder, meshes) for item in scene["objects"]]
    camera = place_camera(scene["camera"])
    make_world(scene["environment"], folder, arguments.importance_map)
    return scene, things, camera


def save_picture(file):
    settings = bpy.context.scene.render.image_settings
    settings.file_format, settings.color_depth, settings.color_mode = "OPEN_EXR", "32", "RGBA"
    bpy.data.images["Render Result"].save_render(file)


def main():
    arguments = make_parser().parse_args(list_words())
    build_scene(arguments)
    tell("blender " + bpy.app.version_string)
    tell("render starts")
    bpy.ops.render.render()
    tell("render ends")
    tell(f"peak resident {read_peak_resident()}")
    if arguments.output:
        save_picture(arguments.output)


if __name__ == "__main__":
    main()
