"""What feeds an input of a shader: a constant, or a texture times a factor plus an offset."""
from __future__ import annotations

import dataclasses

import numpy as np
from pxr import Usd, UsdShade

from .assets import resolve_asset
from .context import Context
from .placement import Placement, read_placement

WRAPS = {"repeat": "repeat", "clamp": "clamp", "mirror": "mirror", "black": "black", "useMetadata": "repeat",
         "periodic": "repeat", "constant": "black"}
SPACES = {"raw": "linear", "sRGB": "srgb", "srgb_texture": "srgb", "srgb_rec709_scene": "srgb", "lin_rec709": "linear",
          "lin_rec709_scene": "linear", "acescg": "acescg", "lin_ap1": "acescg", "lin_ap1_scene": "acescg", "none": "linear",
          "lin_ap0": "aces2065-1", "lin_ap0_scene": "aces2065-1", "data": "linear", "identity": "linear"}
MAX_DEPTH = 32


@dataclasses.dataclass
class Texture:
    """A file, read at `place`; its value is texel * scale + bias, of which `channel` is taken (None: the colour)."""
    file: str
    place: Placement = dataclasses.field(default_factory=Placement)
    scale: np.ndarray = dataclasses.field(default_factory=lambda: np.ones(4))
    bias: np.ndarray = dataclasses.field(default_factory=lambda: np.zeros(4))
    channel: str | None = None
    color_space: str | None = None  # as in scene files; None: nothing is said
    wrap: str = "repeat"
    keys: dict = dataclasses.field(default_factory=dict)  # of the scene file, as relief: attributes have them

    def times(self, factor) -> Texture:
        factor = spread(factor)
        return dataclasses.replace(self, scale=self.scale * factor, bias=self.bias * factor)

    def plus(self, offset) -> Texture:
        return dataclasses.replace(self, bias=self.bias + spread(offset))

    def pick(self, channel: str) -> Texture:
        if self.channel is not None:
            return self
        number = "rgba".find(channel)
        scale, bias = (self.scale, self.bias) if number < 0 else (spread(self.scale[number]), spread(self.bias[number]))
        return dataclasses.replace(self, channel=channel, scale=scale, bias=bias)


def spread(value) -> np.ndarray:
    """A number, a colour or a colour with alpha as four numbers."""
    value = np.array(value, np.float64).reshape(-1)
    if len(value) == 1:
        return np.repeat(value, 4)
    return np.concatenate([value, np.ones(4 - len(value))]) if len(value) < 4 else value


class Network:
    """Reads the shaders of one material; what it does not know goes into the report under the material."""

    def __init__(self, context: Context, material: Usd.Prim) -> None:
        self.context, self.material = context, material

    def note(self, text: str) -> None:
        self.context.report.add(self.material, text)

    def read(self, shader: UsdShade.Shader, name: str, fallback=None, depth: int = 0):
        """A Texture, a number or an array of numbers, or the fallback where nothing is said or known."""
        source = shader.GetInput(name)
        if not source:
            return fallback
        attributes = UsdShade.Utils.GetValueProducingAttributes(source)
        if not attributes:
            return fallback
        attribute = attributes[0]
        if not UsdShade.Output.IsOutput(attribute):
            return to_constant(self.context.get(attribute), fallback)
        if depth > MAX_DEPTH:
            self.note(f"the network of {name} is too deep")
            return fallback
        node = UsdShade.Shader(attribute.GetPrim())
        found = self.read_node(node, UsdShade.Output(attribute).GetBaseName(), depth + 1)
        return fallback if found is None else found

    def is_connected(self, shader: UsdShade.Shader, name: str) -> bool:
        source = shader.GetInput(name)
        return bool(source) and source.HasConnectedSource()

    def read_node(self, node: UsdShade.Shader, output: str, depth: int):
        identifier = node.GetIdAttr().Get() or ""
        kind = identifier.removeprefix("ND_").split("_")[0]
        reader = READERS.get(kind)
        if reader is None:
            self.note(f"shader {identifier or node.GetPrim().GetName()} is not taken over")
            return None
        return reader(self, node, output, depth)

    def find_file_attribute(self, node: UsdShade.Shader):
        attributes = UsdShade.Utils.GetValueProducingAttributes(node.GetInput("file")) if node.GetInput("file") else []
        return attributes[0] if attributes else None


def to_constant(value, fallback):
    if value is None or isinstance(value, str):
        return fallback
    array = np.array(value, np.float64)
    return float(array) if array.ndim == 0 else array.reshape(-1)


def is_texture(value) -> bool:
    return isinstance(value, Texture)


def read_texture(network: Network, node: UsdShade.Shader, default_space: str | None):
    """The part that all nodes of images share; None without a file."""
    attribute = network.find_file_attribute(node)
    file = resolve_asset(network.context, attribute) if attribute else None
    if file is None:
        named = getattr(attribute.Get(network.context.time), "path", "") if attribute else ""
        network.note(f"there is no texture {named}" if named else "a texture has no file")
        return None
    prim = node.GetPrim()
    keys = {name: prim.GetAttribute(f"relief:{name}").Get() for name in ("filter", "channel", "color_space")
            if prim.GetAttribute(f"relief:{name}")}
    space = keys.pop("color_space", None) or SPACES.get(attribute.GetColorSpace(), default_space)
    texture = Texture(file, read_placement(network, node), color_space=space, keys=keys)
    return texture.pick(keys.pop("channel")) if "channel" in keys else texture


def read_wrap(network: Network, node: UsdShade.Shader, names: tuple) -> str:
    found = []
    for name in names:
        source = node.GetInput(name)
        attributes = UsdShade.Utils.GetValueProducingAttributes(source) if source else []
        value = network.context.get(attributes[0]) if attributes else None
        found.append(WRAPS.get(value, "repeat"))
    if found[0] != found[1]:
        network.note(f"a texture has one wrap for both axes: {found[0]}")
    return found[0]


