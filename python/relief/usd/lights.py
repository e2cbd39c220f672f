"""UsdLux lights in Relief's units: suns by their irradiance, all others by their radiant intensity.

A light of UsdLux has the radiance L = intensity 2^exposure color; `normalize` divides it by the size of the light. The
radiant intensity of a flat light along its axis is L times its area, that of a sphere L pi radius^2, and the irradiance of a
disc of the half angle a in the sky L pi sin(a)^2."""
from __future__ import annotations

import numpy as np
from pxr import Usd, UsdGeom, UsdLux

import relief

from .assets import resolve_asset
from .context import Context
from .keys import ANGLE, Rules, read_numbers
from .motion import key_part
from .shading import SPACES, spread
from .walk import Item

MAX_ANGLE = 90.0  # of suns, degrees
MAX_RADIANCE = 1e30


def add_lights(context: Context, items: list, paths_of_names: dict) -> None:
    for item in items:
        prim, kind = item.prim, item.prim.GetTypeName()
        if item.instancer is not None:
            context.report.add(prim, "lights of point instancers are not taken over")
            continue
        if kind in ("DomeLight", "DomeLight_1"):
            with context.reading(prim):
                add_dome(context, item)
            continue
        reader = READERS.get(kind)
        if reader is None:
            if not prim.IsA(UsdGeom.Mesh):
                context.report.add(prim, f"{kind} is not taken over")
            continue
        with context.reading(prim):
            keys = read_light(context, item, reader)
            if keys is None:
                continue
            keys.update(add_motion(context, item, reader, keys))
            keys.update(read_links(context, prim, paths_of_names))
            context.scene.lights.append(relief.Light(**keys))


def read_light(context: Context, item: Item, reader) -> dict | None:
    keys = reader(context, item)
    if keys is None:
        return None
    for name in ("direction", "up"):
        if name in keys:
            keys[name] = read_axis(context, item.prim, name, keys)
    return {**keys, **read_common(context, item.prim)}


def add_motion(context: Context, item: Item, reader, keys: dict) -> dict:
    """Keys of what changes; none where it becomes another kind of light on the way, or none, which is reported as all that
    stays."""
    def read(matrix: np.ndarray) -> dict | None:
        found = read_light(context, Item(item.prim, matrix), reader)
        is_same = found is not None and found["type"] == keys["type"]
        return read_numbers(found) if is_same else None

    return key_part(context, item.prim, list_inputs(item.prim), read)


def list_inputs(prim: Usd.Prim) -> list:
    names = (attribute.GetName() for attribute in prim.GetAuthoredAttributes())
    return [name for name in names if name.startswith("inputs:") and name != "inputs:texture:file"]


def read_radiance(context: Context, prim: Usd.Prim) -> float:
    """intensity 2^exposure, without the colour."""
    light = UsdLux.LightAPI(prim)
    intensity = float(context.get(light.GetIntensityAttr(), 1.0, 0))
    exposure = float(context.get(light.GetExposureAttr(), 0.0))
    radiance = intensity * 2.0 ** min(exposure, 1000.0)
    if radiance > MAX_RADIANCE:
        context.fail(prim, f"intensity {intensity:g} and exposure {exposure:g} are a radiance of more than {MAX_RADIANCE:g}")
    return radiance


def read_color(context: Context, prim: Usd.Prim) -> list:
    light = UsdLux.LightAPI(prim)
    color = spread(context.get(light.GetColorAttr(), (1, 1, 1)))[:3]
    if context.get(light.GetEnableColorTemperatureAttr(), False):
        color = color * np.array(UsdLux.BlackbodyTemperatureAsRgb(context.get(light.GetColorTemperatureAttr(), 6500.0)))
    if light.GetColorAttr().HasAuthoredConnections():
        context.report.add(prim, "a shader that feeds its colour is not taken over")
    return [float(c) for c in np.maximum(color, 0)]


