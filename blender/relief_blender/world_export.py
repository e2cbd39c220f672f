"""The world as an environment: a colour, or a picture turned as its mapping says."""
import numpy as np
import relief

from . import images
from .axes import convert_back
from .node_tree import NotExpressible, Wire, find_output, follow
from .node_values import PINK, NodeValues
from .textures import LARGEST
from .values import Constant

BLACK = {"color": [0.0, 0.0, 0.0]}
# Blender shows the middle of a picture along +x, Relief along -z, which is Blender's +y.
TURN_DEGREES = -90.0


def find_rotation(source, node_values):
    """3x3 matrix: direction in the picture = matrix x direction in the world. `source` feeds the picture's vector."""
    if source.node is None:
        return np.eye(3)
    if source.node.bl_idname in {"ShaderNodeTexCoord", "ShaderNodeNewGeometry"}:
        if source.output.name in {"Generated", "Normal", "Object"}:
            return np.eye(3)
        raise NotExpressible(f"coordinate {source.output.name} of the picture")
    if source.node.bl_idname != "ShaderNodeMapping":
        raise NotExpressible(f'node "{source.node.bl_label}"')
    before = find_rotation(follow(source.input("Vector")), node_values)
    angles = node_values.color(source.input("Rotation"))
    scale = node_values.color(source.input("Scale"))
    if not isinstance(angles, Constant) or not isinstance(scale, Constant):
        raise NotExpressible("a mapping with textures")
    own = rotate_by_euler(angles.rgb) @ np.diag(scale.rgb) if source.node.vector_type != "TEXTURE" else \
        np.diag(np.divide(1, scale.rgb, out=np.zeros(3), where=scale.rgb != 0)) @ rotate_by_euler(angles.rgb).T
    return own @ before


def rotate_by_euler(angles):
    """Blender's XYZ: about x, then y, then z."""
    result = np.eye(3)
    for axis, angle in enumerate(angles):
        c, s, turn = np.cos(angle), np.sin(angle), np.eye(3)
        i, j = (axis + 1) % 3, (axis + 2) % 3
        turn[i, i], turn[i, j], turn[j, i], turn[j, j] = c, -s, s, c
        result = turn @ result
    return result


def find_turn(matrix):
    """Degrees about z that a matrix turns by, or None if it does more."""
    angle = np.arctan2(matrix[1, 0], matrix[0, 0])
    return float(np.degrees(angle)) if np.allclose(matrix, rotate_by_euler([0, 0, angle]), atol=1e-5) else None


def look_up(texels, directions, is_mirror_ball):
    """Bilinear values of a picture in Blender's directions (..., 3)."""
    norms = np.linalg.norm(directions, axis=-1, keepdims=True)
    x, y, z = np.moveaxis(directions / np.maximum(norms, 1e-30), -1, 0)
    if is_mirror_ball:
        length = np.sqrt(np.maximum(2 * (1 - y), 1e-12))
        u, v = x / length / 2 + 0.5, z / length / 2 + 0.5
    else:
        u, v = 0.5 - np.arctan2(y, x) / (2 * np.pi), np.arctan2(z, np.hypot(x, y)) / np.pi + 0.5
        u, v = (np.where(norms[..., 0] == 0, 0.0, at) for at in (u, v))  # as in Cycles
    height, width = texels.shape[:2]
    column, row = u * width - 0.5, np.clip((1 - v) * height - 0.5, 0, height - 1)
    c0, r0 = np.floor(column).astype(int), np.floor(row).astype(int)
    fc, fr = (column - c0)[..., None], (row - r0)[..., None]
    c0, c1, r1 = c0 % width, (c0 + 1) % width, np.minimum(r0 + 1, height - 1)
    flat, r0, r1 = texels.reshape(-1, texels.shape[-1]), r0 * width, r1 * width
    return ((flat[r0 + c0] * (1 - fc) + flat[r0 + c1] * fc) * (1 - fr)
            + (flat[r1 + c0] * (1 - fc) + flat[r1 + c1] * fc) * fr)


def turn_picture(texels, matrix, is_mirror_ball):
    """The picture as Relief wants it: longitude and latitude about -z, read through a matrix."""
    height, width = (texels.shape[0], 2 * texels.shape[0]) if is_mirror_ball else texels.shape[:2]
    phi = (((np.arange(width) + 0.5) / width - 0.5) * 2 * np.pi).astype(np.float32)
    theta = ((np.arange(height) + 0.5) / height * np.pi).astype(np.float32)
    sine = np.sin(theta)[:, None]
    ways = np.stack([sine * np.sin(phi), np.broadcast_to(np.cos(theta)[:, None], (height, width)), -sine * np.cos(phi)], -1)
    return look_up(texels, convert_back(ways) @ matrix.T.astype(np.float32), is_mirror_ball).astype(np.float32)


