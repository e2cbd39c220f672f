"""Meshes whose points change with time: a numbered file a frame, as meshes in memory cannot be blended."""
from __future__ import annotations

import os
import re
import typing

from pxr import Usd, UsdGeom

import relief
from relief import _relief

from .context import Context
from .time_range import list_times, take

TOPOLOGY = ("faceVertexCounts", "faceVertexIndices", "holeIndices", "orientation", "subdivisionScheme", "creaseIndices",
            "creaseLengths", "creaseSharpnesses", "cornerIndices", "cornerSharpnesses")
MOVING = ("points", "normals", "primvars:normals")


def write_moving_mesh(context: Context, prim: Usd.Prim, name: str, make: typing.Callable, uv_sets: int = 1) -> dict | None:
    """Writes the mesh at each frame and returns its part of a scene; None where it does not change or stays as it is.
    `make()`: the mesh at the time of the context, with so many uv sets."""
    if context.range is None or not prim.IsA(UsdGeom.Mesh):
        return None
    attributes = [prim.GetAttribute(key) for key in MOVING if prim.HasAttribute(key)]
    times = list_times(context, attributes)
    if not times:
        return None
    where = f"as of frame {context.time.GetValue():g}"
    if any(prim.GetAttribute(key).ValueMightBeTimeVarying() for key in TOPOLOGY if prim.HasAttribute(key)):
        context.report.add(prim, f"its faces change with time: it stays {where}")
        return None
    if uv_sets > 1:
        context.report.add(prim, f"points change with time, and files a frame hold one uv set: they stay {where}, as its "
                                 "textures lie on several")
        return None
    if context.options.folder is None:
        context.report.add(prim, f"points change with time, and there is no folder for a file a frame: they stay {where}")
        return None
    if len(set(times) - {context.range.low, context.range.high} - set(context.range.list_frames())):
        context.report.add(prim, "points have samples between frames: they go straight from frame to frame")
    take(context, attributes)
    pattern = name_files(context, name)
    mesh = None
    for frame in context.range.list_frames():
        with context.at(frame):
            mesh = make()
        mesh.save(_relief.name_frame(pattern, frame))
    keys = {"file": pattern}
    return {**keys, "subdivision": mesh.subdivision} if mesh.subdivision is not None else keys


def name_files(context: Context, name: str) -> str:
    folder = os.path.join(os.path.abspath(context.get_folder()), "meshes")
    os.makedirs(folder, exist_ok=True)
    stem, number = re.sub(r"[^\w.-]", "_", name), 1
    while (found := f"{stem}_{number}" if number > 1 else stem) in context.sequences:
        number += 1
    context.sequences.add(found)
    return os.path.join(folder, found + ".####.obj")