def read_common(context: Context, prim: Usd.Prim) -> dict:
    """Colour, and what UsdLux has that Relief has not."""
    keys = {"color": read_color(context, prim)}
    light = UsdLux.LightAPI(prim)
    for name in ("diffuse", "specular"):
        if context.get(prim.GetAttribute(f"inputs:{name}"), 1.0) != 1:
            context.report.add(prim, f"{name} multiplier is not taken over")
    if light.GetFiltersRel().GetTargets():
        context.report.add(prim, "light filters are not taken over")
    if prim.HasAPI(UsdLux.ShapingAPI):
        shaping = UsdLux.ShapingAPI(prim)
        if context.get(shaping.GetShapingFocusAttr(), 0.0) > 0:
            context.report.add(prim, "shaping:focus is not taken over")
        if getattr(context.get(shaping.GetShapingIesFileAttr()), "path", ""):
            context.report.add(prim, "its IES profile is not taken over")
    for name in ("visible_to_camera", "light_group"):
        noted = prim.GetAttribute(f"relief:{name}")
        if noted and noted.Get() is not None:
            keys[name] = noted.Get()
    return keys


def read_axis(context: Context, prim: Usd.Prim, name: str, keys: dict) -> list:
    """What save() noted as direction or up, as long as the light still looks and stands that way."""
    noted = prim.GetAttribute(f"relief:{name}")
    if not noted or noted.Get() is None:
        return keys[name]
    value, found = np.array(noted.Get()), np.array(keys[name])
    if name == "up":  # only what is at right angles to the direction counts
        direction = np.array(keys["direction"]) / np.linalg.norm(keys["direction"])
        across = value - direction * np.dot(value, direction)
    else:
        across = value
    cosine = np.dot(across, found) / max(np.linalg.norm(across) * np.linalg.norm(found), 1e-300)
    return to_list(value if cosine > 1 - 1e-10 else found)


def is_normalized(context: Context, prim: Usd.Prim) -> bool:
    return bool(context.get(UsdLux.LightAPI(prim).GetNormalizeAttr(), False))


def read_sun(context: Context, item: Item) -> dict | None:
    if not np.linalg.norm(item.matrices[:3, 2]) > 0:
        context.report.add(item.prim, "has no direction and thus gives no light")
        return None
    angle = float(context.get(item.prim.GetAttribute("inputs:angle"), 0.53, 0))
    if angle > MAX_ANGLE:
        context.report.add(item.prim, f"angle of {angle:g} is taken as {MAX_ANGLE:g} degrees")
        angle = MAX_ANGLE
    size = np.pi * np.sin(np.radians(angle) / 2) ** 2
    radiance = read_radiance(context, item.prim)
    strength = radiance if is_normalized(context, item.prim) or angle == 0 else radiance * size
    return {"type": "sun", "direction": to_list(-item.matrices[:3, 2]), "angle_degrees": angle, "strength": float(strength)}


def compute_frame(context: Context, item: Item) -> tuple:
    """(centre, axes of unit length, their lengths in units of the stage)."""
    axes = item.matrices[:3, :3]
    lengths = np.linalg.norm(axes, axis=0)
    return item.matrices[:3, 3], axes / np.maximum(lengths, 1e-300), lengths / context.unit


def to_strength(context: Context, prim: Usd.Prim, area: float, faces: float) -> float:
    """The radiant intensity of a radiance over an area that is seen; the whole surface has `faces` times that area."""
    radiance = read_radiance(context, prim)
    seen = 1 / faces if is_normalized(context, prim) else area
    return float(radiance * seen * context.unit ** 2)


def read_sphere(context: Context, item: Item) -> dict | None:
    prim = item.prim
    centre, axes, lengths = compute_frame(context, item)
    scale = float(np.prod(lengths)) ** (1 / 3)
    if np.ptp(lengths) > 1e-4 * scale:
        context.report.add(prim, "a sphere that is scaled to an ellipsoid is taken as a sphere")
    radius = float(context.get(prim.GetAttribute("inputs:radius"), 0.5, 0)) * scale
    strength = to_strength(context, prim, np.pi * radius ** 2, 4)
    if context.get(prim.GetAttribute("treatAsPoint"), False):
        radius = 0.0
    if strength == 0 and read_radiance(context, prim) > 0:
        context.report.add(prim, "has no surface and thus gives no light: it is neither normalized nor has it a radius")
        return None
    keys = {"type": "point", "position": to_list(centre), "radius": radius * context.unit, "strength": strength}
    if prim.HasAPI(UsdLux.ShapingAPI) and lengths[2] > 0:
        shape_spot(context, prim, -axes[:, 2], keys)
    return keys