class WorldReader:
    """Reads a bpy.types.World. `report` takes a text."""

    def __init__(self, report):
        self._report = report
        self._values = NodeValues(report)

    def read(self, world):
        """A relief.Environment."""
        if world is None:
            return relief.Environment(**BLACK)
        is_by_nodes = world.node_tree is not None and (world.use_nodes or not hasattr(world, "use_nodes"))
        if not is_by_nodes:
            return relief.Environment(color=[float(c) for c in world.color])
        output = find_output(world.node_tree)
        if output is None:
            return relief.Environment(**BLACK)
        if output.inputs["Volume"].is_linked:
            self._report("its volume is not taken over")
        return self._surface(follow(Wire(output.inputs["Surface"])))

    def _surface(self, source):
        if source.node is None:
            return relief.Environment(**BLACK)
        if source.node.bl_idname == "ShaderNodeMixShader":
            self._report("of a mix of two backgrounds the first is used")
            return self._surface(follow(source.input(source.node.inputs[1].identifier)))
        if source.node.bl_idname not in {"ShaderNodeBackground", "ShaderNodeEmission"}:
            self._report(f'node "{source.node.bl_label}" is not taken over: the world is grey')
            return relief.Environment(color=[0.05, 0.05, 0.05])
        strength = self._number(source)
        try:
            return self._color(follow(source.input("Color")), source.input("Color"), strength)
        except NotExpressible as fault:
            self._report(f"{fault} is not taken over: its own colour is used")
            own = source.input("Color").socket.default_value
            return relief.Environment(color=[float(c) for c in list(own)[:3]], strength=strength)

    def _number(self, source):
        try:
            return self._values.constant(source.input("Strength"))
        except NotExpressible as fault:
            self._report(f"{fault} as its strength: 1 is used")
            return 1.0

    def _color(self, source, wire, strength, factor=None):
        factor = np.ones(3) if factor is None else factor
        if source.node is not None and source.node.bl_idname == "ShaderNodeTexEnvironment":
            return self._picture(source, strength, factor)
        if source.node is not None and source.node.bl_idname in {"ShaderNodeMix", "ShaderNodeMixRGB"}:
            return self._product(source, strength, factor)
        value = self._values.color(wire)
        if not isinstance(value, Constant):
            raise NotExpressible("a texture that is no environment")
        return relief.Environment(color=(value.rgb * factor).tolist(), strength=strength)

    def _product(self, source, strength, factor):
        """A picture times a colour."""
        names = ("A_Color", "B_Color", "Factor_Float") if source.node.bl_idname == "ShaderNodeMix" else \
            ("Color1", "Color2", "Fac")
        a, b, part = (source.input(name) for name in names)
        if source.node.blend_type != "MULTIPLY" or self._values.constant(part) != 1:
            raise NotExpressible(f"mix {source.node.blend_type.title()} of the world")
        picture, color = (a, b) if follow(a).node is not None else (b, a)
        value = self._values.color(color)
        if not isinstance(value, Constant):
            raise NotExpressible("a product of two pictures")
        return self._color(follow(picture), picture, strength, factor * value.rgb)

    def _picture(self, source, strength, factor):
        node = source.node
        matrix = find_rotation(follow(source.input("Vector")), self._values)
        if not np.all(np.isfinite(matrix)):
            raise NotExpressible("a mapping that is not finite")
        is_mirror_ball = node.projection == "MIRROR_BALL"
        turn = None if is_mirror_ball else find_turn(matrix)
        keys = {"color": [float(f) for f in factor], "strength": strength}
        try:
            if turn is None:
                return relief.Environment(file=turn_picture(self._read(node), matrix, is_mirror_ball), **keys)
            file = images.find_file(node.image) if node.image is not None else None
            if file is not None:
                images.check_file(node.image, file)
            picture = file or np.ascontiguousarray(self._read(node))
            return relief.Environment(file=picture, rotate_degrees=TURN_DEGREES - turn, **keys)
        except images.MissingImage as fault:
            self._report(fault.tell("it is pink, as in Cycles"))
            return relief.Environment(color=[p * float(f) for p, f in zip(PINK, factor)], strength=strength)

    def _read(self, node):
        """(height, width, 3) of an environment texture."""
        if node.image is None:
            raise images.MissingImage("its environment texture has no image")
        return images.read_tiles(node.image, self._report)[1001][..., :3]


def find_world(depsgraph):
    """The original bpy.types.World that lights the view layer, or None."""
    return depsgraph.view_layer.world_override or depsgraph.scene.world


def report_visibility(world, tell):
    """Names the rays that do not see the world in Cycles."""
    visibility = getattr(world, "cycles_visibility", None)
    hidden = [kind for kind in ("camera", "diffuse", "glossy", "transmission") if not getattr(visibility, kind, True)]
    if hidden:
        tell(f"ray visibility ({', '.join(hidden)}) is left out: all rays see it")


def export_world(depsgraph, report):
    """The Environment at the depsgraph's time: the original world stays behind."""
    world = find_world(depsgraph)
    world = world.evaluated_get(depsgraph) if world else None
    name = world.name if world else ""

    def tell(text):
        report.add("world", name, text)
    report_visibility(world, tell)
    environment = WorldReader(tell).read(world)
    strength = environment.get("strength", 1.0)
    if not np.all(np.abs([*environment["color"], strength]) < LARGEST):  # NaN is not
        tell("its colour or strength is not finite: it is black")
        return relief.Environment(**BLACK)
    if strength < 0:
        tell("its strength is negative: it is black")
        return relief.Environment(**BLACK)
    if np.any(np.array(environment["color"]) < 0):
        environment["color"] = [max(c, 0.0) for c in environment["color"]]
    return environment

