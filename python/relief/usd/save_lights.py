"""Lights, sky and camera as UsdLux and UsdGeomCamera: the inverse of lights.py and cameras.py.

Lights are written normalized, so that their intensity is Relief's strength whatever their size; of a sphere four times it."""
from __future__ import annotations

import numpy as np
from pxr import Gf, Sdf, Usd, UsdGeom, UsdLux

TENTHS = 0.1  # focal lengths and apertures are in tenths of scene units
FOCAL_LENGTH = 50.0


def set_exact(prim: Usd.Prim, name: str, value) -> None:
    """A double, or three, that load() takes as long as they agree with the prim."""
    if np.ndim(value):
        prim.CreateAttribute(name, Sdf.ValueTypeNames.Double3, True).Set(Gf.Vec3d(*map(float, value)))
    else:
        prim.CreateAttribute(name, Sdf.ValueTypeNames.Double, True).Set(float(value))


def make_frame(position, direction, up) -> Gf.Matrix4d:
    """A transform whose -z is `direction` and whose y is as near to `up` as can be."""
    backward = -np.array(direction, np.float64)
    backward /= np.linalg.norm(backward)
    side = np.cross(up, backward)
    if np.linalg.norm(side) < 1e-7 * max(np.linalg.norm(up), 1e-300):
        # Relief's own choice where up is along the direction.
        side = np.cross([0.0, 0.0, -1.0], backward)
    if np.linalg.norm(side) < 1e-7:
        side = np.cross([1.0, 0.0, 0.0], backward)
    side /= np.linalg.norm(side)
    matrix = np.eye(4)
    matrix[:3, :4] = np.stack([side, np.cross(backward, side), backward, position], 1)
    return Gf.Matrix4d(*matrix.T.reshape(-1).tolist())


def write_camera(writer, keys: dict, picture: dict) -> str:
    camera = UsdGeom.Camera.Define(writer.stage, "/World/camera")
    start, to = np.array(keys.get("from", (0, 0, 5)), float), np.array(keys.get("to", (0, 0, 0)), float)
    up = np.array(keys.get("up", (0, 1, 0)), float)
    distance = float(np.linalg.norm(to - start))
    direction = to - start if distance > 0 else np.array([0.0, 0, -1])
    camera.AddTransformOp().Set(make_frame(start, direction, up))
    fov = keys.get("fov_degrees", 35.0)
    high = 2 * FOCAL_LENGTH * np.tan(np.radians(fov) / 2)
    camera.CreateFocalLengthAttr(FOCAL_LENGTH)
    camera.CreateVerticalApertureAttr(float(high))
    camera.CreateHorizontalApertureAttr(float(high * picture.get("width", 1280) / picture.get("height", 720)))
    focus, radius = keys.get("focus_distance", distance or 1.0), keys.get("aperture_radius", 0.0)
    camera.CreateFocusDistanceAttr(float(focus))
    camera.CreateFStopAttr(float(FOCAL_LENGTH * TENTHS / (2 * radius)) if radius > 0 else 0.0)
    camera.CreateClippingRangeAttr(Gf.Vec2f(max(1e-3, 1e-3 * distance), max(1e6, 1e3 * distance)))
    prim = camera.GetPrim()
    for name, value in (("fov_degrees", fov), ("aperture_radius", radius), ("focus_distance", focus),
                        ("look_at_distance", distance or 1.0), ("up", up)):
        set_exact(prim, f"relief:{name}", value)
    shift = keys.get("shift")
    if shift:
        camera.CreateHorizontalApertureOffsetAttr(float(shift[0] * high))
        camera.CreateVerticalApertureOffsetAttr(float(shift[1] * high))
    return "/World/camera"


def write_environment(writer, keys: dict) -> None:
    light = UsdLux.DomeLight.Define(writer.stage, "/World/environment")
    prim = light.GetPrim()
    light.CreateIntensityAttr(float(keys.get("strength", 1.0)))
    light.CreateColorAttr(Gf.Vec3f(*keys.get("color", (1, 1, 1))))
    if "file" in keys:
        light.CreateTextureFileAttr(writer.name_asset(keys["file"]))
        light.CreateTextureFormatAttr(UsdLux.Tokens.latlong)
        # The middle of a dome's picture is seen along +z, that of an environment along -z.
        turn = float(keys.get("rotate_degrees", 0.0))
        light.AddRotateYOp(UsdGeom.XformOp.PrecisionDouble).Set(turn + 180)
        set_exact(prim, "relief:rotate_degrees", turn)
    for name in ("light_group", "color_space"):
        if keys.get(name):
            prim.CreateAttribute(f"relief:{name}", Sdf.ValueTypeNames.String, True).Set(keys[name])


