"""Faces of a mesh and the values at their corners, whatever their interpolation."""
from __future__ import annotations

import dataclasses

import numpy as np


SMALLEST_AREA = 1e-12  # of the square of the longest edge


@dataclasses.dataclass
class Faces:
    """The faces that are kept, counter-clockwise, and where each of their corners stands in the mesh of the file."""
    sizes: np.ndarray    # (F,)
    points: np.ndarray   # (C,) of the corners
    corners: np.ndarray  # (C,) places in the file's list of corners
    numbers: np.ndarray  # (F,) places in the file's list of faces

    def select(self, numbers: np.ndarray) -> Faces:
        """Those faces that have one of the numbers of the file."""
        is_in = np.isin(self.numbers, numbers)
        corner_is_in = np.repeat(is_in, self.sizes)
        return Faces(self.sizes[is_in], self.points[corner_is_in], self.corners[corner_is_in], self.numbers[is_in])

    def starts(self) -> np.ndarray:
        return np.concatenate([[0], np.cumsum(self.sizes)])[:-1]


def make_faces(sizes: np.ndarray, points: np.ndarray, is_left_handed: bool, dropped: np.ndarray) -> Faces:
    """All faces but those in `dropped` and those of less than three corners; left-handed ones turned round."""
    starts = np.concatenate([[0], np.cumsum(sizes)])
    within = np.arange(len(points)) - np.repeat(starts[:-1], sizes)
    corners = np.arange(len(points))
    if is_left_handed:
        corners = np.repeat(starts[:-1], sizes) + (np.repeat(sizes, sizes) - within) % np.repeat(sizes, sizes)
    is_kept = sizes >= 3
    is_kept[dropped[(dropped >= 0) & (dropped < len(sizes))]] = False
    corners = corners[np.repeat(is_kept, sizes)]
    return Faces(sizes[is_kept], points[corners], corners, np.flatnonzero(is_kept))


def index_corners(faces: Faces, interpolation: str) -> np.ndarray:
    """For each corner, which of the values of a primvar is its."""
    if interpolation == "constant":
        return np.zeros(len(faces.points), np.int64)
    if interpolation == "uniform":
        return np.repeat(faces.numbers, faces.sizes)
    if interpolation in ("vertex", "varying"):
        return faces.points
    return faces.corners


def weld(positions: np.ndarray) -> np.ndarray:
    """Points at one place are one point, as Relief takes them: the number of each."""
    places = positions.astype(np.float32)
    order = np.lexsort(places.T)
    is_new = np.concatenate([[False], (np.diff(places[order], axis=0) != 0).any(1)])
    numbers = np.empty(len(places), np.int64)
    numbers[order] = np.cumsum(is_new)
    return numbers


def find_next(faces: Faces) -> np.ndarray:
    """For each corner the place of the next one of its face."""
    starts = np.repeat(faces.starts(), faces.sizes)
    return starts + (np.arange(len(faces.points)) - starts + 1) % np.repeat(faces.sizes, faces.sizes)


def have_area(positions: np.ndarray, faces: Faces) -> np.ndarray:
    """(F,) whether Relief keeps a face: it drops those without area."""
    if len(faces.sizes) == 0:
        return np.zeros(0, bool)
    at = positions.astype(np.float32).astype(np.float64)[faces.points]
    after = at[find_next(faces)]
    longest = np.maximum.reduceat(((after - at) ** 2).sum(1), faces.starts())
    origin = np.repeat(at[faces.starts()], faces.sizes, axis=0)
    normals = np.add.reduceat(np.cross(at - origin, after - origin), faces.starts(), axis=0)
    return np.linalg.norm(normals, axis=1) > SMALLEST_AREA * longest


def compute_face_normals(positions: np.ndarray, faces: Faces) -> tuple:
    """(unit normals of the faces, angles of their corners)."""
    starts, sizes = np.repeat(faces.starts(), faces.sizes), np.repeat(faces.sizes, faces.sizes)
    within = np.arange(len(faces.points)) - starts
    at = positions[faces.points]
    after = positions[faces.points[starts + (within + 1) % sizes]] - at
    before = positions[faces.points[starts + (within - 1) % sizes]] - at
    # Newell's normal: of a face that is not flat the mean.
    normals = np.add.reduceat(np.cross(at, at + after), faces.starts(), axis=0)
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
    lengths = np.linalg.norm(after, axis=1) * np.linalg.norm(before, axis=1)
    return normals, np.arccos(np.clip((after * before).sum(1) / np.maximum(lengths, 1e-300), -1, 1))


def compute_normals(positions: np.ndarray, faces: Faces) -> np.ndarray:
    """A unit normal of each point: the mean of those of its faces, weighted by the angles of their corners. Points at one
    place are one point."""
    welded = weld(positions)
    normals, angles = compute_face_normals(positions, faces)
    sums = np.zeros((welded.max(initial=-1) + 1, 3))
    np.add.at(sums, welded[faces.points], np.repeat(normals, faces.sizes, axis=0) * angles[:, None])
    sums /= np.maximum(np.linalg.norm(sums, axis=1, keepdims=True), 1e-300)
    return sums[welded]


def compute_creased_normals(positions: np.ndarray, faces: Faces, degrees: float = 30) -> np.ndarray:
    """The same at each corner, without the faces that turn away from its own by more than an angle."""
    normals, angles = compute_face_normals(positions, faces)
    own = np.repeat(normals, faces.sizes, axis=0)
    order = np.argsort(faces.points, kind="stable")
    counts = np.bincount(faces.points)
    first, counts = np.repeat(np.cumsum(counts) - counts, counts), np.repeat(counts, counts)
    sums, left, step = np.zeros((len(order), 3)), np.arange(len(order)), 0
    while len(left):  # the step-th corner at the same point
        mine, other = order[left], order[first[left] + step]
        is_near = (own[mine] * own[other]).sum(1) > np.cos(np.radians(degrees))
        sums[mine] += own[other] * (angles[other] * is_near)[:, None]
        step += 1
        left = left[counts[left] > step]
    return sums / np.maximum(np.linalg.norm(sums, axis=1, keepdims=True), 1e-300)
