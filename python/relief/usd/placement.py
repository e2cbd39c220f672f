"""Where a texture lies on the uv plane: what feeds its st input."""
from __future__ import annotations

import dataclasses

import numpy as np
from pxr import UsdShade


@dataclasses.dataclass
class Placement:
    """Texels are read at scale * uv + offset, of the uvs of the name."""
    scale: np.ndarray = dataclasses.field(default_factory=lambda: np.ones(2))
    offset: np.ndarray = dataclasses.field(default_factory=lambda: np.zeros(2))
    uvs: str | None = None

    def then(self, scale, offset) -> Placement:
        scale = np.broadcast_to(np.array(scale, np.float64), 2)
        return Placement(self.scale * scale, self.offset * scale + offset, self.uvs)


def read_placement(network, node: UsdShade.Shader) -> Placement:
    """Of a node of an image, by its input st or texcoord and its own tiling."""
    place = read_coordinates(network, node, "st" if node.GetInput("st") else "texcoord", 0)
    if "tiledimage" in (node.GetIdAttr().Get() or ""):
        place = place.then(network.read(node, "uvtiling", np.ones(2)), 0)
        place = place.then(1, -np.array(network.read(node, "uvoffset", np.zeros(2))))
    return place


def read_text(network, node: UsdShade.Shader, name: str) -> str | None:
    source = node.GetInput(name)
    attributes = UsdShade.Utils.GetValueProducingAttributes(source) if source else []
    value = network.context.get(attributes[0]) if attributes else None
    return str(value) if value else None


def read_coordinates(network, node: UsdShade.Shader, name: str, depth: int) -> Placement:
    source = node.GetInput(name)
    attributes = UsdShade.Utils.GetValueProducingAttributes(source) if source else []
    if not attributes or not UsdShade.Output.IsOutput(attributes[0]) or depth > 16:
        return Placement()
    before = UsdShade.Shader(attributes[0].GetPrim())
    kind = (before.GetIdAttr().Get() or "").removeprefix("ND_").split("_")[0]
    if kind == "UsdPrimvarReader":
        return Placement(uvs=read_text(network, before, "varname"))
    if kind == "geompropvalue":
        return Placement(uvs=read_text(network, before, "geomprop"))
    if kind == "texcoord":
        index = int(network.read(before, "index", 0))
        return Placement(uvs=f"st{index}" if index else None)
    if kind in ("UsdTransform2d", "place2d"):
        return transform(network, before, kind, depth)
    if kind in ("multiply", "add", "subtract"):
        place = read_coordinates(network, before, "in1", depth + 1)
        by = network.read(before, "in2", 1.0 if kind == "multiply" else 0.0)
        return place.then(by, 0) if kind == "multiply" else place.then(1, np.array(by) * (1 if kind == "add" else -1))
    network.note(f"shader {kind} between uvs and a texture is not taken over")
    return Placement()


def transform(network, node: UsdShade.Shader, kind: str, depth: int) -> Placement:
    is_usd = kind == "UsdTransform2d"
    place = read_coordinates(network, node, "in" if is_usd else "texcoord", depth + 1)
    angle = network.read(node, "rotation" if is_usd else "rotate", 0.0)
    scale = np.array(network.read(node, "scale", np.ones(2)))
    if angle:
        network.note("rotation of a texture is not taken over")
    if is_usd:
        return place.then(scale, np.array(network.read(node, "translation", np.zeros(2))))
    pivot = np.array(network.read(node, "pivot", np.zeros(2)))
    inverse = 1 / np.where(scale == 0, 1, scale)
    return place.then(inverse, pivot - pivot * inverse - np.array(network.read(node, "offset", np.zeros(2))))