def write_lights(writer, entries: list, paths: dict) -> None:
    for number, keys in enumerate(entries):
        path = writer.make_path("/World/Lights", f"{keys['type']}{number}")
        light = MAKERS[keys["type"]](writer, path, keys)
        prim = light.GetPrim()
        factor = 4.0 if keys["type"] in ("point", "spot") else 1.0
        light.CreateNormalizeAttr(True)
        light.CreateIntensityAttr(factor * float(keys.get("strength", 1.0)))
        light.CreateColorAttr(Gf.Vec3f(*keys.get("color", (1, 1, 1))))
        if keys.get("visible_to_camera"):
            prim.CreateAttribute("relief:visible_to_camera", Sdf.ValueTypeNames.Bool, True).Set(True)
        if keys.get("light_group"):
            prim.CreateAttribute("relief:light_group", Sdf.ValueTypeNames.String, True).Set(keys["light_group"])
        write_links(light, keys, paths)


def place(light, keys: dict) -> None:
    direction, up = keys.get("direction", (0, -1, 0)), keys.get("up", (0, 1, 0))
    light.AddTransformOp().Set(make_frame(keys.get("position", (0, 0, 0)), direction, up))
    if keys["type"] != "point":
        set_exact(light.GetPrim(), "relief:direction", direction)
    if "up" in keys:
        set_exact(light.GetPrim(), "relief:up", up)


def write_sun(writer, path: str, keys: dict):
    light = UsdLux.DistantLight.Define(writer.stage, path)
    place(light, keys)
    light.CreateAngleAttr(float(keys.get("angle_degrees", 0.53)))
    return light


def write_sphere(writer, path: str, keys: dict):
    light = UsdLux.SphereLight.Define(writer.stage, path)
    place(light, keys)
    radius = float(keys.get("radius", 0.0))
    light.CreateRadiusAttr(radius)
    if radius == 0:
        light.CreateTreatAsPointAttr(True)
    if keys["type"] == "spot":
        shaping = UsdLux.ShapingAPI.Apply(light.GetPrim())
        shaping.CreateShapingConeAngleAttr(float(keys.get("angle_degrees", 45.0)) / 2)
        shaping.CreateShapingConeSoftnessAttr(float(keys.get("blend", 0.0)))
    return light


def write_texture(writer, prim: Usd.Prim, keys: dict) -> None:
    if "color_texture" in keys:
        prim.CreateAttribute("inputs:texture:file", Sdf.ValueTypeNames.Asset).Set(writer.name_asset(keys["color_texture"]))


def write_rectangle(writer, path: str, keys: dict):
    light = UsdLux.RectLight.Define(writer.stage, path)
    place(light, keys)
    light.CreateWidthAttr(float(keys.get("width", 1.0)))
    light.CreateHeightAttr(float(keys.get("height", 1.0)))
    write_texture(writer, light.GetPrim(), keys)
    return light


def write_disk(writer, path: str, keys: dict):
    light = UsdLux.DiskLight.Define(writer.stage, path)
    place(light, keys)
    light.CreateRadiusAttr(float(keys.get("radius", 0.5)))
    write_texture(writer, light.GetPrim(), keys)
    return light


def write_links(light, keys: dict, paths: dict) -> None:
    """By collections; of what is included, all else is left out."""
    includes, excludes = keys.get("light_link_includes", []), keys.get("light_link_excludes", [])
    if not includes and not excludes:
        return
    collection = UsdLux.LightAPI(light.GetPrim()).GetLightLinkCollectionAPI()
    if includes:
        collection.CreateIncludeRootAttr(False)
    for names, relationship in ((includes, collection.CreateIncludesRel), (excludes, collection.CreateExcludesRel)):
        targets = [Sdf.Path(path) for name in names for path in paths.get(name, [])]
        if targets:
            relationship().SetTargets(targets)


MAKERS = {"sun": write_sun, "point": write_sphere, "spot": write_sphere, "rectangle": write_rectangle, "disk": write_disk}
