"""Points of a PLY file for an object that stands in many places."""
from __future__ import annotations

import os

import numpy as np

from .context import Context

TOLERANCE = 1e-5  # of the cosine between axes, below which a matrix has no shear
FIELDS = ("x", "y", "z", "qw", "qx", "qy", "qz", "scale_x", "scale_y", "scale_z")


def decompose(matrices: np.ndarray):
    """(translations, quaternions w x y z, scales) of many matrices; None where one has a shear or is mirrored."""
    axes = matrices[:, :3, :3]
    scales = np.linalg.norm(axes, axis=1)
    if (scales <= 0).any():
        return None
    turns = axes / scales[:, None]
    products = np.einsum("kij,kil->kjl", turns, turns) - np.eye(3)
    if np.abs(products).max() > TOLERANCE or (np.linalg.det(turns) < 0).any():
        return None
    return matrices[:, :3, 3], to_quaternions(turns), scales


def to_quaternions(turns: np.ndarray) -> np.ndarray:
    """Rows w, x, y, z of rotations, by the largest of the four."""
    a = turns
    trace = a[:, 0, 0] + a[:, 1, 1] + a[:, 2, 2]
    w = np.stack([1 + trace, a[:, 2, 1] - a[:, 1, 2], a[:, 0, 2] - a[:, 2, 0], a[:, 1, 0] - a[:, 0, 1]], 1)
    x = np.stack([w[:, 1], 1 + 2 * a[:, 0, 0] - trace, a[:, 0, 1] + a[:, 1, 0], a[:, 0, 2] + a[:, 2, 0]], 1)
    y = np.stack([w[:, 2], x[:, 2], 1 + 2 * a[:, 1, 1] - trace, a[:, 1, 2] + a[:, 2, 1]], 1)
    z = np.stack([w[:, 3], x[:, 3], y[:, 3], 1 + 2 * a[:, 2, 2] - trace], 1)
    every = np.stack([w, x, y, z], 1)
    best = np.argmax(every[:, range(4), range(4)], axis=1)
    chosen = every[np.arange(len(every)), best]
    return chosen / np.linalg.norm(chosen, axis=1, keepdims=True)


def write_instances(context: Context, matrices: np.ndarray) -> str | None:
    """The name of the file; None where the places cannot be points of one."""
    parts = decompose(matrices)
    if parts is None:
        return None
    folder, number = context.get_folder(), 0
    while os.path.exists(path := os.path.join(folder, f"points{number}.ply")):
        number += 1
    rows = np.concatenate(parts, axis=1).astype("<f4")
    header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(rows)}",
              *(f"property float {name}" for name in FIELDS), "end_header", ""]
    with open(path, "wb") as file:
        file.write("\n".join(header).encode() + rows.tobytes())
    return path
