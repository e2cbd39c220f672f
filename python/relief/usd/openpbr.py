"""OpenPBR and the standard surface of MaterialX."""
from __future__ import annotations

import numpy as np
import relief
from pxr import UsdShade

from .material_keys import KeySetter
from .shading import Network, is_texture, spread

# Emission, opacity and the inside of glass are read by functions of their own.
ROWS = [row for row in relief.material_inputs() if not row["name"].startswith(("emission_", "geometry_"))]
# The defaults of OpenPBR's inputs by name; Relief has another roughness.
NUMBERS = {**{row["name"]: row["default"] for row in ROWS if row["type"] == "number" and row["is_textured"]},
           "specular_roughness": 0.3}
COLORS = {row["name"]: row["default"][0] for row in ROWS if row["type"] == "color"}
ANISOTROPY = tuple(row["name"] for row in ROWS if row["name"].endswith("_anisotropy"))
PLAIN = {row["name"]: row["default"] for row in ROWS if row["type"] == "number" and row["low"] == 1}
# Inputs of no effect at their values here, that Relief does not have.
MISSING = {"subsurface_weight": 0.0, "thin_film_weight": 0.0, "transmission_dispersion_scale": 0.0}
# Names of the standard surface for those of OpenPBR; values where they differ by default.
STANDARD = {"base_weight": ("base", 1.0), "base_diffuse_roughness": ("diffuse_roughness", 0.0),
            "base_metalness": ("metalness", 0.0), "specular_weight": ("specular", 1.0),
            "specular_roughness": ("specular_roughness", 0.2), "coat_weight": ("coat", 0.0),
            "coat_roughness": ("coat_roughness", 0.1), "fuzz_weight": ("sheen", 0.0), "fuzz_roughness": ("sheen_roughness", 0.3),
            "transmission_weight": ("transmission", 0.0)}
STANDARD_COLORS = {"base_color": ("base_color", 0.8), "specular_color": ("specular_color", 1.0), "coat_color": ("coat_color", 1.0),
                   "fuzz_color": ("sheen_color", 1.0), "transmission_color": ("transmission_color", 1.0)}
STANDARD_MISSING = {"subsurface": 0.0, "specular_anisotropy": 0.0, "coat_anisotropy": 0.0, "thin_film_thickness": 0.0,
                    "transmission_dispersion": 0.0, "transmission_extra_roughness": 0.0, "coat_affect_color": 0.0,
                    "coat_affect_roughness": 0.0}


def read_open_pbr(network: Network, shader: UsdShade.Shader, setter: KeySetter) -> None:
    for name, default in NUMBERS.items():
        setter.number(name, network.read(shader, name, default))
    for name, default in COLORS.items():
        setter.color(name, network.read(shader, name, default))
    for name, default in PLAIN.items():
        setter.plain_number(name, network.read(shader, name, default), 1, 100)
    for name in ANISOTROPY:
        setter.plain_number(name, network.read(shader, name, 0.0))
    read_inside(network, shader, setter, "geometry_thin_walled")
    luminance = network.read(shader, "emission_luminance", 0.0)
    setter.emission(luminance, network.read(shader, "emission_color", 1.0))
    read_opacity(setter, network.read(shader, "geometry_opacity", 1.0))
    setter.normal(network.read(shader, "geometry_normal"))
    note_missing(network, shader, MISSING)
    note_normals(network, shader, ("geometry_coat_normal",))
    drop_defaults(setter)


def read_standard_surface(network: Network, shader: UsdShade.Shader, setter: KeySetter) -> None:
    for name, (other, default) in STANDARD.items():
        setter.number(name, network.read(shader, other, default))
    for name, (other, default) in STANDARD_COLORS.items():
        setter.color(name, network.read(shader, other, default))
    keep_metal(network, setter)
    setter.plain_number("specular_ior", network.read(shader, "specular_IOR", 1.5), 1, 100)
    setter.plain_number("coat_ior", network.read(shader, "coat_IOR", 1.5), 1, 100)
    setter.keys["coat_darkening"] = 0.0  # OpenPBR's alone
    read_inside(network, shader, setter, "thin_walled")
    setter.emission(network.read(shader, "emission", 0.0), network.read(shader, "emission_color", 1.0))
    read_opacity(setter, network.read(shader, "opacity", 1.0))
    setter.normal(network.read(shader, "normal"))
    note_missing(network, shader, STANDARD_MISSING)
    note_normals(network, shader, ("coat_normal",))
    drop_defaults(setter)


def keep_metal(network: Network, setter: KeySetter) -> None:
    """`specular` is of the dielectric alone, OpenPBR's weight of metals as well."""
    metal = setter.keys.get("base_metalness")
    if metal == 0 or setter.keys.get("specular_weight") == 1:
        return
    if metal != 1:
        network.note("specular of a surface that is in part metal is taken as 1")
    setter.keys["specular_weight"] = 1.0


def read_opacity(setter: KeySetter, opacity) -> None:
    """A number, or a colour of which the luminance counts."""
    if is_texture(opacity):
        setter.number("geometry_opacity", opacity if opacity.channel else opacity.pick("luminance"))
        return
    parts = np.array(opacity).reshape(-1)
    value = float(parts[0] if len(parts) == 1 else np.dot(parts[:3], [0.2126, 0.7152, 0.0722]))
    if value < 0.9999:
        setter.number("geometry_opacity", value)


def read_inside(network: Network, shader: UsdShade.Shader, setter: KeySetter, thin: str) -> None:
    setter.plain_number("transmission_depth", network.read(shader, "transmission_depth", 0.0), 0, 1e18)
    if network.read(shader, thin, 0.0) == 1:
        setter.keys["geometry_thin_walled"] = True
    scatter = network.read(shader, "transmission_scatter", 0.0)
    if is_texture(scatter) or spread(scatter)[:3].max() > 0:
        network.note("scattering within glass is not taken over")


def note_missing(network: Network, shader: UsdShade.Shader, inputs: dict) -> None:
    for name, neutral in inputs.items():
        value = network.read(shader, name, neutral)
        if is_texture(value) or spread(value)[0] != neutral:
            network.note(f"{name} is not taken over")


def note_normals(network: Network, shader: UsdShade.Shader, names: tuple) -> None:
    for name in names:
        if is_texture(network.read(shader, name)):
            network.note(f"{name} is not taken over")


def drop_defaults(setter: KeySetter) -> None:
    """Keys at Relief's own defaults, and those of parts that are not there."""
    keys = setter.keys
    for part in ("coat", "fuzz", "transmission"):
        if keys.get(f"{part}_weight") == 0:
            for name in [name for name in keys if name.startswith(f"{part}_")]:
                del keys[name]
    if keys.get("coat_weight") is None:
        keys.pop("coat_darkening", None)
    defaults = {**{name: 0.0 for name in ANISOTROPY}, "base_weight": 1.0, "base_diffuse_roughness": 0.0, "base_metalness": 0.0, "specular_weight": 1.0,
                "specular_ior": 1.5, "specular_color": [1.0, 1.0, 1.0], "coat_color": [1.0, 1.0, 1.0],
                "fuzz_color": [1.0, 1.0, 1.0], "coat_ior": 1.6, "coat_darkening": 1.0, "transmission_depth": 0.0,
                "transmission_color": [1.0, 1.0, 1.0]}
    for name, value in defaults.items():
        if keys.get(name) == value:
            del keys[name]
