"""Small scenes of the tests."""
from __future__ import annotations

from typing import Any

import numpy as np

import relief


def make_plane(**keys: Any) -> relief.Mesh:
    """Two units wide, facing +z."""
    return relief.Mesh([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], [[0, 1, 2, 3]],
                       uvs=[[0, 0], [1, 0], [1, 1], [0, 1]], **keys)


def make_waves(size: int = 64) -> np.ndarray:
    v, u = np.mgrid[0:size, 0:size] / size
    waves = np.zeros((size, size, 3), np.float32)
    waves[:, :, 0] = 0.05 * np.sin(13 * v)
    waves[:, :, 2] = 0.15 * np.sin(15 * u) * np.cos(11 * v)
    return waves


def make_scene(size: int = 64) -> relief.Scene:
    scene = relief.Scene.from_mesh(make_plane(), relief.Displacement(make_waves(size), space="tangent", midlevel=0))
    scene.render.update(width=64, height=48, spp=2, bounces=1)
    return scene


def make_rays(count: int, seed: int = 1) -> np.ndarray:
    """From a box around the plane to points of it and beside."""
    random = np.random.default_rng(seed)
    rays = np.empty((count, 8), np.float32)
    rays[:, 0:3] = random.uniform(-2, 2, (count, 3))
    rays[:, 3] = 0
    rays[:, 4:7] = random.uniform(-1.3, 1.3, (count, 3)) * (1, 1, 0.2) - rays[:, 0:3]
    rays[:, 7] = np.inf
    return rays
