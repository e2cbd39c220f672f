"""Scenes of USD: load("shot.usda") makes a relief.Scene, save(scene, "x.usda") writes one.

Needs `usd-core` of the package index: pip install relief[usd]. What is taken over, in which units, and what is not:
docs/usd.md."""
from __future__ import annotations

import os
import typing

import relief

__all__ = ["load", "save", "main"]


def _require_usd() -> None:
    try:
        import pxr.Usd  # noqa: F401
    except ImportError as missing:
        raise ImportError("relief.usd needs the package usd-core: pip install relief[usd]") from missing


def load(path: str | os.PathLike, time: float | None = None, *, report: list | None = None, camera: str | None = None,
         purposes: typing.Sequence[str] = ("default", "render"), meters: bool = False, subdivision_level: int | None = None,
         vector_space: str = "tangent", folder: str | os.PathLike | None = None, frames: str | None = None) -> relief.Scene:
    """The scene of a USD file (usd, usda, usdc, usdz) at one time, or over a range of frames.

    time: time code; None: the first frame of the stage, or the earliest sample of each attribute.
    report: a list that gets one line for each prim of which something is not taken over.
    camera: path of the camera prim; None: that of the render settings, else the first one.
    purposes: purposes of prims that are taken.
    meters: lengths become meters by the stage's metersPerUnit; else they stay as they are.
    subdivision_level: of subdivided meshes, 0 to 8; None: automatic, by the picture.
    vector_space: what the vectors of MaterialX displacements are: "tangent" (dP/du, dP/dv and the normal) or "object".
    folder: where textures inside usdz packages, the points of large instancers and numbered files of meshes whose points
      change are written; None: a temporary folder that lasts as long as the scene, and such meshes stay as at one frame.
    frames: of time samples that become keys, "1-24" or "1-100x2,150", time codes; "all": the stage's own range; None: one
      time. What cannot change is as at `time`, else as at the first frame.

    Raises relief.Error with file, prim and a hint; ImportError without usd-core."""
    _require_usd()
    from .loader import Options, load_scene

    options = Options(time=time, camera=camera, purposes=tuple(purposes), meters=meters,
                      subdivision_level=subdivision_level, vector_space=vector_space, folder=folder, frames=frames)
    return load_scene(os.fspath(path), options, report)


def save(scene: relief.Scene, path: str | os.PathLike, *, report: list | None = None) -> None:
    """Writes a scene as USD (usda, usdc or usd by the name), arrays of maps as EXR files in the folder NAME_files beside it.

    report: a list that gets one line for each thing that could not be written. load() of the file gives the same
    picture. Raises relief.Error; ImportError without usd-core."""
    _require_usd()
    from .save_scene import save_scene

    save_scene(scene, os.fspath(path), report)


def main(arguments: typing.Sequence[str] | None = None) -> int:
    """The command relief-usd; returns its exit code."""
    from .command import run

    return run(arguments)