def read_uv_texture(network: Network, node: UsdShade.Shader, output: str, depth: int):
    space = node.GetInput("sourceColorSpace")
    attributes = UsdShade.Utils.GetValueProducingAttributes(space) if space else []
    said = network.context.get(attributes[0], "auto") if attributes else "auto"
    texture = read_texture(network, node, SPACES.get(said))
    if texture is None:
        fallback = network.read(node, "fallback", None, depth)
        return None if fallback is None else take(fallback, output)
    texture.wrap = read_wrap(network, node, ("wrapS", "wrapT"))
    texture = texture.times(constant_of(network, node, "scale", 1, depth)).plus(constant_of(network, node, "bias", 0, depth))
    return texture.pick(output) if output in ("r", "g", "b", "a") else texture


def constant_of(network: Network, node: UsdShade.Shader, name: str, fallback, depth: int):
    value = network.read(node, name, fallback, depth)
    if is_texture(value):
        network.note(f"{name} of a texture that is itself a texture is left out")
        return fallback
    return value


def take(value, output: str):
    """The output of a node of a constant."""
    if is_texture(value):
        return value.pick(output)
    number = "rgba".find(output[-1:]) if output[:-1] in ("", "out") else -1
    if number < 0:
        number = "xyzw".find(output[-1:]) if output[:-1] in ("", "out") else -1
    array = np.array(value).reshape(-1)
    return float(array[number]) if 0 <= number < len(array) else value


def read_image(network: Network, node: UsdShade.Shader, output: str, depth: int):
    texture = read_texture(network, node, None)
    if texture is None:
        return network.read(node, "default", None, depth)
    texture.wrap = read_wrap(network, node, ("uaddressmode", "vaddressmode"))
    identifier = node.GetIdAttr().Get()
    return texture.pick("r") if identifier.endswith("_float") else texture


def pass_on(name: str):
    return lambda network, node, output, depth: network.read(node, name, None, depth)


def read_arithmetic(network: Network, node: UsdShade.Shader, output: str, depth: int):
    kind = node.GetIdAttr().Get().removeprefix("ND_").split("_")[0]
    neutral = 0.0 if kind in ("add", "subtract") else 1.0
    first, second = (network.read(node, name, neutral, depth) for name in ("in1", "in2"))
    if is_texture(second) and kind in ("add", "multiply"):
        first, second = second, first
    if is_texture(second):
        network.note(f"shader {kind} of two textures is not taken over: its first one is used")
        return first if is_texture(first) else second
    if kind == "divide":
        second = 1 / np.where(np.array(second) == 0, np.inf, second)
    if kind == "subtract":
        second = -np.array(second)
    if is_texture(first):
        return first.plus(second) if neutral == 0 else first.times(second)
    return np.add(first, second) if neutral == 0 else np.multiply(first, second)


def read_extract(network: Network, node: UsdShade.Shader, output: str, depth: int):
    value, index = network.read(node, "in", None, depth), int(network.read(node, "index", 0, depth))
    if is_texture(value):
        return value.pick("rgba"[index])
    return None if value is None else float(np.array(value).reshape(-1)[index])


def read_separate(network: Network, node: UsdShade.Shader, output: str, depth: int):
    value = network.read(node, "in", None, depth)
    if value is None:
        return None
    return take(value, {"x": "r", "y": "g", "z": "b", "w": "a"}.get(output[-1], output[-1]))


def read_luminance(network: Network, node: UsdShade.Shader, output: str, depth: int):
    value = network.read(node, "in", None, depth)
    if is_texture(value):
        return value.pick("luminance")
    return value if value is None else float(np.dot(np.array(value).reshape(-1)[:3], [0.2126, 0.7152, 0.0722]))


def read_normal_map(network: Network, node: UsdShade.Shader, output: str, depth: int):
    """Texels of a normal map as directions: 2 value - 1, x and y times the scale."""
    value = network.read(node, "in", None, depth)
    if not is_texture(value):
        return None
    size = constant_of(network, node, "scale", 1, depth)
    factor = np.ones(4)
    factor[:2] = np.array(size).reshape(-1)[:2] if np.ndim(size) else size
    return value.times(2).plus(-1).times(factor)


def read_mix(network: Network, node: UsdShade.Shader, output: str, depth: int):
    front, back = (network.read(node, name, 0.0, depth) for name in ("fg", "bg"))
    share = network.read(node, "mix", 0.0, depth)
    if is_texture(share) or ((is_texture(front) or is_texture(back)) and share not in (0, 1)):
        network.note("shader mix of textures is not taken over: its background is used")
        return back
    if share in (0, 1):
        return front if share == 1 else back
    return np.array(front) * share + np.array(back) * (1 - share)


def read_primvar(network: Network, node: UsdShade.Shader, output: str, depth: int):
    network.note("values of primvars are not taken over, but for uvs")
    return network.read(node, "fallback", network.read(node, "default", None, depth), depth)


READERS = {"UsdUVTexture": read_uv_texture, "image": read_image, "tiledimage": read_image, "constant": pass_on("value"),
           "dot": pass_on("in"), "convert": pass_on("in"), "clamp": pass_on("in"), "multiply": read_arithmetic,
           "add": read_arithmetic, "subtract": read_arithmetic, "divide": read_arithmetic, "extract": read_extract,
           "separate2": read_separate, "separate3": read_separate, "separate4": read_separate,
           "luminance": read_luminance, "normalmap": read_normal_map, "mix": read_mix, "UsdPrimvarReader": read_primvar,
           "geompropvalue": read_primvar, "geomcolor": read_primvar}