def shape_spot(context: Context, prim: Usd.Prim, axis: np.ndarray, keys: dict) -> None:
    """A sphere that shines into a cone; UsdLux gives half of its angle."""
    shaping = UsdLux.ShapingAPI(prim)
    half = float(context.get(shaping.GetShapingConeAngleAttr(), 90.0))
    if half >= 180:
        return
    if half > 90:
        context.report.add(prim, f"a cone of {half:g} degrees to either side is taken as all directions")
        return
    softness = min(max(float(context.get(shaping.GetShapingConeSoftnessAttr(), 0.0)), 0.0), 1.0)
    keys.update(type="spot", direction=to_list(axis), angle_degrees=max(2 * half, 0.001), blend=softness)


def note_cone(context: Context, prim: Usd.Prim) -> None:
    if prim.HasAPI(UsdLux.ShapingAPI) and context.get(UsdLux.ShapingAPI(prim).GetShapingConeAngleAttr(), 90.0) < 90:
        context.report.add(prim, "shaping:cone of a flat light is not taken over")


def read_texture(context: Context, prim: Usd.Prim) -> dict:
    attribute = prim.GetAttribute("inputs:texture:file")
    if not attribute or not getattr(context.get(attribute), "path", ""):
        return {}
    file = resolve_asset(context, attribute)
    if file is None:
        context.report.add(prim, f"there is no texture {context.get(attribute).path}")
        return {}
    return {"color_texture": file}


def read_rectangle(context: Context, item: Item) -> dict | None:
    prim = item.prim
    centre, axes, lengths = compute_frame(context, item)
    width = float(context.get(prim.GetAttribute("inputs:width"), 1.0)) * lengths[0]
    height = float(context.get(prim.GetAttribute("inputs:height"), 1.0)) * lengths[1]
    if width <= 0 or height <= 0:
        context.report.add(prim, "has no surface and thus gives no light")
        return None
    note_cone(context, prim)
    return {"type": "rectangle", "position": to_list(centre), "direction": to_list(find_facing(axes)), "up": to_list(axes[:, 1]),
            "width": width * context.unit, "height": height * context.unit,
            "strength": to_strength(context, prim, width * height, 1), **read_texture(context, prim)}


def find_facing(axes: np.ndarray) -> np.ndarray:
    """At right angles to the face, towards -z of the light."""
    normal = np.cross(axes[:, 0], axes[:, 1])
    normal /= max(np.linalg.norm(normal), 1e-300)
    return -normal if np.dot(normal, axes[:, 2]) > 0 else normal


def read_disk(context: Context, item: Item) -> dict | None:
    prim = item.prim
    centre, axes, lengths = compute_frame(context, item)
    scale = float(np.sqrt(lengths[0] * lengths[1]))
    if abs(lengths[0] - lengths[1]) > 1e-4 * scale:
        context.report.add(prim, "a disk that is scaled to an ellipse is taken as a disk")
    radius = float(context.get(prim.GetAttribute("inputs:radius"), 0.5)) * scale
    if radius <= 0:
        context.report.add(prim, "has no surface and thus gives no light")
        return None
    note_cone(context, prim)
    keys = {"type": "disk", "position": to_list(centre), "direction": to_list(find_facing(axes)), "radius": radius * context.unit,
            "strength": to_strength(context, prim, np.pi * radius ** 2, 1), **read_texture(context, prim)}
    if "color_texture" in keys:
        keys["up"] = to_list(axes[:, 1])
    return keys


