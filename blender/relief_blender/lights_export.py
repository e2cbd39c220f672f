"""Blender's lights as Relief's, as bright as in Cycles.

Powers are in watts: a point light of power P sends P / (4 pi) into each direction, an area light has the radiance
P / (pi A). A sun has its irradiance."""
import math

import numpy as np
import relief

from . import axes
from .node_tree import NotExpressible, Wire, find_output, follow
from .node_values import NodeValues
from .textures import LARGEST
from .values import Constant

ELLIPSE_TEXELS = 256
LEAST, MOST = 1e-18, 1e18  # lengths that Relief takes


def find_color(light, report):
    """Colour times 2^exposure, temperature and the node Emission, strength included."""
    color = np.array(light.color, float) * 2.0 ** getattr(light, "exposure", 0.0)
    if getattr(light, "use_temperature", False):
        color = color * np.array(light.temperature_color, float)
    if not light.use_nodes or light.node_tree is None:
        return color
    try:
        output = find_output(light.node_tree)
        source = follow(Wire(output.inputs["Surface"])) if output else None
        if source is None or source.node is None or source.node.bl_idname != "ShaderNodeEmission":
            raise NotExpressible("its nodes are not an Emission alone")
        values = NodeValues(report)
        emission = values.color(source.input("Color"))
        if not isinstance(emission, Constant):
            raise NotExpressible("a texture of its emission")
        return color * emission.rgb * values.constant(source.input("Strength"))
    except NotExpressible as fault:
        report(f"{fault}: its own colour and power are used")
        return color


def make_mask():
    """An ellipse that fills a square picture, edges smoothed."""
    at = (np.arange(ELLIPSE_TEXELS) + 0.5) / ELLIPSE_TEXELS * 2 - 1
    distance = np.hypot(*np.meshgrid(at, at))
    mask = np.clip((1 - distance) * ELLIPSE_TEXELS / 2 + 0.5, 0, 1)
    return np.repeat(mask[..., None], 3, -1).astype(np.float32)


def make_area(light, matrix, strength, report):
    """A rectangle or disk; an ellipse is a rectangle with a mask."""
    scale = axes.find_axis_scale(matrix)
    is_round = light.shape in {"DISK", "ELLIPSE"}
    width = light.size * scale[0]
    height = (light.size if light.shape in {"SQUARE", "DISK"} else light.size_y) * scale[1]
    area = width * height * (math.pi / 4 if is_round else 1)
    if not getattr(light, "normalize", True):
        strength *= area
    if getattr(light, "spread", math.pi) < math.pi - 1e-3:
        report("its spread is left out: it shines to all sides of its face")
    keys = {"strength": strength / math.pi, "direction": (-matrix[:3, 2]).tolist(), "up": matrix[:3, 1].tolist()}
    if is_round and abs(width - height) < 1e-4 * height:
        keys.pop("up")
        return relief.Light(type="disk", radius=width / 2, **keys)
    if is_round:
        keys.update(strength=keys["strength"] * 4 / math.pi, color_texture=make_mask())
    return relief.Light(type="rectangle", width=width, height=height, **keys)


def make_spot(light, matrix, strength):
    """Cycles fades over part of the cosine, Relief over part of the angle."""
    half = light.spot_size / 2
    edge = math.acos(min(math.cos(half) + (1 - math.cos(half)) * light.spot_blend, 1.0))
    angle_degrees = min(max(math.degrees(light.spot_size), 0.001), 180.0)  # 180 is more in 32 bits
    return relief.Light(type="spot", direction=(-matrix[:3, 2]).tolist(), angle_degrees=angle_degrees, blend=1 - edge / half,
                        radius=light.shadow_soft_size, strength=strength / (4 * math.pi))


