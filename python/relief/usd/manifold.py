"""Whether faces are a surface that a smooth limit can be made of, as Relief's subdivision needs it."""
from __future__ import annotations

import numpy as np

from .corners import Faces, weld


def is_manifold(positions: np.ndarray, faces: Faces) -> bool:
    """False where faces meet three at an edge, are turned against each other, touch in a point alone, or use a point twice."""
    points = weld(positions)[faces.points]
    starts, sizes = np.repeat(faces.starts(), faces.sizes), np.repeat(faces.sizes, faces.sizes)
    after = starts + (np.arange(len(points)) - starts + 1) % sizes
    count = int(points.max(initial=0)) + 1
    numbers = np.repeat(np.arange(len(faces.sizes)), faces.sizes)
    if len(np.unique(numbers * count + points)) < len(points):
        return False
    keys = points * count + points[after]
    order = np.argsort(keys)
    if (np.diff(keys[order]) == 0).any():
        return False
    # The corner of each edge that runs the other way.
    place = np.searchsorted(keys[order], points[after] * count + points)
    opposite = order[np.minimum(place, len(order) - 1)]
    is_inner = keys[opposite] == points[after] * count + points
    return has_one_fan_a_point(points, after, opposite, is_inner)


def has_one_fan_a_point(points, after, opposite, is_inner) -> bool:
    """Corners at a point are one fan where steps over shared edges lead from each to each."""
    corners = np.flatnonzero(is_inner)
    first = np.concatenate([corners, after[corners]])          # both ends of a shared edge, in one face
    second = np.concatenate([after[opposite[corners]], opposite[corners]])  # and in the other
    labels = np.arange(len(points))
    while True:
        least = labels.copy()
        np.minimum.at(least, first, labels[second])
        least = least[least]
        if np.array_equal(least, labels):
            break
        labels = least
    return len(np.unique(labels)) == len(np.unique(points))
