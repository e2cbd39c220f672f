"""Cameras: the view, the vertical angle, depth of field."""
from __future__ import annotations

import numpy as np
from pxr import UsdGeom

import relief

from .context import Context, make_error, read_hint
from .keys import Rules, read_numbers
from .motion import key_part
from .time_range import MAX_SHUTTER

MOVING = ("focalLength", "focusDistance", "fStop", "verticalAperture", "horizontalApertureOffset", "verticalApertureOffset")
TENTHS = 0.1  # focal lengths and apertures are in tenths of scene units


def choose_camera(context: Context, settings, items: list):
    """Reads the one that is asked for, that of the render settings, or the first; returns its prim, or None."""
    wanted = context.options.camera
    if wanted is None and settings:
        targets = settings.GetCameraRel().GetForwardedTargets()
        wanted = str(targets[0]) if targets else None
    chosen = next((item for item in items if str(item.prim.GetPath()) == wanted), None)
    if context.options.camera is not None and chosen is None:
        names = ", ".join(str(item.prim.GetPath()) for item in items) or "none"
        raise make_error(f"has no camera {wanted}", context.path, f"its cameras: {names}")
    chosen = chosen or (items[0] if items else None)
    if chosen is None:
        return None
    for item in items:
        if item is not chosen:
            context.report.add(item.prim, f"is not the camera of the scene, which is {chosen.prim.GetPath()}")
    camera = UsdGeom.Camera(chosen.prim)
    with context.reading(chosen.prim):
        context.scene.camera = read_camera(context, camera, chosen.matrices)
        if context.range is not None:
            add_motion(context, camera)
    return camera


def add_motion(context: Context, camera: UsdGeom.Camera) -> None:
    """The shutter, and keys of what changes."""
    keys, prim = context.scene.camera, camera.GetPrim()
    shutter = [float(context.get(attribute, 0.0, -MAX_SHUTTER, MAX_SHUTTER))
               for attribute in (camera.GetShutterOpenAttr(), camera.GetShutterCloseAttr())]
    if shutter[0] > shutter[1]:
        context.report.add(prim, f"shutter:open {shutter[0]:g} comes after shutter:close {shutter[1]:g}: there is no motion blur")
    elif shutter != [0, 0]:
        keys["shutter"] = shutter
    distance = float(np.linalg.norm(np.subtract(keys["to"], keys["from"])))
    focus = keys.get("focus_distance", distance)

    def read(matrix: np.ndarray) -> dict:
        defaults = {"shift": [0.0, 0.0], "aperture_radius": 0.0, "focus_distance": focus}
        return read_numbers({**defaults, **read_camera(context, camera, matrix)})

    found = key_part(context, prim, MOVING, read, Rules(limits={"from": distance * 1e-3, "to": distance * 1e-3}))
    if found.get("aperture_radius") == 0:
        del found["aperture_radius"], found["focus_distance"]
    if found.get("shift") == [0, 0]:
        del found["shift"]
    keys.update(found)


def read_camera(context: Context, camera: UsdGeom.Camera, matrix: np.ndarray) -> relief.Camera:
    prim = camera.GetPrim()
    place, backward, upward = matrix[:3, 3], matrix[:3, 2], matrix[:3, 1]
    if not (np.isfinite(matrix).all() and np.linalg.norm(backward) > 0 and np.linalg.norm(upward) > 0):
        context.fail(prim, "its transform is not finite or has no extent", "a camera looks along its own -z")
    forward = -backward / max(np.linalg.norm(backward), 1e-300)
    high = max(context.get(camera.GetVerticalApertureAttr(), 15.2908), 1e-6)
    focal = context.get(camera.GetFocalLengthAttr(), 50.0)
    if context.get(camera.GetProjectionAttr()) == UsdGeom.Tokens.orthographic:
        context.report.add(prim, "is orthographic: it is taken as one with perspective")
    if context.get(camera.GetClippingPlanesAttr()):
        context.report.add(prim, "clippingPlanes are not taken over")
    focus = context.get(camera.GetFocusDistanceAttr(), 0.0)
    stop = context.get(camera.GetFStopAttr(), 0.0)
    fov = float(np.degrees(2 * np.arctan2(high / 2, focal)))
    distance = read_distance(prim, focus) * context.unit
    keys = {"from_": to_list(place), "to": to_list(place + forward * (distance or 1.0)),
            "up": read_up(prim, forward, upward), "fov_degrees": min(max(read_hint(prim, "relief:fov_degrees", fov), 0.001), 179.999)}
    shift = [context.get(prim.GetAttribute(name), 0.0) / high for name in ("horizontalApertureOffset", "verticalApertureOffset")]
    if shift != [0, 0]:
        keys["shift"] = shift
    if stop > 0 and focus > 0:
        radius = read_hint(prim, "relief:aperture_radius", focal * TENTHS / (2 * stop))
        keys.update(aperture_radius=radius * context.unit, focus_distance=read_hint(prim, "relief:focus_distance", focus) * context.unit)
    elif stop > 0:
        context.report.add(prim, "has an fStop and no focusDistance: all is sharp")
    return relief.Camera(**keys)


def read_distance(prim, focus: float) -> float:
    """From the camera to what save() noted that it looks at, else to where it is sharp."""
    noted = prim.GetAttribute("relief:look_at_distance")
    return float(noted.Get()) if noted and noted.Get() else float(focus)


def read_up(prim, forward: np.ndarray, upward: np.ndarray) -> list:
    """What save() noted as above, as long as it says the same as the camera's own y axis."""
    noted = prim.GetAttribute("relief:up")
    if noted and noted.Get() is not None:
        up = np.array(noted.Get())
        side, own = np.cross(forward, up), np.cross(forward, upward)
        scale = max(np.linalg.norm(side) * np.linalg.norm(own), 1e-300)
        if np.dot(side, own) / scale > 1 - 1e-10:
            return to_list(up)
    return to_list(upward / max(np.linalg.norm(upward), 1e-300))


def to_list(values) -> list:
    return [float(v) for v in values]
