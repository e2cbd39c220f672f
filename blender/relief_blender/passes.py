"""Layers of Relief as passes of Blender: names, channels, axes."""
from typing import NamedTuple

import bpy
import numpy as np

from .axes import convert_back

HAS_LONG_NAMES = bpy.app.version >= (5, 0)  # of passes, which Cycles has there as well
NO_DEPTH = 1e10  # what Blender has where nothing is hit


class Pass(NamedTuple):
    """A pass of Blender, the switch of the view layer that wants it, and the layer that it is made of."""
    name: str
    switch: str
    channels: int
    chan_id: str
    kind: str
    layer: str


PASSES = [
    Pass("Depth", "use_pass_z", 1, "Z", "VALUE", "depth"),
    Pass("Position", "use_pass_position", 3, "XYZ", "VECTOR", "P"),
    Pass("Normal", "use_pass_normal", 3, "XYZ", "VECTOR", "N"),
    Pass("UV", "use_pass_uv", 3, "UVA", "VECTOR", "uv"),
    Pass("Diffuse Color" if HAS_LONG_NAMES else "DiffCol", "use_pass_diffuse_color", 3, "RGB", "COLOR", "albedo"),
    Pass("Emission" if HAS_LONG_NAMES else "Emit", "use_pass_emit", 3, "RGB", "COLOR", "emission"),
    Pass("Environment" if HAS_LONG_NAMES else "Env", "use_pass_environment", 3, "RGB", "COLOR", "background"),
]
MATTES = [("use_pass_cryptomatte_object", "CryptoObject"), ("use_pass_cryptomatte_material", "CryptoMaterial")]
MATTE_RANKS = 3  # pictures of two ranks each
# Of these switches the label of Blender alone would not name the pass.
LABELS = {"denoising_store_passes": "Denoising Data", "pass_debug_sample_count": "Debug Sample Count"}


def wanted_passes(view_layer):
    return [p for p in PASSES if getattr(view_layer, p.switch, False)]


def wanted_mattes(view_layer):
    return [name for switch, name in MATTES if getattr(view_layer, switch, False)]


def register(engine, scene, view_layer):
    """All passes that the view layer wants and Relief makes."""
    engine.register_pass(scene, view_layer, "Combined", 4, "RGBA", "COLOR")
    for p in wanted_passes(view_layer):
        engine.register_pass(scene, view_layer, p.name, p.channels, p.chan_id, p.kind)
    for name in wanted_mattes(view_layer):
        for rank in range(MATTE_RANKS):
            engine.register_pass(scene, view_layer, f"{name}{rank:02}", 4, "RGBA", "COLOR")


def find_layers(view_layer):
    """Names of layers to render."""
    return list(dict.fromkeys([p.layer for p in wanted_passes(view_layer)] + wanted_mattes(view_layer)))


def find_switches(owner):
    """{identifier: label} of the passes that are switched on in a view layer, or in the settings of Cycles for it."""
    if owner is None:
        return {}
    return {p.identifier: LABELS.get(p.identifier, p.name) for p in owner.bl_rna.properties
            if (p.identifier.startswith(("use_pass_", "pass_debug_")) or p.identifier == "denoising_store_passes")
            and p.type == "BOOLEAN" and not p.is_array and getattr(owner, p.identifier)}


def report_missing(view_layer, report):
    """Names what is asked for and not made."""
    made = {p.switch for p in PASSES} | {switch for switch, _ in MATTES}
    made |= {"use_pass_combined", "use_pass_cryptomatte_accurate"}
    wanted = {**find_switches(view_layer), **find_switches(getattr(view_layer, "cycles", None))}
    for switch, label in wanted.items():
        if switch not in made:
            report.add("scene", "", f"the pass {label} is not made")
    for aov in getattr(view_layer, "aovs", ()):
        report.add("scene", "", f'the pass of the shader AOV "{aov.name}" is not made')
    for group in getattr(view_layer, "lightgroups", ()):
        report.add("scene", "", f'the pass of the light group "{group.name}" is not made')


def make_ways(view):
    """(cosines to the view axis, of shape (height, width)) of the middles of a View's pixels."""
    x0, y0, x1, y1 = view.crop
    width, height = view.size
    right, up = view.camera["shift"]
    x = ((np.arange(x0, x1) + 0.5) / height * 2 - width / height + 2 * right) * view.tangent
    y = (1 - (np.arange(y0, y1) + 0.5) / height * 2 + 2 * up) * view.tangent
    return 1 / np.sqrt(1 + x[None, :] ** 2 + y[:, None] ** 2)


def make_depth(depth, view):
    """Depth along the view axis of distances along rays."""
    result = depth * make_ways(view) - view.depth_offset
    return np.where(np.isfinite(result), np.minimum(result, NO_DEPTH), NO_DEPTH)


def make_pass(p, array, view):
    """(height, width, channels) of a layer's array."""
    if p.name == "Depth":
        return make_depth(array.reshape(array.shape[:2]), view)[..., None]
    if p.name in {"Position", "Normal"}:
        return np.where(np.isfinite(array), convert_back(array), 0)
    if p.name == "UV":
        is_hit = np.any(array[..., :2] != 0, -1, keepdims=True)
        return np.concatenate([array[..., :2], is_hit], -1)
    return array[..., :3]


def make_combined(color, is_transparent):
    """Premultiplied RGBA; films that are not transparent are opaque."""
    if is_transparent:
        return color
    result = np.array(color, np.float32)
    result[..., 3] = 1
    return result


def put(render_pass, array):
    """Rows from the bottom; foreach_set alone is fast."""
    flat = np.ascontiguousarray(array[::-1], np.float32).reshape(-1)
    render_pass.rect.foreach_set(flat)
