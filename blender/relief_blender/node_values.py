"""Values of the nodes of a material: constants, images, and what simple nodes make of them, texel by texel."""
from dataclasses import replace

import numpy as np

from . import node_math, values
from .images import MissingImage
from .node_tree import NotExpressible, Wire, follow
from .values import Constant, Place, Textured, make_constant

WRAP = {"REPEAT": "repeat", "EXTEND": "clamp", "CLIP": "black", "MIRROR": "mirror"}
FILTER = {"Linear": "none", "Cubic": "bspline", "Smart": "bspline", "Closest": "none"}
NUMBER_TYPES = {"VALUE", "INT", "BOOLEAN"}
PINK = (1.0, 0.0, 1.0)  # what Cycles has where an image cannot be read


class NodeValues:
    """Evaluates wires. `report` takes a text of what is only taken over in part.

    missing: the colour of images that cannot be read; None: they are MissingImage."""

    def __init__(self, report, texels=None, missing=PINK):
        self.report, self._missing = report, missing
        self.texels = texels or values.Texels(report)
        self._nodes = {
            "ShaderNodeTexImage": self._image, "ShaderNodeMix": self._mix, "ShaderNodeMixRGB": self._mix_rgb,
            "ShaderNodeMath": self._math, "ShaderNodeVectorMath": self._vector_math, "ShaderNodeRGB": self._own,
            "ShaderNodeValue": self._own, "ShaderNodeSeparateColor": self._separate,
            "ShaderNodeSeparateRGB": self._separate, "ShaderNodeSeparateXYZ": self._separate,
            "ShaderNodeCombineColor": self._join, "ShaderNodeCombineRGB": self._join,
            "ShaderNodeCombineXYZ": self._join, "ShaderNodeInvert": self._invert, "ShaderNodeGamma": self._gamma,
            "ShaderNodeRGBToBW": self._luminance, "ShaderNodeClamp": self._clamp,
            "ShaderNodeMapRange": self._map_range, "ShaderNodeValToRGB": self._ramp,
            "ShaderNodeBrightContrast": self._contrast, "ShaderNodeHueSaturation": self._hue,
        }

    def color(self, wire):
        return self._evaluate(wire)

    def number(self, wire):
        return values.to_number(self._evaluate(wire), self.texels)

    def constant(self, wire):
        """The number of a wire that may not be a texture."""
        value = self.number(wire)
        if isinstance(value, Textured):
            raise NotExpressible(f'"{wire.socket.name}" has a texture')
        return value.number

    def _evaluate(self, wire):
        source = follow(wire)
        if source.node is None:
            socket = source.wire.socket
            if not hasattr(socket, "default_value") or isinstance(socket.default_value, str):
                raise NotExpressible(f'"{socket.name}" has no value')
            value = socket.default_value
            return make_constant(value if isinstance(value, (int, float)) else list(value))
        visit = self._nodes.get(source.node.bl_idname)
        if visit is None:
            raise NotExpressible(f'node "{source.node.bl_label}"')
        value = visit(source)
        to_number = source.output.type in NUMBER_TYPES
        return values.to_number(value, self.texels) if to_number else value

    def _inputs(self, source, *names):
        return [self._evaluate(source.input(name)) for name in names]

    def _own(self, source):
        value = source.output.default_value
        return make_constant(value if isinstance(value, float) else list(value))

    # Images

    def _image(self, source):
        node = source.node
        try:
            self._check(node)
        except MissingImage as fault:
            if self._missing is None:
                raise
            self.report(fault.tell("it is pink, as in Cycles"))
            return make_constant(1.0 if source.output.name == "Alpha" else self._missing)
        if node.projection != "FLAT":
            raise NotExpressible(f"projection {node.projection.title()} of an image texture")
        if node.interpolation == "Closest":
            self.report("interpolation Closest of an image texture is linear")
        place = replace(self._place(source.input("Vector")), wrap=WRAP[node.extension],
                        filter=FILTER[node.interpolation])
        value = Textured(place, node.image, "a" if source.output.name == "Alpha" else "")
        return self._associate_alpha(source, value)

    def _check(self, node):
        if node.image is None:
            raise MissingImage(f'image texture "{node.name}" has no image')
        self.texels.check(node.image)

    def _associate_alpha(self, source, value):
        """Where alpha has no link, Cycles multiplies colours by it."""
        image, node = value.image, source.node
        is_straight = image.alpha_mode == "STRAIGHT" and not image.is_float
        if value.channel or not is_straight or node.outputs["Alpha"].is_linked or values.images.is_data(image):
            return value
        tiles = self.texels.read(image)
        if all(np.all(t[..., 3] == 1) for t in tiles.values()):
            return value
        return replace(value, image=None, tiles={n: t[..., :3] * t[..., 3:] for n, t in tiles.items()})

    def _place(self, wire):
        """Uv map, scale and offset of the vector that an image is read at."""
        source = follow(wire)
        if source.node is None or source.node.bl_idname == "ShaderNodeUVMap":
            return Place("" if source.node is None else source.node.uv_map)
        if source.node.bl_idname == "ShaderNodeTexCoord":
            if source.output.name == "UV":
                return Place()
            raise NotExpressible(f"texture coordinate {source.output.name}")
        if source.node.bl_idname == "ShaderNodeMapping":
            return self._map(source)
        raise NotExpressible(f'node "{source.node.bl_label}" as the vector of an image')

    def _map(self, source):
        inner = self._place(source.input("Vector"))
        kind = source.node.vector_type
        location, rotation, scale = (
            self._evaluate(source.input(name)) if source.input(name) else make_constant(default)
            for name, default in (("Location", 0), ("Rotation", 0), ("Scale", 1)))
        if not all(isinstance(value, Constant) for value in (location, rotation, scale)):
            raise NotExpressible("a mapping with textures")
        turns = rotation.rgb / np.pi
        if abs(turns[0]) > 1e-6 or abs(turns[1]) > 1e-6 or abs(turns[2] - round(turns[2])) > 1e-6:
            raise NotExpressible("rotation of a mapping")
        sign = -1.0 if round(turns[2]) % 2 else 1.0
        offset = location.rgb[:2] if kind in {"POINT", "TEXTURE"} else np.zeros(2)
        own = sign * scale.rgb[:2]
        if kind == "TEXTURE":
            own, offset = 1 / own, -offset / own
        return Place(inner.uv_map, tuple(float(v) for v in own * inner.scale),
                     tuple(float(v) for v in own * inner.offset + offset))

    # Computation

    def _mix(self, source):
        node = source.node
        names = {"RGBA": "Color", "FLOAT": "Float", "VECTOR": "Vector"}
        if node.data_type not in names:
            raise NotExpressible(f"mix of {node.data_type.lower()}")
        kind = names[node.data_type]
        is_vector = node.data_type == "VECTOR" and node.factor_mode == "NON_UNIFORM"
        factor, a, b = self._inputs(source, "Factor_Vector" if is_vector else "Factor_Float", f"A_{kind}", f"B_{kind}")
        blend = node.blend_type if node.data_type == "RGBA" else "MIX"
        return self._blend(blend, factor, a, b, node.clamp_factor, node.data_type == "RGBA" and node.clamp_result)

    def _mix_rgb(self, source):
        factor, a, b = self._inputs(source, "Fac", "Color1", "Color2")
        return self._blend(source.node.blend_type, factor, a, b, True, source.node.use_clamp)

    def _blend(self, blend, factor, a, b, is_factor_clamped, is_clamped):
        function = node_math.BLENDS.get(blend)
        if function is None:
            raise NotExpressible(f"mix {blend.title()}")
        if isinstance(factor, Constant) and not is_clamped:
            if factor.number == 0:
                return a
            if factor.number == 1 and blend == "MIX":
                return b
            if factor.number == 1 and blend == "MULTIPLY":
                return values.multiply(a, b, self.texels)

        def mix(f, x, y):
            f = np.clip(f, 0, 1) if is_factor_clamped else f
            result = function(f, x, y)
            return np.clip(result, 0, 1) if is_clamped else result
        return values.combine(mix, [factor, a, b], self.texels)

    def _math(self, source):
        node = source.node
        function, count = node_math.MATH.get(node.operation, (None, 0))
        if function is None:
            raise NotExpressible(f"math {node.operation.title()}")
        inputs = [values.to_number(self._evaluate(Wire(socket, source.wire.groups)), self.texels)
                  for socket in list(node.inputs)[:count]]
        if node.operation == "MULTIPLY" and not node.use_clamp:
            return values.multiply(*inputs, self.texels)
        clamp = (lambda v: np.clip(v, 0, 1)) if node.use_clamp else (lambda v: v)
        return values.combine(lambda *arrays: clamp(function(*arrays)), inputs, self.texels, by_channel=True)

    def _vector_math(self, source):
        node = source.node
        function, count = node_math.VECTOR_MATH.get(node.operation, (None, 0))
        if function is None:
            raise NotExpressible(f"vector math {node.operation.title()}")
        inputs = [self._evaluate(Wire(socket, source.wire.groups))
                  for socket in [s for s in node.inputs if s.enabled][:count]]
        if node.operation in {"MULTIPLY", "SCALE"}:
            return values.multiply(*inputs, self.texels)
        return values.combine(function, inputs, self.texels)

    def _separate(self, source):
        if getattr(source.node, "mode", "RGB") != "RGB":
            raise NotExpressible(f"separate colour by {source.node.mode}")
        index = list(source.node.outputs).index(source.output)
        return values.select_channel(self._evaluate(Wire(source.node.inputs[0], source.wire.groups)), index, self.texels)

    def _join(self, source):
        if getattr(source.node, "mode", "RGB") != "RGB":
            raise NotExpressible(f"combine colour by {source.node.mode}")
        parts = [values.to_number(self._evaluate(Wire(s, source.wire.groups)), self.texels)
                 for s in list(source.node.inputs)[:3]]
        return values.combine(lambda r, g, b: np.stack(np.broadcast_arrays(r[..., 0], g[..., 0], b[..., 0]), -1),
                              parts, self.texels)

    def _invert(self, source):
        return values.combine(lambda f, c: c + f * (1 - 2 * c), self._inputs(source, "Fac", "Color"), self.texels)

    def _gamma(self, source):
        return values.combine(lambda c, g: np.maximum(c, 0) ** g, self._inputs(source, "Color", "Gamma"), self.texels)

    def _luminance(self, source):
        return values.to_number(self._inputs(source, "Color")[0], self.texels)

    def _clamp(self, source):
        return values.combine(np.clip, self._inputs(source, "Value", "Min", "Max"), self.texels)

    def _map_range(self, source):
        node = source.node
        if node.data_type != "FLOAT" or node.interpolation_type != "LINEAR":
            raise NotExpressible(f"map range {node.interpolation_type.title()}")

        def function(v, a, b, c, d):
            result = c + (v - a) / np.where(b == a, 1, b - a) * (d - c)
            return np.clip(result, np.minimum(c, d), np.maximum(c, d)) if node.clamp else result
        return values.combine(function, self._inputs(source, "Value", "From Min", "From Max", "To Min", "To Max"),
                              self.texels)

    def _ramp(self, source):
        ramp = source.node.color_ramp
        table = np.array([ramp.evaluate(i / 1023)[:] for i in range(1024)], np.float32)
        if source.output.name == "Alpha":
            table = np.repeat(table[:, 3:], 4, -1)

        def function(factor):
            at = np.clip(factor[..., 0], 0, 1) * 1023
            low = np.floor(at).astype(int)
            part = (at - low)[..., None]
            return table[low, :3] * (1 - part) + table[np.minimum(low + 1, 1023), :3] * part
        return values.combine(function, [values.to_number(self._inputs(source, "Fac")[0], self.texels)], self.texels)

    def _contrast(self, source):
        return values.combine(lambda c, b, k: np.maximum((1 + k) * c + b - k / 2, 0),
                              self._inputs(source, "Color", "Bright", "Contrast"), self.texels)

    def _hue(self, source):
        return values.combine(node_math.shift_hue, self._inputs(source, "Hue", "Saturation", "Value", "Fac", "Color"),
                              self.texels)