def make_light(light, matrix_world, report):
    """A relief.Light of a bpy.types.Light. `report` takes a text."""
    matrix = axes.convert_matrix(matrix_world)
    color = find_color(light, report)
    strength = float(light.energy) * float(color.max(initial=0))
    color = (color / color.max()).tolist() if 0 < color.max() < math.inf else [0, 0, 0]
    if strength < 0:
        report("a negative light is left out")
        strength = 0.0
    if light.type == "SUN":
        if not getattr(light, "normalize", True):
            strength *= math.pi * math.sin(light.angle / 2) ** 2
        result = relief.Light(type="sun", direction=(-matrix[:3, 2]).tolist(), strength=strength,
                              angle_degrees=min(math.degrees(light.angle), 90.0))
    elif light.type == "AREA":
        result = make_area(light, matrix, strength, report)
    else:
        radius = light.shadow_soft_size
        if not getattr(light, "normalize", True):
            strength *= 4 * math.pi * radius * radius
        result = make_spot(light, matrix, strength) if light.type == "SPOT" else relief.Light(
            type="point", radius=radius, strength=strength / (4 * math.pi))
    if light.type != "SUN":
        result["position"] = matrix[:3, 3].tolist()
    result["color"] = color
    return result


def is_finite(light):
    """Whether all numbers of a relief.Light are."""
    numbers = [light[key] for key in ("strength", "radius", "width", "height") if key in light]
    numbers += [v for key in ("color", "position", "direction", "up") for v in light.get(key, ())]
    return bool(np.all(np.abs(numbers) < LARGEST))


def find_fault(light):
    """Why a relief.Light cannot be rendered, or ""."""
    if not is_finite(light):
        return "its power, colour, size or transform is not finite"
    sizes = [light[key] for key in ("width", "height") if key in light]
    if light["type"] == "disk":
        sizes.append(light["radius"])
    if not all(LEAST <= size <= MOST for size in sizes):
        return "its face has no area"
    if any(key in light and np.linalg.norm(light[key]) < LEAST for key in ("direction", "up")):
        return "it has no direction by its scale"
    return ""


def find_links(light_object):
    """(included, excluded) names of objects by light linking; those of a collection in it are what the collection is."""
    collection = light_object.light_linking.receiver_collection
    if collection is None:
        return [], []
    states = [(ob.name_full, entry.light_linking.link_state)
              for ob, entry in zip(collection.objects, collection.collection_objects)]
    for child, entry in zip(collection.children, collection.collection_children):
        states += [(ob.name_full, entry.light_linking.link_state) for ob in child.all_objects]
    return [n for n, s in states if s == "INCLUDE"], [n for n, s in states if s == "EXCLUDE"]


def link_light(light, light_object, names):
    """Adds the keys of light linking once all objects are in the scene, as keys may name those alone.

    names: {name of an object or instancer of Blender: names of the objects of the scene that it is}."""
    included, excluded = find_links(light_object)
    lit, unlit = ([own for name in linked for own in names.get(name, ())] for linked in (included, excluded))
    if included and not lit:  # an empty list would be all of them
        unlit = [own for owns in names.values() for own in owns]
    for key, linked in (("light_link_includes", lit), ("light_link_excludes", unlit)):
        if linked:
            light[key] = list(dict.fromkeys(linked))


def is_portal(light):
    """Of an area light with Cycles' Portal, which marks a window."""
    return light.type == "AREA" and bool(getattr(getattr(light, "cycles", None), "is_portal", False))


def export_light(light_object, matrix_world, report):
    """The relief.Light of a light, without its links; None where it cannot be rendered."""
    name = light_object.original.name_full

    def tell(text):
        report.add("light", name, text)
    if is_portal(light_object.data):
        tell("a portal gives no light of its own: it is left out, and guides no rays to the world")
        return None
    result = make_light(light_object.data, matrix_world, tell)
    fault = find_fault(result)
    if fault:
        tell(f"{fault}: it is left out")
        return None
    result["visible_to_camera"] = bool(light_object.original.visible_camera)
    hidden = [name for name in ("diffuse", "glossy", "transmission")
              if not getattr(light_object.original, f"visible_{name}", True)]
    if hidden:
        tell(f"ray visibility ({', '.join(hidden)}) is left out: it lights all")
    if not light_object.data.use_shadow:
        tell("a light without shadows has shadows")
    if light_object.original.light_linking.blocker_collection is not None:
        tell("shadow linking is left out: all objects throw shadows in its light")
    return result
