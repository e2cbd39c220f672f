"""What of a mesh cannot be rendered: it is left out, and named."""
from dataclasses import replace

import numpy as np

FARTHEST, LARGEST_UV = 1e18, 1e6  # that Relief takes
SMALLEST_AREA = 1e-12             # of a face, of the square of its longest edge
CHUNK = 4096                      # faces that are looked at together


def repair(arrays, report):
    """(MeshArrays that can be rendered, mask of their corners among the old ones), or None: no face is left.

    Points keep their numbers. `report` takes a text."""
    # Comparisons with NaN are false.
    is_good = np.all(np.abs(arrays.positions) <= FARTHEST, -1)
    mask = np.ones(len(arrays.corners), bool)
    if not np.all(is_good):
        arrays, mask = _leave_out_points(arrays, is_good, report)
    if len(arrays.sizes) == 0:
        return None
    if not has_area(arrays):
        report("its faces have no area: it is left out")
        return None
    normals = arrays.corner_normals
    if not np.all(np.isfinite(normals)):  # of points beside those that were left out
        normals = np.where(np.all(np.isfinite(normals), -1, keepdims=True), normals, _find_face_normals(arrays))
        arrays = replace(arrays, corner_normals=normals.astype(np.float32))
    if not all(np.all(np.abs(uvs) <= LARGEST_UV) for uvs in (arrays.uvs, *arrays.further_uvs) if uvs is not None):
        report(f"uvs that are not finite or beyond {LARGEST_UV:g} are 0")
        arrays = replace(arrays, uvs=_repair_uvs(arrays.uvs), further_uvs=tuple(_repair_uvs(f) for f in arrays.further_uvs))
    return arrays, mask


def _repair_uvs(uvs):
    return None if uvs is None else np.where(np.abs(uvs) <= LARGEST_UV, uvs, np.float32(0))


def _leave_out_points(arrays, is_good, report):
    """(arrays without the faces of some points, mask of their corners); the points themselves go to the origin."""
    starts = np.cumsum(arrays.sizes) - arrays.sizes
    is_kept = np.logical_and.reduceat(is_good[arrays.corners], starts)
    if not np.all(is_kept):
        report(f"faces with points that are not finite or too far away are left out: {np.count_nonzero(~is_kept)}")
    mask = np.repeat(is_kept, arrays.sizes)
    uvs = arrays.uvs[mask] if arrays.uvs is not None else None
    positions = np.where(is_good[:, None], arrays.positions, np.float32(0))
    return replace(arrays, positions=positions, sizes=arrays.sizes[is_kept], corners=arrays.corners[mask], uvs=uvs,
                   further_uvs=tuple(further[mask] for further in arrays.further_uvs), face_materials=arrays.face_materials[is_kept],
                   corner_normals=arrays.corner_normals[mask]), mask


def _find_edges(points, sizes):
    """(first corner of each face, the corner that follows each corner in its face)."""
    starts = np.cumsum(sizes) - sizes
    following = np.arange(len(points)) + 1
    following[starts + sizes - 1] = starts
    return starts, following


def select_creases(creases, arrays):
    """(edges, sharpness) of those creases that are along an edge, or at a point, of a face."""
    edges, sharpness = creases
    count = np.int64(len(arrays.positions))
    _, following = _find_edges(arrays.corners, arrays.sizes)

    def number(pairs):
        return np.min(pairs, -1).astype(np.int64) * count + np.max(pairs, -1)
    known = np.stack([arrays.corners, arrays.corners[following]], -1)
    points = np.stack([arrays.corners, arrays.corners], -1)
    is_known = np.isin(number(edges), number(np.concatenate([known, points])))
    return edges[is_known], sharpness[is_known]


def _sum_crosses(points, sizes):
    """Twice the areas of faces, as vectors, as by Newell. points: (corners, 3)."""
    starts, following = _find_edges(points, sizes)
    offsets = points - np.repeat(points[starts], sizes, axis=0)
    return np.add.reduceat(np.cross(offsets, offsets[following]), starts)


def has_area(arrays):
    """Whether a face has an area by which Relief keeps it."""
    ends = np.cumsum(arrays.sizes)
    for first in range(0, len(arrays.sizes), CHUNK):
        sizes = arrays.sizes[first:first + CHUNK]
        corners = arrays.corners[ends[first] - sizes[0]:ends[first + len(sizes) - 1]]
        points = arrays.positions[corners].astype(float)
        starts, following = _find_edges(points, sizes)
        longest = np.maximum.reduceat(np.sum((points[following] - points) ** 2, -1), starts)
        if np.any(np.linalg.norm(_sum_crosses(points, sizes), axis=-1) > SMALLEST_AREA * longest):
            return True
    return False


def _find_face_normals(arrays):
    """(corners, 3) normals of the faces; up where one has no area."""
    sums = _sum_crosses(arrays.positions[arrays.corners].astype(float), arrays.sizes)
    lengths = np.linalg.norm(sums, axis=-1, keepdims=True)
    return np.repeat(np.where(lengths > 0, sums / np.maximum(lengths, 1e-300), [0.0, 0.0, 1.0]), arrays.sizes, axis=0)
