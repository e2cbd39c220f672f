"""A subdivided mesh as polygons on its limit surface, for meshes that are split into parts of one material.

Catmull and Clark (1978) with the creases of DeRose, Kass and Truong (1998). Relief itself refines all other meshes; parts that
it would refine one by one do not meet."""
from __future__ import annotations

import dataclasses

import numpy as np

INFINITE = 10.0  # sharpness from which on a crease stays one


@dataclasses.dataclass
class Cage:
    points: np.ndarray   # (N, 3)
    sizes: np.ndarray    # (F,)
    corners: np.ndarray  # (C,)
    uvs: np.ndarray      # (C, 2 K), K uvs a corner
    faces: np.ndarray    # (F,) the face of the first cage that each comes from
    edges: np.ndarray    # (K, 2) creases
    edge_sharpness: np.ndarray
    point_sharpness: np.ndarray  # (N,)
    is_smooth: bool = True       # else faces are split as they are
    has_sharp_corners: bool = True


@dataclasses.dataclass
class Edges:
    """The edges of a cage: their ends, those of each corner (to the next one), and how many faces they have."""
    ends: np.ndarray
    of_corner: np.ndarray
    face_count: np.ndarray
    sharpness: np.ndarray


def find_neighbours(cage: Cage) -> tuple:
    """Places of the next and of the last corner of the face, for each corner."""
    starts = np.repeat(np.concatenate([[0], np.cumsum(cage.sizes)])[:-1], cage.sizes)
    sizes = np.repeat(cage.sizes, cage.sizes)
    within = np.arange(len(cage.corners)) - starts
    return starts + (within + 1) % sizes, starts + (within - 1) % sizes


