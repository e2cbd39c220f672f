"""The frames that a stage is asked for: their list, and the time codes that their shutters see."""
from __future__ import annotations

import dataclasses
import math

import numpy as np
from pxr import Usd, UsdGeom

from relief import _relief

from .context import Options, is_finite, make_error

WHOLE_STAGE = "all"
MAX_SHUTTER = 16.0  # frames, either way


@dataclasses.dataclass
class TimeRange:
    """Frames as render.frames lists them, and the times from the first opening of a shutter to the last closing."""
    text: str
    first: int
    low: float
    high: float

    def list_frames(self) -> range:
        """Whole frames around all times."""
        return range(math.floor(self.low), math.ceil(self.high) + 1)


def read_range(stage: Usd.Stage, options: Options, path: str) -> TimeRange | None:
    """None where no frames are asked for."""
    if options.frames is None:
        return None
    text = options.frames
    if text == WHOLE_STAGE:
        if not stage.HasAuthoredTimeCodeRange():
            raise make_error("names no range of frames", path, 'say which frames: "1-24"')
        first, last = math.ceil(stage.GetStartTimeCode()), math.floor(stage.GetEndTimeCode())
        text = f"{first}-{max(first, last)}" if last > first else str(first)
    frames = _relief.parse_frames(text)
    open_, close = find_widest_shutter(stage)
    return TimeRange(text, frames[0], min(frames) + min(open_, 0.0), max(frames) + max(close, 0.0))


def find_widest_shutter(stage: Usd.Stage) -> tuple:
    """Of all cameras: which of them is that of the scene is known later."""
    opens, closes = [0.0], [0.0]
    for prim in stage.Traverse():
        if prim.IsA(UsdGeom.Camera):
            camera = UsdGeom.Camera(prim)
            opens.append(limit_shutter(camera.GetShutterOpenAttr().Get()))
            closes.append(limit_shutter(camera.GetShutterCloseAttr().Get()))
    return min(opens), max(closes)


def limit_shutter(value: float | None) -> float:
    """What the camera of the scene may not have is refused where it is read."""
    return min(max(value, -MAX_SHUTTER), MAX_SHUTTER) if value is not None and math.isfinite(value) else 0.0


def list_times(context, attributes) -> list:
    """Times of the samples of attributes, within the range and with its ends; whole frames of those that are curves.
    Empty where none of them changes."""
    within, found = context.range, set()
    for attribute in attributes:
        if not attribute.ValueMightBeTimeVarying():
            continue
        samples = attribute.GetTimeSamples()
        found.update([within.low, within.high], samples or within.list_frames())
    return sorted(float(t) for t in found if within.low <= t <= within.high)


def take(context, attributes) -> None:
    """Notes that keys or files have been made of them."""
    context.taken.update(find_path(attribute) for attribute in attributes)


def find_path(attribute: Usd.Attribute):
    """One for all instances of a prim."""
    prim = attribute.GetPrim()
    inner = prim.GetPrimInPrototype() if prim.IsInstanceProxy() else prim
    return inner.GetPath().AppendProperty(attribute.GetName())


def list_transform_attributes(prim: Usd.Prim) -> list:
    """The operations that place a prim in the world."""
    attributes = []
    while prim and not prim.IsPseudoRoot():
        if prim.IsA(UsdGeom.Xformable):
            xformable = UsdGeom.Xformable(prim)
            attributes += [op.GetAttr() for op in xformable.GetOrderedXformOps()]
            if xformable.GetResetXformStack():
                break
        prim = prim.GetParent()
    return attributes


def compute_world(context, prim: Usd.Prim, time: float) -> np.ndarray:
    """World of the scene from prim."""
    matrix = UsdGeom.XformCache(Usd.TimeCode(time)).GetLocalToWorldTransform(prim)
    if not is_finite(matrix):
        context.fail(prim, f"its transform is not finite at frame {time:g}")
    return context.root @ np.array(matrix, np.float64).T


def report_other_motion(context, items: list) -> None:
    """Values that change with time and are taken as they are at the frame."""
    prims = {}
    for item in items:
        for prim in (item.prim, item.instancer):
            while prim and not prim.IsPseudoRoot() and prim.GetPath() not in prims:
                prims[prim.GetPath()] = prim
                prim = prim.GetParent()
    ignored = {"extent", "extentsHint"}
    for prim in prims.values():
        names = [attribute.GetName() for attribute in prim.GetAuthoredAttributes()
                 if find_path(attribute) not in context.taken and attribute.GetName() not in ignored
                 and attribute.ValueMightBeTimeVarying()]
        if names:
            verb = "changes" if len(names) == 1 else "change"
            context.report.add(prim, f"{', '.join(names)} {verb} with time: taken as of frame {context.time.GetValue():g}")
