"""Cubes, spheres, cylinders, cones, capsules and planes of a stage as meshes with normals and uvs."""
from __future__ import annotations

import numpy as np
from pxr import Usd, UsdGeom

from .context import Context
from .corners import make_faces
from .meshes import RawMesh

AROUND, ALONG = 96, 48  # faces of round shapes


def can_read_shape(prim: Usd.Prim) -> bool:
    return prim.GetTypeName() in MAKERS


def read_shape(context: Context, prim: Usd.Prim) -> RawMesh:
    def get(name, fallback):
        return context.get(prim.GetAttribute(name), fallback)

    points, quads, normals, uvs = MAKERS[prim.GetTypeName()](get)
    axis = str(get("axis", "Z"))
    shift = {"X": 1, "Y": 2}.get(axis, 0)  # cyclic, which turns and does not mirror
    faces = make_faces(np.full(len(quads), 4), quads.reshape(-1), get("orientation", "") == "leftHanded", np.array([], np.int64))
    raw = RawMesh(prim, np.roll(points, shift, axis=1), faces, counts=(len(points), len(quads), quads.size))
    raw.normals = (np.roll(normals, shift, axis=1), "vertex" if len(normals) == len(points) else "faceVarying", None)
    raw.uvs = {None: (uvs, "vertex", None)}
    if prim.GetTypeName() not in ("Cube", "Plane"):
        context.report.note(prim, f"{prim.GetTypeName()} is a mesh of {len(quads)} faces")
    return raw


def make_grid(columns: int, rows: int) -> np.ndarray:
    """Quads between (rows + 1) rows of (columns + 1) points."""
    row, column = np.mgrid[0:rows, 0:columns]
    first = (row * (columns + 1) + column).reshape(-1)
    return np.stack([first, first + 1, first + columns + 2, first + columns + 1], 1)


def revolve(radii, heights, slopes) -> tuple:
    """A profile from below to above turned about z. `slopes`: (radial, axial) parts of the normal at each point."""
    angle = np.linspace(0, 2 * np.pi, AROUND + 1)
    across = np.stack([np.cos(angle), np.sin(angle)], 1)
    radii, heights, slopes = (np.array(v, np.float64) for v in (radii, heights, slopes))
    points = np.concatenate([radii[:, None, None] * across, np.broadcast_to(heights[:, None, None], (len(radii), AROUND + 1, 1))], 2)
    normals = np.concatenate([slopes[:, :1, None] * across, np.broadcast_to(slopes[:, 1:, None], (len(radii), AROUND + 1, 1))], 2)
    v = np.linspace(0, 1, len(radii))
    uvs = np.stack(np.broadcast_arrays(np.linspace(0, 1, AROUND + 1)[None], v[:, None]), 2)
    quads = make_grid(AROUND, len(radii) - 1)
    points = points.reshape(-1, 3)
    # At sharp edges of the profile two rows have one place: no faces between them.
    is_flat = (np.abs(np.diff(radii)) + np.abs(np.diff(heights)) == 0).repeat(AROUND)
    return points, quads[~is_flat], normals.reshape(-1, 3), uvs.reshape(-1, 2)


def make_sphere(get) -> tuple:
    angle = np.linspace(-np.pi / 2, np.pi / 2, ALONG + 1)
    slopes = np.stack([np.cos(angle), np.sin(angle)], 1)
    slopes[[0, -1]] = [[0, -1], [0, 1]]
    radius = get("radius", 1.0)
    return revolve(slopes[:, 0] * radius, slopes[:, 1] * radius, slopes)


def make_cylinder(get) -> tuple:
    radius, half = get("radius", 1.0), get("height", 2.0) / 2
    return revolve([0, radius, radius, radius, radius, 0], [-half, -half, -half, half, half, half],
                   [[0, -1], [0, -1], [1, 0], [1, 0], [0, 1], [0, 1]])


def make_cone(get) -> tuple:
    radius, height = get("radius", 1.0), get("height", 2.0)
    side = np.array([height, radius]) / np.hypot(height, radius)
    return revolve([0, radius, radius, 0], [-height / 2, -height / 2, -height / 2, height / 2], [[0, -1], [0, -1], side, side])


def make_capsule(get) -> tuple:
    radius, half = get("radius", 0.5), get("height", 1.0) / 2
    angle = np.linspace(0, np.pi / 2, ALONG // 2 + 1)
    upper = np.stack([np.cos(angle), np.sin(angle)], 1)
    upper[-1] = [0, 1]
    lower = upper[::-1] * [1, -1]
    slopes = np.concatenate([lower, upper])
    heights = np.concatenate([lower[:, 1] * radius - half, upper[:, 1] * radius + half])
    return revolve(slopes[:, 0] * radius, heights, slopes)


def make_cube(get) -> tuple:
    half = get("size", 2.0) / 2
    points, normals = [], []
    for axis in range(3):
        for sign in (-1, 1):
            side = np.array([[-1, -1, sign], [1, -1, sign], [1, 1, sign], [-1, 1, sign]], np.float64)
            points.append(np.roll(side if sign > 0 else side[::-1], axis + 1, axis=1) * half)
            normals.append(np.broadcast_to(np.roll([0.0, 0.0, sign], axis + 1), (4, 3)))
    uvs = np.tile([[0.0, 0.0], [1, 0], [1, 1], [0, 1]], (6, 1))
    return np.concatenate(points), np.arange(24).reshape(6, 4), np.concatenate(normals), uvs


def make_plane(get) -> tuple:
    width, length = get("width", 2.0) / 2, get("length", 2.0) / 2
    if str(get("axis", "Z")) != "Z":
        width, length = length, width  # about x: along z and y; about y: along x and z
    points = np.array([[-width, -length, 0], [width, -length, 0], [width, length, 0], [-width, length, 0]])
    return points, np.arange(4).reshape(1, 4), np.tile([0.0, 0, 1], (4, 1)), np.array([[0.0, 0], [1, 0], [1, 1], [0, 1]])


MAKERS = {"Sphere": make_sphere, "Cylinder": make_cylinder, "Cone": make_cone, "Capsule": make_capsule, "Cube": make_cube,
          "Plane": make_plane}