def find_edges(cage: Cage, after: np.ndarray) -> Edges:
    count = len(cage.points)
    pairs = np.sort(np.stack([cage.corners, cage.corners[after]], 1), axis=1)
    keys, of_corner = np.unique(pairs[:, 0] * count + pairs[:, 1], return_inverse=True)
    ends = np.stack([keys // count, keys % count], 1)
    face_count = np.bincount(of_corner, minlength=len(keys))
    sharpness = np.zeros(len(keys))
    named = np.sort(cage.edges, axis=1)
    named = named[:, 0] * count + named[:, 1]
    place = np.searchsorted(keys, named)
    is_edge = (place < len(keys)) & (keys[np.minimum(place, len(keys) - 1)] == named)
    np.maximum.at(sharpness, place[is_edge], cage.edge_sharpness[is_edge])
    sharpness[face_count != 2] = INFINITE
    return Edges(ends, of_corner.reshape(-1), face_count, sharpness)


def sum_at(index: np.ndarray, values: np.ndarray, count: int) -> np.ndarray:
    sums = np.zeros((count, *values.shape[1:]))
    np.add.at(sums, index, values)
    return sums


def find_rules(cage: Cage, edges: Edges) -> tuple:
    """(how sharp, whether a corner, sum of the ends of sharp edges) of each point."""
    count = len(cage.points)
    is_sharp = edges.sharpness > 0
    ends, sharpness = edges.ends[is_sharp], edges.sharpness[is_sharp]
    both, other = ends.reshape(-1), ends[:, ::-1].reshape(-1)
    sharp_count = np.bincount(both, minlength=count)
    mean = sum_at(both, np.repeat(sharpness, 2), count) / np.maximum(sharp_count, 1)
    face_count = np.bincount(cage.corners, minlength=count)
    is_corner = (sharp_count > 2) | (cage.point_sharpness > 0)
    is_rim = sum_at(edges.ends.reshape(-1), np.repeat(edges.face_count == 1, 2).astype(float), count) > 0
    if cage.has_sharp_corners:
        is_corner |= is_rim & (face_count == 1)
    how_sharp = np.where(sharp_count >= 2, mean, 0)
    how_sharp = np.maximum(np.where(is_rim, INFINITE, how_sharp), cage.point_sharpness)
    return np.clip(how_sharp, 0, 1), is_corner, sum_at(both, cage.points[other], count)


def move_points(cage: Cage, edges: Edges, face_points: np.ndarray) -> np.ndarray:
    """The points of the cage, one level finer."""
    count = len(cage.points)
    valence = np.maximum(np.bincount(cage.corners, minlength=count), 1)[:, None]
    around = sum_at(cage.corners, np.repeat(face_points, cage.sizes, axis=0), count) / valence
    middles = cage.points[edges.ends].mean(1)
    edge_count = np.maximum(np.bincount(edges.ends.reshape(-1), minlength=count), 1)[:, None]
    along = sum_at(edges.ends.reshape(-1), np.repeat(middles, 2, axis=0), count) / edge_count
    smooth = (around + 2 * along + (valence - 3) * cage.points) / valence
    how_sharp, is_corner, ends = find_rules(cage, edges)
    sharp = np.where(is_corner[:, None], cage.points, (6 * cage.points + ends) / 8)
    return smooth + (sharp - smooth) * how_sharp[:, None]


def refine_once(cage: Cage) -> Cage:
    """Each corner of a face becomes a quad."""
    after, before = find_neighbours(cage)
    edges, starts = find_edges(cage, after), np.concatenate([[0], np.cumsum(cage.sizes)])[:-1]
    point_count, face_count = len(cage.points), len(cage.sizes)
    sizes = cage.sizes[:, None]
    face_points = np.add.reduceat(cage.points[cage.corners], starts, axis=0) / sizes
    middles = cage.points[edges.ends].mean(1)
    points = cage.points
    if cage.is_smooth:
        beside = sum_at(edges.of_corner, np.repeat(face_points, cage.sizes, axis=0), len(middles))
        smooth = (2 * middles + beside) / 4
        middles = smooth + (middles - smooth) * np.clip(edges.sharpness, 0, 1)[:, None]
        points = move_points(cage, edges, face_points)
    first_edge, first_face = point_count, point_count + len(middles)
    numbers = np.repeat(np.arange(face_count), cage.sizes)
    quads = np.stack([cage.corners, first_edge + edges.of_corner, first_face + numbers, first_edge + edges.of_corner[before]], 1)
    centre = (np.add.reduceat(cage.uvs, starts, axis=0) / sizes)[numbers]
    uvs = np.stack([cage.uvs, (cage.uvs + cage.uvs[after]) / 2, centre, (cage.uvs + cage.uvs[before]) / 2], 1)
    is_crease = edges.sharpness > 0
    middle = first_edge + np.flatnonzero(is_crease)
    children = np.concatenate([np.stack([edges.ends[is_crease, k], middle], 1) for k in (0, 1)])
    rest = np.tile(fade(edges.sharpness[is_crease]), 2)
    point_sharpness = np.concatenate([fade(cage.point_sharpness), np.zeros(len(middles) + face_count)])
    return dataclasses.replace(cage, points=np.concatenate([points, middles, face_points]), sizes=np.full(len(quads), 4),
                               corners=quads.reshape(-1), uvs=uvs.reshape(4 * len(quads), cage.uvs.shape[1]), faces=cage.faces[numbers], edges=children,
                               edge_sharpness=rest, point_sharpness=point_sharpness)


def fade(sharpness: np.ndarray) -> np.ndarray:
    return np.where(sharpness >= INFINITE, sharpness, np.maximum(sharpness - 1, 0))


def move_to_limit(cage: Cage) -> np.ndarray:
    """Points of a cage of quads on the limit surface: Halstead, Kass and DeRose (1993)."""
    after, _ = find_neighbours(cage)
    edges, count = find_edges(cage, after), len(cage.points)
    valence = np.bincount(cage.corners, minlength=count)[:, None]
    opposite = cage.corners.reshape(-1, 4)[:, [2, 3, 0, 1]].reshape(-1)
    across = sum_at(cage.corners, cage.points[opposite], count)
    beside = sum_at(edges.ends.reshape(-1), cage.points[edges.ends[:, ::-1].reshape(-1)], count)
    smooth = (valence ** 2 * cage.points + 4 * beside + across) / np.maximum(valence * (valence + 5), 1)
    how_sharp, is_corner, ends = find_rules(cage, edges)
    sharp = np.where(is_corner[:, None], cage.points, (4 * cage.points + ends) / 6)
    return np.where(how_sharp[:, None] > 0, sharp, np.where(valence > 0, smooth, cage.points))


def refine(cage: Cage, level: int) -> Cage:
    """`level` times, at least once, and its points on the limit."""
    for _ in range(max(level, 1)):
        cage = refine_once(cage)
    return dataclasses.replace(cage, points=move_to_limit(cage)) if cage.is_smooth else cage
