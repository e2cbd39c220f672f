"""UsdPreviewSurface as OpenPBR."""
from __future__ import annotations

import numpy as np
from pxr import UsdShade

from .material_keys import KeySetter
from .shading import Network, is_texture, spread


def read_preview_surface(network: Network, shader: UsdShade.Shader, setter: KeySetter) -> None:
    setter.color("base_color", network.read(shader, "diffuseColor", np.array([0.18, 0.18, 0.18])))
    setter.number("specular_roughness", network.read(shader, "roughness", 0.5))
    setter.plain_number("specular_ior", network.read(shader, "ior", 1.5), 1, 100)
    if network.read(shader, "useSpecularWorkflow", 0) == 1:
        read_specular_color(network, shader, setter)
    else:
        setter.number("base_metalness", network.read(shader, "metallic", 0.0))
    read_clearcoat(network, shader, setter)
    emissive = network.read(shader, "emissiveColor", np.zeros(3))
    setter.emission(1.0, emissive)
    setter.normal(network.read(shader, "normal"))
    read_opacity(network, shader, setter)
    if network.is_connected(shader, "occlusion"):
        network.note("occlusion is left out: rays find it")


def read_specular_color(network: Network, shader: UsdShade.Shader, setter: KeySetter) -> None:
    """The ior of the reflection at normal incidence that the colour says, and the colour relative to its largest part."""
    color = network.read(shader, "specularColor", np.zeros(3))
    if is_texture(color):
        network.note("texture of specularColor is not taken over")
        return
    color = np.clip(spread(color)[:3], 0, 1)
    largest = min(float(color.max()), 0.98)
    if largest <= 0:
        setter.keys["specular_weight"] = 0.0
        return
    root = np.sqrt(largest)
    setter.keys["specular_ior"] = float((1 + root) / (1 - root))
    setter.color("specular_color", color / color.max())
    network.context.report.note(network.material, "specular workflow is a dielectric of that reflection at normal incidence")


def read_clearcoat(network: Network, shader: UsdShade.Shader, setter: KeySetter) -> None:
    """Of the ior of the base, and without OpenPBR's darkening, which UsdPreviewSurface does not have."""
    weight = network.read(shader, "clearcoat", 0.0)
    if not is_texture(weight) and weight == 0:
        return
    setter.number("coat_weight", weight)
    setter.number("coat_roughness", network.read(shader, "clearcoatRoughness", 0.01))
    setter.keys["coat_ior"] = setter.keys.get("specular_ior", 1.5)
    setter.keys["coat_darkening"] = 0.0


def read_opacity(network: Network, shader: UsdShade.Shader, setter: KeySetter) -> None:
    opacity = network.read(shader, "opacity", 1.0)
    threshold = network.read(shader, "opacityThreshold", 0.0)
    threshold = 0.0 if is_texture(threshold) else float(threshold)
    if is_texture(opacity):
        if threshold > 0:
            network.note("opacityThreshold is left out: its texture is the part of rays that is stopped")
        setter.number("geometry_opacity", opacity)
        return
    opacity = float(np.array(opacity).reshape(-1)[0])
    if threshold > 0:
        opacity = 1.0 if opacity >= threshold else 0.0
    elif opacity < 1:
        network.context.report.note(network.material, "opacity is the part of rays that the surface stops, reflections included")
    if opacity < 1:
        setter.number("geometry_opacity", opacity)