def find_dome_turn(context: Context, item: Item) -> float:
    """Degrees about +y. The middle of a dome's picture is seen along +z, that of an environment along -z."""
    turn = item.matrices[:3, :3] / np.maximum(np.linalg.norm(item.matrices[:3, :3], axis=0), 1e-300)
    if item.prim.GetTypeName() == "DomeLight_1":
        axis = context.get(item.prim.GetAttribute("poleAxis"), "scene")
        if axis == "Z" or (axis == "scene" and context.is_z_up):
            turn = turn @ np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]])
    if turn[1, 1] < 0.9999:
        context.report.add(item.prim, "a dome whose pole is not above is set upright")
        # About the horizontal axis between its pole and +y: the shortest way.
        turn = stand_up(turn)
    degrees = float(np.degrees(np.arctan2(turn[0, 2], turn[2, 2]))) + 180
    return degrees % 360


def stand_up(turn: np.ndarray) -> np.ndarray:
    pole, up = turn[:, 1], np.array([0.0, 1, 0])
    axis, cosine = np.cross(pole, up), float(np.dot(pole, up))
    if cosine < -0.9999:
        return np.diag([1, -1, -1]) @ turn
    cross = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    return (np.eye(3) + cross + cross @ cross / (1 + cosine)) @ turn


def add_dome(context: Context, item: Item) -> None:
    prim = item.prim
    if context.scene.environment is not None:
        context.report.add(prim, "is a second dome: the first one counts")
        return
    texture = read_texture(context, prim)
    keys = read_dome(context, item, bool(texture))
    keys.update(key_part(context, prim, list_inputs(prim), lambda matrix: read_dome(context, Item(prim, matrix), bool(texture)),
                         Rules({"rotate_degrees": ANGLE})))
    if texture:
        keys["file"] = texture["color_texture"]
        if context.get(prim.GetAttribute("inputs:texture:format"), "automatic") not in ("automatic", "latlong"):
            context.report.add(prim, "its texture is taken as latitude and longitude")
        noted = prim.GetAttribute("relief:color_space")
        said = noted.Get() if noted else SPACES.get(prim.GetAttribute("inputs:texture:file").GetColorSpace())
        if said:
            keys["color_space"] = said
    if prim.GetAttribute("relief:light_group") and prim.GetAttribute("relief:light_group").Get():
        keys["light_group"] = prim.GetAttribute("relief:light_group").Get()
    context.scene.environment = relief.Environment(**keys)


def read_dome(context: Context, item: Item, has_picture: bool) -> dict:
    """Its numbers."""
    keys = {"strength": read_radiance(context, item.prim), "color": read_color(context, item.prim)}
    if has_picture:
        keys["rotate_degrees"] = find_dome_turn(context, item)
        noted = item.prim.GetAttribute("relief:rotate_degrees")
        if noted and noted.Get() is not None and abs((noted.Get() - keys["rotate_degrees"] + 180) % 360 - 180) < 1e-6:
            keys["rotate_degrees"] = float(noted.Get())
    return keys


def read_links(context: Context, prim: Usd.Prim, paths_of_names: dict) -> dict:
    """Light linking: by names, whichever list is shorter."""
    collection = UsdLux.LightAPI(prim).GetShadowLinkCollectionAPI()
    if collection and (collection.GetExcludesRel().GetTargets() or collection.GetIncludesRel().GetTargets()):
        context.report.add(prim, "shadow linking is not taken over")
    collection = UsdLux.LightAPI(prim).GetLightLinkCollectionAPI()
    if not collection or not (collection.GetExcludesRel().GetTargets() or collection.GetIncludesRel().GetTargets()):
        return {}
    query = collection.ComputeMembershipQuery()
    lit = [name for name, path in paths_of_names.items() if query.IsPathIncluded(path)]
    dark = [name for name in paths_of_names if name not in set(lit)]
    if not lit:
        context.report.add(prim, "is linked to nothing in the scene and gives no light")
        return {"strength": 0.0}
    if not dark:
        return {}
    return {"light_link_includes": lit} if len(lit) <= len(dark) else {"light_link_excludes": dark}


def to_list(values) -> list:
    return [float(v) + 0.0 for v in values]


READERS = {"DistantLight": read_sun, "SphereLight": read_sphere, "RectLight": read_rectangle, "DiskLight": read_disk}
