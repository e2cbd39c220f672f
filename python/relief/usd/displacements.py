"""Displacement maps: of UsdPreviewSurface, of MaterialX, and what relief:displacement attributes say."""
from __future__ import annotations

import numpy as np
from pxr import Usd, UsdShade

from .assets import resolve_asset
from .shading import Network, Texture, is_texture

PREFIX = "relief:displacement:"
KEYS = ("file", "layer", "part", "name", "uvs", "type", "preset", "space", "axes", "frame", "lengths", "encoding", "midlevel", "scale", "flip_v",
        "wrap", "dilate", "filter", "dequantize", "autobump")
# What MaterialX says of a vector: dP/du, dP/dv and the normal.
TANGENT = {"space": "tangent", "axes": "t,b,n", "frame": "dpdu", "lengths": "relative"}
OBJECT = {"space": "object", "axes": "x,y,z"}


def read_displacement(network: Network, material: UsdShade.Material) -> dict | None:
    """Keys of the scene file, and `uvs`: the uv set; None where nothing is displaced."""
    noted = read_noted(network.context, material.GetPrim())
    if noted is not None:
        return noted
    shader, output = find_shader(material)
    if shader is None:
        return None
    identifier = shader.GetIdAttr().Get() or ""
    if identifier == "UsdPreviewSurface" or identifier.startswith("ND_UsdPreviewSurface"):
        return read_height(network, network.read(shader, "displacement", 0.0), 1.0)
    if identifier.startswith("ND_displacement_"):
        scale = network.read(shader, "scale", 1.0)
        if is_texture(scale):
            network.note("texture of the scale of a displacement is left out")
            scale = 1.0
        value = network.read(shader, "displacement", 0.0)
        if identifier == "ND_displacement_float":
            return read_height(network, value, float(scale))
        return read_vector(network, value, float(scale))
    network.note(f"displacement {identifier} is not taken over")
    return None


def find_shader(material: UsdShade.Material):
    """The displacement of MaterialX or of all renderers, else the surface of UsdPreviewSurface, which has one inside."""
    for render_context in ("mtlx", ""):
        found = material.ComputeDisplacementSource(render_context)
        if found[0]:
            return found[0], found[1]
    found = material.ComputeSurfaceSource()
    shader = found[0]
    if shader and shader.GetIdAttr().Get() == "UsdPreviewSurface" and shader.GetInput("displacement"):
        return shader, found[1]
    return None, None


def make_keys(network: Network, texture: Texture) -> dict:
    """Keys of height and vector maps; those of the texture's place on the uvs cannot be kept."""
    if not (np.array_equal(texture.place.scale, [1, 1]) and np.array_equal(texture.place.offset, [0, 0])):
        network.note("uv transform of the displacement map is left out")
    keys = {"file": texture.file, "uvs": texture.place.uvs}
    if "<" not in texture.file:
        keys["wrap"] = texture.wrap
    if "filter" in texture.keys:
        keys["filter"] = texture.keys["filter"]
    return keys


def read_height(network: Network, value, scale: float) -> dict | None:
    """scale * texel + bias is scale * (texel - midlevel), of the first channel."""
    if not is_texture(value):
        if value is not None and np.array(value).reshape(-1)[0] != 0:
            network.note("a displacement without a map is not taken over")
        return None
    if value.channel not in (None, "r"):
        network.note(f"channel {value.channel} of the displacement map is left out: r is read")
    factor = value.scale[0] * scale
    if factor == 0:
        return None
    keys = make_keys(network, value)
    return {**keys, "type": "height", "encoding": "float", "scale": float(factor), "midlevel": float(-value.bias[0] * scale / factor)}


def read_vector(network: Network, value, scale: float) -> dict | None:
    if not is_texture(value):
        if value is not None and np.any(np.array(value) != 0):
            network.note("a displacement without a map is not taken over")
        return None
    factor = value.scale[:3] * scale
    if not np.all(factor):
        network.note("a displacement along two axes alone is left out")
        return None
    keys = make_keys(network, value)
    meaning = TANGENT if network.context.options.vector_space == "tangent" else OBJECT
    midlevel = -value.bias[:3] * scale / factor
    return {**keys, "type": "vector", "encoding": "float", **meaning, "scale": simplify(factor), "midlevel": simplify(midlevel)}


def simplify(values: np.ndarray):
    values = [float(v) + 0.0 for v in values]
    return values[0] if len(set(values)) == 1 else values


def read_noted(context, prim: Usd.Prim) -> dict | None:
    """What attributes relief:displacement:KEY of a prim say, of the keys of the scene file; `file` is an asset."""
    keys: dict = {}
    for attribute in prim.GetAuthoredPropertiesInNamespace(PREFIX.rstrip(":")):
        name, value = attribute.GetName()[len(PREFIX):], attribute.Get(context.time)
        if name == "file":
            value = resolve_asset(context, attribute)
            if value is None:
                context.report.add(prim, f"there is no displacement map {getattr(attribute.Get(), 'path', '')}")
                return None
        elif value is None:
            context.report.add(prim, f"{attribute.GetName()} has no value")
            continue
        else:
            value = read_key(context, attribute, name)
        keys[name] = value
    return keys if "file" in keys else None


def read_key(context, attribute: Usd.Attribute, name: str):
    """A word, a number, or three."""
    if name not in KEYS:
        context.fail(attribute.GetPrim(), f"{attribute.GetName()} is no key of a displacement", f"known: {', '.join(KEYS)}")
    value = context.get(attribute)
    if isinstance(value, (str, bool, int, float)):
        return value
    array = np.array(value, np.float64)
    if array.shape != (3,) or not np.isfinite(array).all():
        context.fail(attribute.GetPrim(), f"{attribute.GetName()} is {value}", "it has to be a number, or three")
    return array.tolist()


def find_noted(context, prim: Usd.Prim) -> dict | None:
    """The same of a mesh or of the nearest of its ancestors that has them."""
    while prim and not prim.IsPseudoRoot():
        found = read_noted(context, prim)
        if found is not None:
            return found
        prim = prim.GetParent()
    return None
